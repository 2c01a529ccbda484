// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panels.h"

namespace gpo {
namespace {

/// Whether it is there: then it is in `views`, or why there is none.
bool bring(const PanelInput& input, int frame, Views& views) {
  const FetchedPicture picture = picture_of(input, frame);
  if (picture.waiting) return false;
  views.frame = frame;
  views.picture_error = picture.error;
  views.pixels = picture.bgr;
  if (!picture.bgr.empty()) views.picture.upload(picture.bgr);
  return true;
}

}  // namespace

FetchedPicture picture_of(const PanelInput& input, int frame) {
  const auto& pictures = input.state.document.recording->pictures;
  return input.fetcher != nullptr ? input.fetcher->get(pictures, frame)
                                  : fetch_picture(*pictures, frame);
}

int update_picture(const PanelInput& input, Views& views) {
  const WorkbenchState& state = input.state;
  if (views.recording != state.document.recording) {
    views.recording = state.document.recording;
    views.frame = views.asked = -1;
    views.picture_error.clear();
  }
  if (!state.document.recording->pictures) return state.view.frame;
  // What was asked for is shown first, though the frame has changed since: where pictures come more
  // slowly than they are played, none would ever be in time.
  if (views.asked >= 0 && bring(input, views.asked, views)) views.asked = -1;
  if (views.asked < 0 && views.frame != state.view.frame) {
    // What is played next is there by then.
    if (state.view.playing && input.fetcher != nullptr &&
        state.view.frame + 1 < state.frame_count())
      picture_of(input, state.view.frame + 1);
    if (!bring(input, state.view.frame, views)) views.asked = state.view.frame;
  }
  return views.frame >= 0 ? views.frame : state.view.frame;
}

PictureTexture* shown_picture(Views& views) {
  const bool there = views.recording && views.recording->pictures && views.frame >= 0 &&
                     views.picture_error.empty();
  return there ? &views.picture : nullptr;
}

}  // namespace gpo
