// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/report/report.h"
#include "ui/views/snapshot.h"

#include <fmt/format.h>

namespace gpo {

std::vector<int> report_frames(const Inspection& inspection) {
  constexpr int kShown = 5;
  const int last = inspection.window->frame_count() - 1;
  std::vector<int> frames;
  for (int k = 0; k < kShown; ++k) {
    const int frame = inspection.window->start + k * last / (kShown - 1);
    if (frames.empty() || frames.back() != frame) frames.push_back(frame);
  }
  return frames;
}

ReportSection drawn_section(const std::shared_ptr<const Inspection>& inspection) {
  ReportSection section{.inspection = inspection};
  for (const int frame : report_frames(*inspection))
    section.frames.push_back({frame, snapshot_image(*inspection, frame)});
  section.scene = snapshot_scene(*inspection,
                                 inspection->window->start,
                                 cv::Size(1120, 630),
                                 {.says_failure = false},
                                 Theme::light);
  section.normals =
      snapshot_normals(inspection, section.frames.back().frame, cv::Size(860, 780), Theme::light);
  return section;
}

Figure with_single_windows(Figure figure, const std::string& recording, int start) {
  for (Chart& chart : figure.charts)
    for (Curve& curve : chart.curves) curve.counts.clear();
  figure.title = fmt::format("{}: windows from frame {} over their length", recording, start);
  return figure;
}

Figure growth_figure(const Inspection& inspection) {
  Curve curve{.name = "1 sigma of the normal", .rgb = color_of(Role::accent, Theme::light)};
  int frames = 2;
  // The last verdict is that of the result, by another estimator.
  const auto& growth = shown_growth(inspection);
  for (const Verdict& verdict : std::span(growth).first(growth.empty() ? 0 : growth.size() - 1)) {
    if (verdict.normal_sigma_deg && *verdict.normal_sigma_deg > 0) {
      curve.x.push_back(frames);
      curve.y.push_back(*verdict.normal_sigma_deg);
    }
    ++frames;
  }
  Figure figure{.name = "growth", .title = "The growing window, before the method"};
  if (curve.x.size() < 2) return figure;
  figure.charts.push_back({.title = "",
                           .x_label = "frames of the window",
                           .y_label = "normal, 1 sigma [deg]",
                           .logarithmic = true,
                           .curves = {std::move(curve)}});
  return figure;
}

}  // namespace gpo
