// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Views of a recording, inspected and drawn without a display.
#include "app/commands/commands.h"
#include "engine/base/error.h"
#include "engine/experiment/summary.h"
#include "engine/inspection/studies/studies.h"
#include "engine/methods/methods.h"
#include "ui/views/report/report.h"
#include "ui/views/snapshot.h"
#include "ui/workbench_window.h"

#include <algorithm>

namespace gpo {
namespace {

int frame_to_draw(const ViewRequest& request, const Recording& recording) {
  const Settings& settings = request.window;
  const int last = recording.frame_count() - 1;
  // The inspector refuses a window that does not fit.
  const int frame = request.frame.value_or(std::min(settings.start + settings.frames - 1, last));
  if (frame >= 0 && frame <= last) return frame;
  throw SettingError(
      "frame", fmt::format("{} is not in the recording, which has frames 0 to {}", frame, last));
}

std::shared_ptr<const Inspection> inspected(Inspector& inspector,
                                            const Settings& settings,
                                            const std::stop_token& stop) {
  auto inspection = inspector.inspect(settings, stop);
  if (!inspection) throw Stopped{};
  return inspection;
}

/// Returns the cameras between the window and a frame after it, as the window shows them; null if
/// the frame is not after a window with a result. Adds a line to `drawn` if the frame has none.
std::shared_ptr<const Extrapolation> cameras_up_to(
    int frame,
    const std::shared_ptr<const Inspection>& inspection,
    DrawnView& drawn,
    const std::stop_token& stop) {
  const int last = inspection->window->start + inspection->window->frame_count() - 1;
  if (frame <= last || !inspection->initialization->ok) return nullptr;
  auto after = extrapolate(inspection, frame - last, stop);
  if (!after) throw Stopped{};
  if (after->last_frame() < frame)
    drawn.failures.push_back(fmt::format("frame {} has no camera after the window {} to {}: {}",
                                         frame,
                                         inspection->window->start,
                                         last,
                                         after->end));
  return after;
}

DrawnView draw_compare(const std::shared_ptr<const Recording>& recording,
                       const ViewRequest& request,
                       const std::stop_token& stop) {
  const std::vector<Configuration> configurations = configurations_of(request);
  const Settings base = base_of(configurations, request.window);
  Inspector inspector(recording);
  DrawnView drawn;
  for (const Configuration& configuration : configurations) {
    const auto inspection = inspected(inspector, apply(configuration, base), stop);
    add_result(drawn, inspection, key_of(configuration_of(inspection->settings)));
  }
  drawn.image =
      snapshot_compare(drawn.inspections, frame_to_draw(request, *recording), request.size);
  return drawn;
}

DrawnView draw_one(const std::shared_ptr<const Recording>& recording,
                   const ViewRequest& request,
                   const std::string& key,
                   const std::stop_token& stop) {
  const int frame = frame_to_draw(request, *recording);
  Inspector inspector(recording);
  const auto inspection = inspected(inspector, request.window, stop);
  DrawnView drawn;
  std::shared_ptr<const Extrapolation> after;
  if (key == "scene" || key == "image" || key == "window")
    after = cameras_up_to(frame, inspection, drawn, stop);
  const bool located = after && after->extended && frame <= after->last_frame();
  const Inspection& in_image = located ? *after->extended : *inspection;
  const ViewOptions options{.after = after};
  drawn.image = key == "scene"     ? snapshot_scene(*inspection, frame, request.size, options)
                : key == "normals" ? snapshot_normals(inspection, frame, request.size)
                : key == "image"   ? snapshot_image(in_image, frame, request.size, options)
                                   : snapshot_pane(key, inspection, frame, request.size, after);
  add_result(drawn, inspection, inspection->settings.options.method);
  return drawn;
}

std::vector<int> lengths_of(const ViewRequest& request, int frame_count) {
  const std::string text = request.lengths.value_or("5:end:5");
  std::vector<int> lengths = numbers_in(parse_ranges(text, "lengths"), request.window.frames);
  if (lengths.empty() || lengths.front() < 2)
    throw InputError(fmt::format("--lengths: '{}' with --frames {}: a window has at least 2 frames",
                                 text,
                                 request.window.frames));
  const int most = frame_count - request.window.start;
  if (lengths.back() > most)
    throw InputError(
        fmt::format("--lengths: '{}' has a window of {} frames from frame {} on, but "
                    "the recording has {} from there on",
                    text,
                    lengths.back(),
                    request.window.start,
                    most));
  std::ranges::reverse(lengths);
  return lengths;
}

DrawnView draw_curves(const std::shared_ptr<const Recording>& recording,
                      const ViewRequest& request,
                      const std::stop_token& stop) {
  if (!recording->truth && !(recording->board && recording->images))
    throw InputError(fmt::format("--view curves: {} has no ground truth to measure errors against",
                                 recording->name));
  DrawnView drawn;
  const Figure figure = curves_over_length(recording, request, drawn, stop);
  drawn.image = draw_figure(figure, request.size.value_or(default_figure_size(figure)));
  return drawn;
}

}  // namespace

std::vector<Configuration> configurations_of(const ViewRequest& request) {
  if (request.methods) return parse_configurations(*request.methods, request.table);
  std::vector<Configuration> all;
  for (const MethodChoice& method : request.table.all()) all.push_back({.method = method});
  return all;
}

void add_result(DrawnView& drawn,
                const std::shared_ptr<const Inspection>& inspection,
                const std::string& name) {
  const Initialization& result = *inspection->initialization;
  drawn.inspections.push_back(inspection);
  drawn.ok |= result.ok;
  if (!result.ok)
    drawn.failures.push_back(fmt::format("{}: initialization failed: {}", name, result.reason));
}

Figure curves_over_length(const std::shared_ptr<const Recording>& recording,
                          const ViewRequest& request,
                          DrawnView& drawn,
                          const std::stop_token& stop) {
  const std::vector<Configuration> configurations = configurations_of(request);
  Settings window = base_of(configurations, request.window);
  FigurePlan plan{.name = "curves", .title = "", .configurations = {}};
  for (const Configuration& configuration : configurations)
    plan.configurations.push_back(configuration_of(apply(configuration, window)));
  std::vector<Row> rows;
  Inspector inspector(recording);
  // The longest window comes first: the Inspector caches its tracks for the others.
  for (const int length : lengths_of(request, recording->frame_count())) {
    window.frames = length;
    for (const Configuration& configuration : configurations) {
      const auto inspection = inspected(inspector, apply(configuration, window), stop);
      rows.push_back(make_row(*inspection));
      if (drawn.inspections.size() < configurations.size()) drawn.inspections.push_back(inspection);
    }
  }
  std::ranges::reverse(rows);
  const bool truth =
      std::ranges::any_of(rows, [](const Row& row) { return !row.alignment.empty(); });
  for (const Configuration& configuration : plan.configurations) {
    const auto own = rows_of(rows, {&configuration, 1});
    const bool solved = std::ranges::any_of(own, &Row::ok);
    drawn.ok |= solved;
    if (!solved)
      drawn.failures.push_back(fmt::format("{}: {}", own.back().configuration, own.back().reason));
  }
  return with_single_windows(
      truth ? figure_over_length(rows, plan) : figure_without_truth(rows, plan),
      recording->name,
      window.start);
}

DrawnView draw_view(const std::shared_ptr<const Recording>& recording,
                    const ViewRequest& request,
                    const std::stop_token& stop) {
  const Pane* pane = find_pane(request.view);
  if (pane == nullptr)
    throw SettingError(
        "view",
        fmt::format("'{}', expected one of {}", request.view, fmt::join(pane_names(), ", ")));
  const std::string key = pane->key;
  if (key == "compare") return draw_compare(recording, request, stop);
  return key == "curves" ? draw_curves(recording, request, stop)
                         : draw_one(recording, request, key, stop);
}

}  // namespace gpo
