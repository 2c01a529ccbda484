// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panes.h"
#include "ui/panels/widgets.h"

namespace gpo {

void curves_drawer(const PanelInput& /*input*/,
                   const Rectangle& place,
                   Views& /*views*/,
                   Commands& /*commands*/) {
  draw_empty(place, "Curves of the errors over the length of the window appear here");
}

}  // namespace gpo
