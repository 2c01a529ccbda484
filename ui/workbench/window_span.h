// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings.h"

namespace gpo {

/// The nearest settings whose window fits into so many frames (at least two).
Settings fit_window(Settings settings, int frame_count);

/// The window from `frame` on to its old end, or of its old length where it would end before.
Settings start_window_at(Settings settings, int frame, int frame_count);

/// The window from its old start up to `frame`, or of its old length where it would start after.
Settings end_window_at(Settings settings, int frame, int frame_count);

}  // namespace gpo
