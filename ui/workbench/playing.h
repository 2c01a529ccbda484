// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <optional>

namespace gpo {

/// Shows the frame, or the nearest that there is.
void go_to_frame(WorkbenchState& state, int frame);

/// Lets `seconds` pass: plays at the recording's own rate, and stops at its last frame.
void advance(WorkbenchState& state, double seconds);

/// Until `advance` shows another frame [s]; nothing where it will not.
std::optional<double> seconds_to_next_frame(const WorkbenchState& state);

/// How long the message is still to be shown; nothing: there is none. Errors stay until the next
/// one.
std::optional<double> seconds_of_message(const WorkbenchState& state);

}  // namespace gpo
