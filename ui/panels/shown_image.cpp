// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panels.h"

namespace gpo {
namespace {

/// Whether it is there: then it is in `views`, or why there is none.
bool bring(const PanelInput& input, int frame, Views& views) {
  const FetchedImage image = image_of(input, frame);
  if (image.waiting) return false;
  views.frame = frame;
  views.image_error = image.error;
  views.pixels = image.bgr;
  if (!image.bgr.empty()) views.image.upload(image.bgr);
  return true;
}

}  // namespace

FetchedImage image_of(const PanelInput& input, int frame) {
  const auto& images = input.state.document.recording->images;
  return input.fetcher != nullptr ? input.fetcher->get(images, frame)
                                  : fetch_image(*images, frame);
}

int update_image(const PanelInput& input, Views& views) {
  const WorkbenchState& state = input.state;
  if (views.recording != state.document.recording) {
    views.recording = state.document.recording;
    views.frame = views.asked = -1;
    views.image_error.clear();
  }
  if (!state.document.recording->images) return state.view.frame;
  // What was asked for is shown first, though the frame has changed since: where pictures come more
  // slowly than they are played, none would ever be in time.
  if (views.asked >= 0 && bring(input, views.asked, views)) views.asked = -1;
  if (views.asked < 0 && views.frame != state.view.frame) {
    // What is played next is there by then.
    if (state.view.playing && input.fetcher != nullptr &&
        state.view.frame + 1 < state.frame_count())
      image_of(input, state.view.frame + 1);
    if (!bring(input, state.view.frame, views)) views.asked = state.view.frame;
  }
  return views.frame >= 0 ? views.frame : state.view.frame;
}

ImageTexture* shown_image(Views& views) {
  const bool there = views.recording && views.recording->images && views.frame >= 0 &&
                     views.image_error.empty();
  return there ? &views.image : nullptr;
}

}  // namespace gpo
