// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panes/lead_with.h"

#include "ui/views/overlay/plane_look.h"

namespace gpo {

void lead_with(const WorkbenchState& state, std::int64_t id, Commands& commands) {
  if (!state.inspection) return;
  const auto plane = to_lead(*state.inspection, id);
  if (!plane) return;
  Settings settings = state.settings;
  settings.options.plane = *plane;
  push(commands, ChangeSettings{settings});
}

}  // namespace gpo
