// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/panels/facts/result_row.h"

namespace gpo {

/// What the accelerometer says: which way is up, how large a unit is, and what the planes are to
/// gravity. Without rows where nobody asked, or there is no accelerometer.
ResultGroup gravity_group(const Inspection& inspection, double cube_side);

}  // namespace gpo
