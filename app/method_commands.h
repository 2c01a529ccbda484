// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/commands/command_method.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gpo {

/// The user's own methods, as the command line tells them.
struct MethodArguments {
  std::vector<std::string> commands;  ///< "NAME=COMMAND"
  double timeout_s = 30;              ///< of a window
};

/// To be had by every command that initializes.
void add_method_commands(CLI::App& command, MethodArguments& arguments);

/// Adds the methods that the command line tells to the table, before it is read for the other
/// options, which name methods. What a command writes on standard error comes out on ours. Throws
/// InputError.
void register_method_commands(int argc, const char* const* argv);

}  // namespace gpo
