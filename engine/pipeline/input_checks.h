// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initialize.h"
#include "engine/window/gyroscope.h"

namespace gpo {

// What the front door lets in; each throws InputError, SettingError where it is an option's.

void check_options(const InitializeOptions& options);
/// `number` of the frame for messages; `before` may be null.
void check_frame(const Frame& frame, int number, const Frame* before);
/// Samples in order, as many rates as time stamps; they need not cover anything yet.
void check_gyroscope(const Gyroscope& gyroscope);

}  // namespace gpo
