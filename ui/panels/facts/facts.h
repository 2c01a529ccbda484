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

/// Why the recording cannot give rotations from this source, in one line; empty where it can.
std::string why_no_rotations(const Recording& recording, RotationSource source);

/// Why a setting (a key of `visit_settings`) changes nothing beside the others, in one line; empty
/// where it does.
std::string why_idle(const Settings& settings, const std::string& key);

/// The results of an inspection, or of none (null). Without `timings` the milliseconds are dashes.
std::vector<ResultGroup> result_groups(const Inspection* inspection, bool timings);

}  // namespace gpo
