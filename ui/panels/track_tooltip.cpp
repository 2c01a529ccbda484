// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/track_tooltip.h"

#include "engine/inspection/studies/track_life.h"
#include "ui/look/numbers.h"
#include "ui/panels/widgets.h"
#include "ui/views/overlay/plane_style.h"
#include "ui/workbench/state.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {

namespace {

std::string frame_text(const TrackLife& life, int frame) {
  const auto found = std::ranges::find(life.frames, frame, &TrackFrame::frame);
  if (found == life.frames.end()) return fmt::format("not seen in frame {}\n", frame);
  std::string text = fmt::format("at ({:.2f}, {:.2f}) px\n", found->raw_px.x(), found->raw_px.y());
  if (found->residual_px) text += fmt::format("residual {:.2f} px", *found->residual_px);
  if (found->transfer_px)
    text += fmt::format(
        "{}transfer error {:.2f} px", found->residual_px ? " \u00b7 " : "", *found->transfer_px);
  if (found->residual_px || found->transfer_px) text += "\n";
  return text;
}

}  // namespace

void track_tooltip(const PanelInput& input, Views& views, std::int64_t track) {
  const Inspection* inspection = input.inspection();
  const auto column = inspection ? column_of(*inspection->tracks, track) : std::nullopt;
  if (!column) return;
  const TrackLife& life = views.lives.of(*inspection, *column);
  std::string text = fmt::format("track {}\n", track) + frame_text(life, input.state.view.frame);
  if (life.depth) text += fmt::format("depth {:.3f} d\n", *life.depth);
  if (life.inlier_since && life.inlier_until)
    text += fmt::format("inlier from frame {} to {}\n", *life.inlier_since, *life.inlier_until);
  show_tooltip(text + life.verdict);
}

void camera_tooltip(const PanelInput& input, int frame) {
  const Inspection& inspection = *input.inspection();
  const int in_window = frame - inspection.window->start;
  const Eigen::Vector3d& center = inspection.initialization->cameras[in_window].p_wc;
  show_tooltip(
      fmt::format("camera of frame {}\ncenter ({:.3f}, {:.3f}, {:.3f}) d\n{} inliers\n"
                  "click: go to the frame",
                  frame,
                  center.x(),
                  center.y(),
                  center.z(),
                  inspection.window->inlier_count(in_window)));
}

void lead_with(const WorkbenchState& state, std::int64_t id, Commands& commands) {
  if (!state.results.inspection) return;
  const auto plane = to_main_plane(*state.results.inspection, id);
  if (!plane) return;
  Settings settings = state.document.settings;
  settings.options.plane = *plane;
  push(commands, ChangeSettings{settings});
}

}  // namespace gpo
