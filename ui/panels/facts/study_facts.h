// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <string>

namespace gpo {

/// Why there is no study of the shown window's normals to look at, one sentence: `doing` while it
/// is computed. Empty where there is one.
std::string why_no_study(const WorkbenchState& state, const std::string& doing);

}  // namespace gpo
