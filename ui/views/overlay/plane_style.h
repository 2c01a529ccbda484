// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/view_toggles.h"
#include "ui/views/overlay/overlay.h"

#include <memory>
#include <optional>

namespace gpo {

/// The leading plane has the inliers' color, others have theirs by order of support.
std::uint32_t plane_color(const Window& window, int plane);

/// Returns the numbers of the window's planes except the leading one.
std::vector<int> other_planes(const Window& window);

/// Returns the number of the plane that the track is an inlier of in the frame; nullopt for
/// outliers.
std::optional<int> plane_of_track(const Window& window, int frame, int column);

struct TrackStyle {
  Sign sign;
  std::uint32_t rgb;
};
/// A circle in the color of the track's plane, or an outlier's cross.
TrackStyle track_style(const Window& window, int frame, int column);

/// Returns the value of the setting `plane` that makes the track's plane the leading one; nullopt
/// if the track is on no other plane.
std::optional<int> to_main_plane(const Inspection& inspection, std::int64_t id);

/// Sign and color of a verdict; its word is `to_string`.
struct ReadinessStyle {
  Sign sign = Sign::none;
  std::uint32_t rgb = 0;
};
ReadinessStyle style_of(Readiness readiness);

/// "weak, normal ±0.31°, rotation alone leaves 1.20 px where noise is 0.40 px, moved 0.1 d".
std::string verdict_text(const Verdict& verdict);

/// Returns the verdicts on windows of 2, 3, ... frames; for the whole one its result's, if any.
std::vector<Verdict> shown_growth(const Inspection& inspection);

/// Windows of consecutive lengths with the same verdict.
struct VerdictRun {
  int first, last;  ///< last frames of the shortest and the longest of these windows
  Readiness readiness;
  bool operator==(const VerdictRun&) const = default;
};
std::vector<VerdictRun> verdict_runs(std::span<const Verdict> growth);

std::uint32_t viridis(double share);

/// Returns viridis without its darkest part, for dark images. `share` in 0..1.
std::uint32_t ramp_color(double share);

/// A number per track and its color. Immutable.
struct TrackColors {
  Coloring coloring = Coloring::residual;
  std::vector<std::optional<double>> values;  ///< by column; nullopt if unknown
  double low = 0, high = 0;                   ///< 5 % and 95 % quantile: ends of the color scale

  std::uint32_t rgb(int column) const;  ///< gray if the value is unknown
};

/// Null for `Coloring::plane`, whose colors come from the window.
std::shared_ptr<const TrackColors> track_colors(const Inspection& inspection, Coloring coloring);

/// Returns the ends of the color scale with their values and units.
LegendRows legend_rows(const TrackColors& colors);

}  // namespace gpo
