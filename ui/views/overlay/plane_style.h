// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/views/overlay/overlay.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// The leading plane's is that of an inlier; the others have theirs in the order of their support.
std::uint32_t plane_color(const Window& window, int plane);

/// Numbers of the window's planes that do not lead.
std::vector<int> other_planes(const Window& window);

/// Number of the plane that the track lies on in the frame; nothing: on none.
std::optional<int> plane_of_track(const Window& window, int frame, int column);

struct TrackStyle {
  Sign sign;
  std::uint32_t rgb;
};
/// A circle in the color of its plane, or an outlier's cross.
TrackStyle track_style(const Window& window, int frame, int column);

/// What the setting `plane` must be for the plane of the track of this id to lead; nothing where it
/// lies on none, or on the one that leads.
std::optional<int> to_main_plane(const Inspection& inspection, std::int64_t id);

/// How a verdict looks wherever it is shown: by word, shape and color, never by color alone.
struct ReadinessStyle {
  Sign sign = Sign::none;
  std::uint32_t rgb = 0;
};
ReadinessStyle style_of(Readiness readiness);

/// "weak, normal ±0.31°, rotation alone leaves 1.20 px where noise is 0.40 px, moved 0.100 d": what
/// is known of it.
std::string verdict_text(const Verdict& verdict);

/// The verdicts of windows of 2, 3, ... frames; that of the whole one is its result's, where there
/// is one.
std::vector<Verdict> shown_growth(const Inspection& inspection);

/// Windows of consecutive lengths with the same verdict.
struct VerdictRun {
  int first, last;  ///< frames of the window at which the first and the last of them end
  Readiness readiness;
  bool operator==(const VerdictRun&) const = default;
};

/// Of the verdicts of windows of 2, 3, ... frames, which end at frames 1, 2, ...
std::vector<VerdictRun> verdict_runs(std::span<const Verdict> growth);

}  // namespace gpo
