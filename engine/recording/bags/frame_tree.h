// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/recording/bags/messages.h"

#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// T_from_to, x_from = R x_to + p, along transforms that are known, in either direction; nothing
/// where they do not connect the two.
std::optional<Pose> transform_between(const std::vector<PoseMessage>& transforms,
                                      const std::string& from,
                                      const std::string& to);

}  // namespace gpo
