// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/panels/facts/result_row.h"

#include <string>

namespace gpo {

/// Of the group above whose rows the verdict's badge stands.
constexpr const char* kVerdictTitle = "VERDICT";

/// What the badge rests on; it tells the normal's itself. Of an inspection with a result.
ResultGroup verdict_group(const Inspection& inspection);

/// How sure the result is, told from itself, without any truth.
ResultGroup uncertainty_group(const Inspection& inspection);

/// What the time line's bar at a frame of the recording says: inliers, and the verdict of the
/// window that ends there.
std::string bar_text(const Inspection& inspection, int frame);

}  // namespace gpo
