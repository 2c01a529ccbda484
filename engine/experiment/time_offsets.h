// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/summary.h"

namespace gpo {

/// Returns the time offsets of other programs' results, recording minus result, estimated over
/// whole recordings, with their standard deviations and what is applied [ms]. Undetermined ones are
/// empty. No lines for results without times and for recordings without a clock reference.
/// `recordings` are those of the experiment, in its order.
Table time_offset_table(const Experiment& experiment,
                        std::span<const std::shared_ptr<const Recording>> recordings);

}  // namespace gpo
