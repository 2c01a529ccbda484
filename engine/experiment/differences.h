// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"

namespace gpo {

/// Returns `differences` for a later experiment in the folder of an earlier one, which may add
/// methods, lengths, starts and recordings. `plan`: what the later one lacks. With other lengths
/// `end` implies other starts.
ExperimentDifferences differences_from_earlier(const Experiment& earlier, const Experiment& later);

/// Returns the identities of the user's methods on a recording, by key.
std::map<std::string, std::string> identities_on(const Experiment& experiment,
                                                 const ExperimentRecording& recording);

}  // namespace gpo
