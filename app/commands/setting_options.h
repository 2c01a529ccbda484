// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"
#include "engine/inspection/inspection.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gpo {

/// Returns the option of a setting or an argument, e.g. "--ransac-threshold-px".
std::string option_name(std::string name);

/// Adds one option per setting. `given` receives the keys of the options on the command line.
void add_settings(CLI::App& command, Settings& settings, std::vector<std::string>& given);

/// Prints the given settings that have no effect, with the reason, one per line on standard error.
void report_unused(std::span<const std::string> given, const Inspection& inspection);
/// The same for a comparison: settings that no method reads, or that the methods set themselves.
void report_unused(std::span<const std::string> given,
                   std::span<const Configuration> compared,
                   std::span<const std::shared_ptr<const Inspection>> inspections);

}  // namespace gpo
