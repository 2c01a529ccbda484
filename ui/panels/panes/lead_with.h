// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/commands.h"
#include "ui/workbench/state.h"

#include <cstdint>

namespace gpo {

/// The plane of the track of this id leads from now on, where another one does.
void lead_with(const WorkbenchState& state, std::int64_t id, Commands& commands);

}  // namespace gpo
