// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "app/methods/method_log.h"
#include "engine/commands/spelled_methods.h"

#include <atomic>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gpo {

/// The user's own methods, as the command line tells them.
struct MethodArguments {
  SpelledMethods spelled;
  double timeout_s = 30;        ///< of a command, a window
  bool allow_commands = false;  ///< those of sessions are started, too
};

/// Those that are in the table.
struct OwnMethods {
  std::shared_ptr<MethodLog> log = std::make_shared<MethodLog>();
  /// "NAME=COMMAND" of sessions, which are not started while `allowed` is false.
  std::vector<std::string> waiting;
  std::shared_ptr<std::atomic<bool>> allowed = std::make_shared<std::atomic<bool>>(false);
};

/// Says on standard error that those that wait are not started, and what would start them.
void say_not_started(const OwnMethods& own);

/// To be had by every command that initializes.
void add_method_commands(CLI::App& command, MethodArguments& arguments);

/// Adds the methods of the user's that the command line tells to the table, before it is read for
/// the other options, which name methods; and those of the session that it names, or of the
/// sessions that its script opens; and, to merge shards, names of those that made them. What is
/// told twice is as the command line has it. Throws InputError.
OwnMethods register_methods(int argc, const char* const* argv);

}  // namespace gpo
