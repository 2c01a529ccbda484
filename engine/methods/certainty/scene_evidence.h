// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/methods/common/verdict.h"
#include "engine/window/window.h"

#include <optional>
#include <span>
#include <vector>

namespace gpo {

/// What the window's planes say of what its tracks lie on; of other inliers nothing.
SceneKind scene_of(const Window& window);

std::vector<PlaneEvidence> plane_evidence(const Window& window);

/// Planes against free points, over all tracks (engine/method.md, "The verdict on a window").
/// `noise_px` is that of a coordinate; nothing where there are no planes or fewer than eight tracks
/// are seen.
std::optional<SceneCriterion> scene_criterion(const Window& window,
                                              std::span<const Pose> cameras,
                                              double noise_px);

}  // namespace gpo
