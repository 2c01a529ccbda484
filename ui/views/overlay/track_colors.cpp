// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

std::optional<double> value_of(const TrackLife& life, Coloring coloring) {
  if (coloring == Coloring::residual) return rms_residual_px(life);
  if (coloring == Coloring::depth) return life.depth;
  return static_cast<double>(life.frames.size());
}

std::string text_of(const TrackColors& colors, double value) {
  if (colors.coloring == Coloring::residual) return fmt::format("{:.2f} px", value);
  if (colors.coloring == Coloring::depth)
    return colors.in_meters ? length_text(value) : fmt::format("{:.2f} d", value);
  return counted(static_cast<std::size_t>(value), "frame");
}

/// Returns viridis without its darkest part, for dark images. `share` in 0..1.
std::uint32_t ramp_color(double share) { return viridis(0.3 + 0.7 * std::clamp(share, 0.0, 1.0)); }

}  // namespace

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

std::uint32_t TrackColors::rgb(int column) const {
  const auto& value = values[column];
  if (!value) return color_of(Role::text_dim);
  return ramp_color(high > low ? (*value - low) / (high - low) : 0.5);
}

std::shared_ptr<const TrackColors> track_colors(const Inspection& inspection, Coloring coloring) {
  if (coloring == Coloring::plane) return nullptr;
  const auto meters = coloring == Coloring::depth ? known_scale(inspection) : std::nullopt;
  TrackColors colors{.coloring = coloring, .in_meters = meters.has_value(), .values = {}};
  std::vector<double> known;
  for (int column = 0; column < inspection.tracks->track_count(); ++column) {
    std::optional<double> value = value_of(track_life(inspection, column), coloring);
    if (value) known.push_back(*value *= meters.value_or(1));
    colors.values.push_back(value);
  }
  std::ranges::sort(known);
  if (!known.empty())
    for (const auto& [end, share] : {std::pair{&colors.low, 0.05}, {&colors.high, 0.95}})
      *end = known[static_cast<std::size_t>(share * static_cast<double>(known.size() - 1))];
  return std::make_shared<const TrackColors>(std::move(colors));
}

LegendRows legend_rows(const TrackColors& colors) {
  const char* quantity = colors.coloring == Coloring::residual ? "residual"
                         : colors.coloring == Coloring::depth  ? "depth"
                                                               : "seen in";
  if (std::ranges::none_of(colors.values, [](const auto& value) { return value.has_value(); }))
    return {{Sign::disc, color_of(Role::text_dim), fmt::format("{} unknown", quantity)}};
  const std::string low = text_of(colors, colors.low);
  if (low == text_of(colors, colors.high))
    return {{Sign::disc, ramp_color(0.5), fmt::format("{} {}", quantity, low)}};
  return {{Sign::disc, ramp_color(0), fmt::format("{} {}", quantity, low)},
          {Sign::disc, ramp_color(1), text_of(colors, colors.high)}};
}

}  // namespace gpo
