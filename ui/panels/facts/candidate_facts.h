// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/studies/normal_study.h"
#include "ui/workbench/state.h"

#include <span>
#include <string>
#include <vector>

namespace gpo {

/// Returns one sentence on the decompositions of a frame's homography; there must be at least one.
std::string candidates_sentence(std::span<const HomographyCandidate> candidates);

/// Returns why a frame (counts in the window, may be outside of it) has no decompositions; empty if
/// it has some.
std::string why_no_candidates(const NormalStudy& study, int frame_in_window);

/// Returns normal, tilt, rotation, baseline, score and points behind a camera.
std::vector<std::string> candidate_cells(const HomographyCandidate& candidate);

/// Returns why there is no study of the shown window's normals; `doing` while it is computed, empty
/// if there is one.
std::string why_no_study(const WorkbenchState& state, const std::string& doing);

}  // namespace gpo
