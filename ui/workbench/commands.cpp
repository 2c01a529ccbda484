// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/commands.h"

namespace gpo {

void push(Commands& commands, const Command& command) { commands.push_back(command); }

}  // namespace gpo
