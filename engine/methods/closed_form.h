// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/watch.h"
#include "engine/window/window.h"

namespace gpo {

/// The closed form's normal, with translations by linear least squares over the inliers.
Initialization initialize_closed_form(const Window& window, const Watch& watch);

}  // namespace gpo
