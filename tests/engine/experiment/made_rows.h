// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/row.h"

#include <span>
#include <string>
#include <vector>

namespace gpo::test {

/// Returns a solved window with this error, or a failed one for nullopt.
Row made_row(const std::string& configuration,
             int start,
             int frames,
             std::optional<double> pne_deg);

/// Returns results.csv without running times, which differ from run to run.
std::string csv_without_times(std::vector<Row> rows);

}  // namespace gpo::test
