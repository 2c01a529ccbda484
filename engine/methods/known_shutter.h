// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/window/window.h"

namespace gpo {

/// Returns the result of `initialize_gpo_joint` for the window corrected for its own `row_delay`,
/// whose standard deviation adds to all uncertainties.
Initialization initialize_at_row_delay(const Window& window,
                                       const MethodOptions& options,
                                       const Watch& watch);

}  // namespace gpo
