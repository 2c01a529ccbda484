// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panels.h"

#include <algorithm>

namespace gpo {

FetchedPicture picture_of(const PanelInput& input, int frame) {
  const auto& pictures = input.state.recording->pictures;
  return input.fetcher != nullptr ? input.fetcher->get(pictures, frame)
                                  : fetch_picture(*pictures, frame);
}

int update_picture(const PanelInput& input, Views& views) {
  const WorkbenchState& state = input.state;
  const bool another = views.recording != state.recording;
  if (!another && views.frame == state.frame) return state.frame;
  if (!state.recording->pictures) {
    views.recording = state.recording;
    views.frame = state.frame;
    return state.frame;
  }
  // What will be played next is there by then.
  if (state.playing && input.fetcher != nullptr)
    picture_of(input, std::min(state.frame + 1, state.frame_count() - 1));
  const FetchedPicture picture = picture_of(input, state.frame);
  if (picture.waiting && !another) return views.frame >= 0 ? views.frame : state.frame;
  views.recording = state.recording;
  views.frame = picture.waiting ? -1 : state.frame;
  views.picture_error = picture.error;
  if (!picture.bgr.empty()) views.picture.upload(picture.bgr);
  return state.frame;
}

PictureTexture* shown_picture(Views& views) {
  const bool there = views.recording && views.recording->pictures && views.frame >= 0 &&
                     views.picture_error.empty();
  return there ? &views.picture : nullptr;
}

}  // namespace gpo
