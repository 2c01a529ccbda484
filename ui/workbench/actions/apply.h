// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/commands.h"
#include "ui/workbench/state.h"

namespace gpo {

void apply(WorkbenchState& state, const Command& command);

}  // namespace gpo
