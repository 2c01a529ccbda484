// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/row.h"

#include <span>
#include <string>
#include <vector>

namespace gpo::test {

/// A solved window with the errors given, or where there are none a failed one.
Row made_row(const std::string& configuration,
             int start,
             int frames,
             std::optional<double> pne_deg);

/// Without what differs from run to run.
std::string csv_without_times(std::vector<Row> rows);

}  // namespace gpo::test
