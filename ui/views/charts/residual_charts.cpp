// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/residual_charts.h"

#include "engine/geometry/statistics.h"
#include "engine/inspection/studies/track_life.h"
#include "engine/methods/common/window_checks.h"
#include "ui/context/theme.h"
#include "ui/views/charts/axis_ticks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr int kBins = 24;

std::vector<double> all_of(const WindowResiduals& residuals) {
  std::vector<double> all;
  for (std::size_t i = 1; i < residuals.size(); ++i)
    all.insert(all.end(), residuals[i].begin(), residuals[i].end());
  std::ranges::sort(all);
  return all;
}

/// Such that 99 % of the residuals are in the bins; a round number [px].
double bin_width(const std::vector<double>& sorted) {
  const double most = sorted[(sorted.size() - 1) * 99 / 100];
  const AxisTicks ticks = linear_ticks(0, std::max(most, 1e-6), kBins);
  return ticks.values[1] - ticks.values[0];
}

/// The last bin holds what is beyond it, however far that is, and what is no number.
int bin_of(double value, double width) {
  const double bin = std::floor(value / width);
  return bin < kBins ? static_cast<int>(bin) : kBins - 1;
}

/// Steps from bin to bin, in percent, over a ground that reaches down to zero.
Curve steps(std::string name, std::uint32_t rgb, std::span<const double> values, double width) {
  std::vector<double> share(kBins, 0);
  for (const double value : values)
    share[bin_of(value, width)] += 100.0 / static_cast<double>(values.size());
  Curve curve{std::move(name), rgb, false, {}, {}, {}, {}};
  for (int k = 0; k < kBins; ++k) {
    curve.x.insert(curve.x.end(), {k * width, (k + 1) * width});
    curve.y.insert(curve.y.end(), {share[k], share[k]});
  }
  curve.lower.assign(curve.y.size(), 0);
  curve.upper = curve.y;
  return curve;
}

}  // namespace

WindowResiduals window_residuals(const Inspection& inspection) {
  WindowResiduals residuals;
  for (int i = 0; inspection.initialization->ok && i < inspection.window->frame_count(); ++i)
    residuals.push_back(residuals_px(inspection, i));
  return residuals;
}

Chart residual_histogram(const WindowResiduals& residuals,
                         const Inspection& inspection,
                         int frame) {
  Chart chart{"Residuals", "residual [px]", "share [%]", false, {}};
  const std::vector<double> all = all_of(residuals);
  if (all.empty()) return chart;
  const double width = bin_width(all);
  chart.curves.push_back(steps(fmt::format("window, {} inliers", all.size()),
                               inspection.settings.options.method.row().rgb,
                               all,
                               width));
  const int i = frame - inspection.window->start;
  if (i < 1 || i >= static_cast<int>(residuals.size()) || residuals[i].empty()) return chart;
  chart.curves.push_back(steps(fmt::format("frame {}, {} inliers", frame, residuals[i].size()),
                               color_of(Role::residual),
                               residuals[i],
                               width));
  return chart;
}

Chart rms_chart(const WindowResiduals& residuals,
                const Inspection& inspection,
                const TrackLife* track) {
  Chart chart{"Frame by frame", "frame", "residual [px]", false, {}};
  Curve rms{
      "RMS of the inliers", inspection.settings.options.method.row().rgb, false, {}, {}, {}, {}};
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    rms.x.push_back(inspection.window->start + static_cast<double>(i));
    rms.y.push_back(residuals[i].empty() ? NAN : root_mean_square(residuals[i]));
  }
  if (residuals.empty()) return chart;
  chart.curves.push_back(std::move(rms));
  if (track == nullptr) return chart;
  Curve own{fmt::format("track {}", track->id), color_of(Role::selected), false, {}, {}, {}, {}};
  for (const TrackFrame& frame : track->frames) {
    own.x.push_back(frame.frame);
    own.y.push_back(frame.residual_px.value_or(NAN));
  }
  chart.curves.push_back(std::move(own));
  return chart;
}

}  // namespace gpo
