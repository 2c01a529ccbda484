// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/snapshots.h"

#include "engine/base/error.h"
#include "engine/experiment/experiment.h"
#include "engine/experiment/summary.h"
#include "engine/inspection/inspector.h"
#include "engine/methods/methods.h"
#include "ui/views/figures/figure_view.h"
#include "ui/views/snapshot.h"
#include "ui/workbench_window.h"

#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

std::string failure_text(const std::string& method, const std::string& reason) {
  return fmt::format("{}: initialization failed: {}", method, reason);
}

/// Returns the requested frame or the window's last. Throws SettingError.
int frame_to_draw(const ViewRequest& request, const Recording& recording) {
  const Settings& settings = request.compared.window;
  const int frame = request.frame.value_or(settings.start + settings.frames - 1);
  if (frame >= 0 && frame < recording.frame_count()) return frame;
  throw SettingError("frame",
                     fmt::format("{} is not in the recording, which has frames 0 to {}",
                                 frame,
                                 recording.frame_count() - 1));
}

/// Returns one inspection per configuration, in their order.
std::vector<std::shared_ptr<const Inspection>> inspect_each(
    const std::shared_ptr<const Recording>& recording, const ComparisonRequest& request) {
  Inspector inspector(recording);
  const std::vector<Configuration> configurations = configurations_of(request);
  const Settings base = base_of(configurations, request.window);
  std::vector<std::shared_ptr<const Inspection>> inspections;
  for (const Configuration& configuration : configurations)
    inspections.push_back(inspector.inspect(apply(configuration, base)));
  return inspections;
}

DrawnView draw_compare(const std::shared_ptr<const Recording>& recording,
                       const ViewRequest& request) {
  DrawnView drawn;
  drawn.inspections = inspect_each(recording, request.compared);
  drawn.image =
      snapshot_compare(drawn.inspections, frame_to_draw(request, *recording), request.size);
  for (const auto& inspection : drawn.inspections) {
    const Initialization& result = *inspection->initialization;
    drawn.ok |= result.ok;
    if (!result.ok)
      drawn.failures.push_back(
          failure_text(key_of(configuration_of(inspection->settings)), result.reason));
  }
  return drawn;
}

cv::Mat draw_pane(const ViewRequest& request,
                  const Pane& pane,
                  const std::shared_ptr<const Inspection>& inspection) {
  const int frame = frame_to_draw(request, *inspection->recording);
  const auto size = [&](int width, int height) {
    return request.size.value_or(cv::Size(width, height));
  };
  const std::string_view key = pane.key;
  if (key == "image") return snapshot_image(*inspection, frame, request.size);
  if (key == "scene") return snapshot_scene(*inspection, frame, size(960, 720));
  if (key == "normals") return snapshot_normals(inspection, frame, size(720, 760));
  return snapshot_pane(pane.key, inspection, frame, request.size);
}

DrawnView draw_one(const std::shared_ptr<const Recording>& recording,
                   const ViewRequest& request,
                   const Pane& pane,
                   const std::stop_token& stop) {
  const auto inspection = Inspector(recording).inspect(request.compared.window, stop);
  if (!inspection) throw InputError("stopped");
  const Initialization& result = *inspection->initialization;
  DrawnView drawn{draw_pane(request, pane, inspection), result.ok, {inspection}};
  if (!result.ok)
    drawn.failures.push_back(failure_text(inspection->settings.options.method, result.reason));
  return drawn;
}

/// Returns the requested window lengths in descending order. Throws InputError.
std::vector<int> lengths_of(const ComparisonRequest& request) {
  const std::string text = request.lengths.value_or("5:end:5");
  std::vector<int> lengths = numbers_in(parse_ranges(text, "lengths"), request.window.frames);
  if (lengths.empty() || lengths.front() < 2)
    throw InputError(fmt::format("--lengths: '{}' with --frames {}: a window has at least 2 frames",
                                 text,
                                 request.window.frames));
  std::ranges::reverse(lengths);
  return lengths;
}

/// Draws the errors over the length of windows from one start.
DrawnView draw_curves(const std::shared_ptr<const Recording>& recording,
                      const ViewRequest& request) {
  const std::vector<Configuration> configurations = configurations_of(request.compared);
  Settings window = base_of(configurations, request.compared.window);
  FigurePlan plan{.name = "curves", .title = "", .configurations = {}};
  for (const Configuration& configuration : configurations)
    plan.configurations.push_back(configuration_of(apply(configuration, window)));
  DrawnView drawn;
  std::vector<Row> rows;
  Inspector inspector(recording);
  // The longest window comes first: the Inspector caches its tracks for the others.
  for (const int length : lengths_of(request.compared)) {
    window.frames = length;
    for (const Configuration& configuration : configurations) {
      const auto inspection = inspector.inspect(apply(configuration, window));
      if (!inspection->truth)
        throw InputError(fmt::format(
            "--view curves: {} has no ground truth to measure errors against", recording->name));
      rows.push_back(make_row(*inspection));
      if (drawn.inspections.size() < configurations.size()) drawn.inspections.push_back(inspection);
    }
  }
  std::ranges::reverse(rows);
  Figure figure = figure_over_length(rows, plan);
  // One window per length was requested here, so its points are not drawn as few of many.
  for (Chart& chart : figure.charts)
    for (Curve& curve : chart.curves) curve.counts.clear();
  figure.title =
      fmt::format("{}: windows from frame {} over their length", recording->name, window.start);
  for (const Configuration& configuration : plan.configurations) {
    const auto own = rows_of(rows, {&configuration, 1});
    const bool solved = std::ranges::any_of(own, &Row::ok);
    drawn.ok |= solved;
    if (!solved)
      drawn.failures.push_back(fmt::format("{}: {}", own.back().configuration, own.back().reason));
  }
  drawn.image = draw_figure(figure, request.size.value_or(default_figure_size(figure)));
  return drawn;
}

}  // namespace

std::vector<Configuration> configurations_of(const ComparisonRequest& request) {
  if (request.methods) return parse_configurations(*request.methods, request.table);
  std::vector<Configuration> all;
  for (const MethodChoice& method : request.table.all()) all.push_back({.method = method});
  return all;
}

std::vector<std::string> view_names() { return pane_names(); }

DrawnView draw_view(const std::shared_ptr<const Recording>& recording,
                    const ViewRequest& request,
                    const std::stop_token& stop) {
  const Pane* pane = find_pane(request.view);
  if (pane == nullptr)
    throw SettingError(
        "view",
        fmt::format("'{}', expected one of {}", request.view, fmt::join(view_names(), ", ")));
  const std::string_view key = pane->key;
  if (key == "compare") return draw_compare(recording, request);
  if (key == "curves") return draw_curves(recording, request);
  return draw_one(recording, request, *pane, stop);
}

}  // namespace gpo
