// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/truth/truth.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// Returns the changes between successive poses that no camera makes: the rate or the speed is
/// above 0.5 rad/s or 0.25 m/s plus five times the median of the ten changes around it. Returns the
/// first one of successive jumps, as a wrong pose causes two. `times_ns`: one per pose.
std::vector<TruthJump> jumps_of(std::span<const std::int64_t> times_ns,
                                std::span<const std::optional<Pose>> poses);

void keep_between(std::int64_t first_ns, std::int64_t last_ns, std::vector<TruthJump>& jumps);

std::string text_of(const TruthJump& jump, std::int64_t origin_ns);

std::vector<std::string> notes_of(std::span<const TruthJump> jumps, std::int64_t origin_ns);

}  // namespace gpo
