// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <memory>

namespace gpo {

/// Takes a recording that was opened: fits the window into it and shows the window's last frame; or
/// the one that is open with another camera: frame and bookmarks stay.
void apply_recording(WorkbenchState& state, std::shared_ptr<const Recording> recording);

}  // namespace gpo
