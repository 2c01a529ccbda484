// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"

namespace gpo {

/// What is compared, in rows at the top of a panel: a chip each in its method's color with an x
/// that removes it, and a "+" that lists what can be added. Returns how high that is [px].
float compare_chips(const PanelInput& input, const Rectangle& place, Commands& commands);

}  // namespace gpo
