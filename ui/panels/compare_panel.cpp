// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"

namespace gpo {

void compare_panel(const PanelInput& /*input*/,
                   const Rectangle& place,
                   Views& /*views*/,
                   Commands& /*commands*/) {
  const PanelScope panel("compare", place, {0, 0});
  draw_empty(place, "The compared methods appear side by side when they are computed");
}

}  // namespace gpo
