// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/overlay/plane_style.h"

#include "engine/inspection/studies/track_life.h"
#include "ui/context/theme.h"
#include "ui/look/numbers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

/// Okabe and Ito's colors without other meaning for tracks and planes: orange, reddish purple,
/// blue; and ochre.
constexpr std::array<std::uint32_t, 4> kOtherPlanes = {0xE69F00, 0xCC79A7, 0x4A7FD0, 0xB59B3C};

std::optional<double> value_of(const TrackLife& life, Coloring coloring) {
  if (coloring == Coloring::residual) return rms_residual_px(life);
  if (coloring == Coloring::depth) return life.depth;
  return static_cast<double>(life.frames.size());
}

double quantile(std::vector<double> sorted, double share) {
  if (sorted.empty()) return 0;
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

std::string text_of(Coloring coloring, double value) {
  if (coloring == Coloring::residual) return fmt::format("{:.2f} px", value);
  if (coloring == Coloring::depth) return fmt::format("{:.2f} d", value);
  return fmt::format("{:.0f} frames", value);
}

}  // namespace

std::uint32_t plane_color(const Window& window, int plane) {
  if (plane == window.leader) return color_of(Role::inlier);
  const int place = plane < window.leader ? plane : plane - 1;
  return kOtherPlanes[place % kOtherPlanes.size()];
}

std::vector<int> other_planes(const Window& window) {
  std::vector<int> others;
  for (int k = 0; k < static_cast<int>(window.planes.size()); ++k)
    if (k != window.leader) others.push_back(k);
  return others;
}

std::optional<int> plane_of_track(const Window& window, int frame, int column) {
  if (window.inlier[frame][column]) return window.leader;
  for (int k = 0; k < static_cast<int>(window.planes.size()); ++k)
    if (window.planes[k].inlier[frame][column]) return k;
  return std::nullopt;
}

TrackStyle track_style(const Window& window, int frame, int column) {
  const auto plane = plane_of_track(window, frame, column);
  if (!plane) return {Sign::cross, color_of(Role::outlier)};
  return {Sign::circle, plane_color(window, *plane)};
}

std::optional<int> to_main_plane(const Inspection& inspection, std::int64_t id) {
  const Window& window = *inspection.window;
  const auto& ids = inspection.tracks->ids;
  const auto found = std::ranges::find(ids, id);
  if (found == ids.end()) return std::nullopt;
  const auto plane = window.plane_of(static_cast<int>(found - ids.begin()));
  return plane && *plane != window.leader ? std::optional(*plane + 1) : std::nullopt;
}

ReadinessStyle style_of(Readiness readiness) {
  if (readiness == Readiness::ready) return {Sign::disc, color_of(Role::good)};
  if (readiness == Readiness::weak) return {Sign::triangle, color_of(Role::warning)};
  return {Sign::cross, color_of(Role::bad)};
}

std::string verdict_text(const Verdict& verdict) {
  std::string text = to_string(verdict.readiness);
  if (verdict.normal_sigma_deg) text += ", normal \u00b1" + angle_text(*verdict.normal_sigma_deg);
  if (verdict.rotation_rms_px) {
    text += ", rotation alone leaves " + number_text(*verdict.rotation_rms_px, 2) + " px";
    if (verdict.noise_px) text += " where noise is " + number_text(*verdict.noise_px, 2) + " px";
  }
  if (verdict.largest_translation)
    text += ", moved " + number_text(*verdict.largest_translation, 3) + " d";
  return text;
}

std::vector<Verdict> shown_growth(const Inspection& inspection) {
  std::vector<Verdict> growth = inspection.growth;
  const auto& result = inspection.initialization;
  const bool whole = static_cast<int>(growth.size()) + 1 == inspection.window->frame_count();
  if (whole && !growth.empty() && result && result->verdict) growth.back() = *result->verdict;
  return growth;
}

std::vector<VerdictRun> verdict_runs(std::span<const Verdict> growth) {
  std::vector<VerdictRun> runs;
  for (int i = 0; i < static_cast<int>(growth.size()); ++i) {
    const Readiness readiness = growth[i].readiness;
    if (runs.empty() || runs.back().readiness != readiness)
      runs.push_back({i + 1, i + 1, readiness});
    runs.back().last = i + 1;
  }
  return runs;
}

std::uint32_t viridis(double share) {
  static const cv::Mat3b table = [] {
    cv::Mat1b levels(1, 256);
    std::iota(levels.begin(), levels.end(), std::uint8_t{0});
    cv::Mat3b colors;
    cv::applyColorMap(levels, colors, cv::COLORMAP_VIRIDIS);
    return colors;
  }();
  const cv::Vec3b bgr = table(static_cast<int>(std::lround(255 * std::clamp(share, 0.0, 1.0))));
  return std::uint32_t{bgr[2]} << 16 | std::uint32_t{bgr[1]} << 8 | bgr[0];
}

std::uint32_t ramp_color(double share) { return viridis(0.3 + 0.7 * std::clamp(share, 0.0, 1.0)); }

std::uint32_t TrackColors::rgb(int column) const {
  const auto& value = values[column];
  if (!value) return color_of(Role::text_dim);
  return ramp_color(high > low ? (*value - low) / (high - low) : 0.5);
}

std::shared_ptr<const TrackColors> track_colors(const Inspection& inspection, Coloring coloring) {
  if (coloring == Coloring::plane) return nullptr;
  TrackColors colors{.coloring = coloring, .values = {}};
  std::vector<double> known;
  for (int column = 0; column < inspection.tracks->track_count(); ++column) {
    colors.values.push_back(value_of(track_life(inspection, column), coloring));
    if (colors.values.back()) known.push_back(*colors.values.back());
  }
  std::ranges::sort(known);
  colors.low = quantile(known, 0.05);
  colors.high = quantile(known, 0.95);
  return std::make_shared<const TrackColors>(std::move(colors));
}

LegendRows legend_rows(const TrackColors& colors) {
  const char* quantity = colors.coloring == Coloring::residual ? "residual"
                         : colors.coloring == Coloring::depth  ? "depth"
                                                               : "seen in";
  const bool known =
      std::ranges::any_of(colors.values, [](const auto& v) { return v.has_value(); });
  if (!known) return {{Sign::disc, color_of(Role::text_dim), fmt::format("{} unknown", quantity)}};
  const std::string low = text_of(colors.coloring, colors.low);
  return {{Sign::disc, ramp_color(0), fmt::format("{} {}", quantity, low)},
          {Sign::disc, ramp_color(1), text_of(colors.coloring, colors.high)}};
}

}  // namespace gpo
