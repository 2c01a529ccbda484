// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panes.h"
#include "ui/panels/widgets.h"

namespace gpo {

void normals_pane(const PanelInput& /*input*/,
                  const Rectangle& place,
                  Views& /*views*/,
                  Commands& /*commands*/) {
  draw_empty(place, "The sphere of normals appears when the window is computed");
}

}  // namespace gpo
