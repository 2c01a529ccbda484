// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/panels/facts/result_row.h"

#include <string>
#include <vector>

namespace gpo {

/// A recording in a few words, for the menu bar: name, picture size, frames and rate, gyroscope,
/// truth.
std::vector<std::string> recording_facts(const Recording& recording);

/// The results of an inspection, or of none (null). Without `timings` the milliseconds are dashes.
/// `chosen_side`: of the cube, 0: the default [unit of the estimate].
std::vector<ResultGroup> result_groups(const Inspection* inspection,
                                       bool timings,
                                       double chosen_side = 0);

}  // namespace gpo
