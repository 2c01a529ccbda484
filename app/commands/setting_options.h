// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/configuration.h"
#include "engine/inspection/inspection.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gpo {

/// What a setting or an argument is called on the command line: "--ransac-threshold-px".
std::string option_name(std::string name);

/// One option a setting. `given` receives the keys of those that are given.
void add_settings(CLI::App& command, Settings& settings, std::vector<std::string>& given);

/// Says which of the given settings changed nothing and why, a line each, on standard error.
void tell_unused(std::span<const std::string> given, const Inspection& inspection);
/// The same of a comparison: what none of its methods reads, and what they say themselves.
void tell_unused(std::span<const std::string> given,
                 std::span<const Configuration> compared,
                 std::span<const std::shared_ptr<const Inspection>> inspections);

}  // namespace gpo
