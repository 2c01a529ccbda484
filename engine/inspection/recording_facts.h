// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/recording_method.h"
#include "engine/recording/recording.h"

namespace gpo {

/// Returns what results of other programs need. The clock reference has the true rotations, or else
/// those of the gyroscope as recorded; it is null without both.
RecordingFacts recording_facts(const Recording& recording);

}  // namespace gpo
