// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/overlay/track_colors.h"

#include "engine/inspection/studies/track_life.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

/// Viridis, as OpenCV has it, without its darkest part, which would be lost on dark pictures.
std::uint32_t ramp(double share) {
  static const cv::Mat table = [] {
    cv::Mat levels(1, 256, CV_8U), colors;
    for (int i = 0; i < 256; ++i) levels.at<std::uint8_t>(i) = static_cast<std::uint8_t>(i);
    cv::applyColorMap(levels, colors, cv::COLORMAP_VIRIDIS);
    return colors;
  }();
  constexpr double kDarkest = 0.3;
  const double level = kDarkest + (1 - kDarkest) * std::clamp(share, 0.0, 1.0);
  const auto& bgr = table.at<cv::Vec3b>(static_cast<int>(std::lround(255 * level)));
  return (static_cast<std::uint32_t>(bgr[2]) << 16) | (static_cast<std::uint32_t>(bgr[1]) << 8) |
         bgr[0];
}

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

std::uint32_t TrackColors::rgb(int column) const {
  const auto& value = values[column];
  if (!value) return color_of(Role::text_dim);
  return ramp(high > low ? (*value - low) / (high - low) : 0.5);
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

std::vector<LegendRow> legend_rows(const TrackColors& colors) {
  const char* what = colors.coloring == Coloring::residual ? "residual"
                     : colors.coloring == Coloring::depth  ? "depth"
                                                           : "seen in";
  const bool known =
      std::ranges::any_of(colors.values, [](const auto& v) { return v.has_value(); });
  if (!known) return {{Sign::disc, color_of(Role::text_dim), fmt::format("{} not known", what)}};
  return {{Sign::disc, ramp(0), fmt::format("{} {}", what, text_of(colors.coloring, colors.low))},
          {Sign::disc, ramp(1), text_of(colors.coloring, colors.high)}};
}

}  // namespace gpo
