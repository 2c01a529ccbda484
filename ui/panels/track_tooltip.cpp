// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/track_tooltip.h"

#include "ui/panels/widgets.h"

#include <fmt/format.h>

namespace gpo {

void track_tooltip(const PanelInput& /*input*/, std::int64_t track) {
  show_tooltip(fmt::format("track {}", track));
}

void camera_tooltip(const PanelInput& /*input*/, int frame) {
  show_tooltip(fmt::format("camera of frame {}: click to go there", frame));
}

}  // namespace gpo
