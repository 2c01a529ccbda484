// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Image and comparison without what one clicks, for screenshots, snapshots and movies.
#include "ui/panels/panels.h"
#include "ui/panels/panes/view_options.h"

#include <imgui.h>

namespace gpo {

void image_alone(const PanelInput& input,
                   const Rectangle& place,
                   Views& views,
                   Commands& /*commands*/) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto other = flipped_result(input.state);
  const Inspection* inspection = other ? other->inspection.get() : input.inspection();
  const Inspection waiting =
      inspection ? Inspection{} : nothing_to_show(input.state.document.recording);
  const int frame = update_image(input, views);
  const ViewOptions options =
      view_options(other ? showing(input.state, *other) : input.state, views);
  draw_image_view(list,
                  screen_rect(place),
                  {inspection ? *inspection : waiting, frame, options},
                  shown_image(views),
                  {});
  if (other) draw_flip_label(list, screen_rect(place), *other);
}

/// The columns alone, without what one clicks.
void compare_alone(const PanelInput& input,
                   const Rectangle& place,
                   Views& views,
                   Commands& /*commands*/) {
  const WorkbenchState& state = input.state;
  const int frame = update_image(input, views);
  ViewOptions options = view_options(state, views);
  options.compare_zoom = state.view.compare_zoom;
  draw_compare_view(*ImGui::GetBackgroundDrawList(),
                    screen_rect(place),
                    compare_columns(compared_results(state)),
                    {.recording = *state.document.recording,
                     .frame = frame,
                     .image = shown_image(views),
                     .options = options});
}

}  // namespace gpo
