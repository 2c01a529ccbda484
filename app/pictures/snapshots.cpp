// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/pictures/snapshots.h"

#include "engine/base/error.h"
#include "engine/inspection/inspector.h"
#include "ui/views/figures/figure_view.h"
#include "ui/views/snapshot.h"
#include "ui/workbench_window.h"

#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

std::string failure_text(const std::string& what, const std::string& reason) {
  return fmt::format("{}: initialization failed: {}", what, reason);
}

/// The frame that is asked for, or the window's last.
int frame_to_draw(const ViewRequest& request, const Recording& recording) {
  const Settings& settings = request.compared.window;
  const int frame = request.frame.value_or(settings.start + settings.frames - 1);
  if (frame >= 0 && frame < recording.frame_count()) return frame;
  throw SettingError("frame",
                     fmt::format("{} is not in the recording, which has frames 0 to {}",
                                 frame,
                                 recording.frame_count() - 1));
}

DrawnView draw_compare(const std::shared_ptr<const Recording>& recording,
                       const ViewRequest& request) {
  DrawnView drawn;
  drawn.inspections = inspect_each(recording, request.compared);
  drawn.picture =
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

DrawnView draw_curves(const std::shared_ptr<const Recording>& recording,
                      const ViewRequest& request) {
  const LengthCurves curves = curves_over_length(recording, request.compared);
  const cv::Size pixels = request.size.value_or(default_figure_size(curves.figure));
  return {draw_figure(curves.figure, pixels), curves.any_ok, curves.longest, curves.failures};
}

cv::Mat picture_of(const ViewRequest& request,
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
  DrawnView drawn{picture_of(request, pane, inspection), result.ok, {inspection}};
  if (!result.ok)
    drawn.failures.push_back(failure_text(inspection->settings.method, result.reason));
  return drawn;
}

}  // namespace

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
