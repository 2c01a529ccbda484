// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "app/methods/method_log.h"
#include "engine/external_methods/command_method.h"
#include "engine/external_methods/method_specs.h"

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gpo {

/// The user's own methods, as the command line tells them.
struct MethodArguments {
  MethodSpecs spelled;
  double timeout_s = 30;        ///< of a command, a window
  bool allow_commands = false;  ///< those of sessions are started, too
};

/// The user's own methods: those of the command line, then those of sessions.
class OwnMethods {
 public:
  /// Adds those of the command line. Throws InputError.
  explicit OwnMethods(const MethodArguments& arguments);

  /// Adds the methods that a session names; nothing if the file is no session. A method whose name
  /// is known stays as it is. Throws InputError, then nothing is added.
  void add_session(const std::filesystem::path& file);
  /// Adds the names of those that made shards, which are to be merged.
  void add_shards(const std::vector<std::filesystem::path>& folders);

  MethodTable table;  ///< ours and these
  std::shared_ptr<MethodLog> log = std::make_shared<MethodLog>();
  /// "NAME=COMMAND" of the last session, which are not started while `allowed` is false.
  std::vector<std::string> waiting;
  std::shared_ptr<std::atomic<bool>> allowed;

 private:
  void add(const MethodSpecs& spelled, const CommandOptions& options);
  CommandOptions options_;
  bool allow_commands_;
};

/// Says on standard error that those that wait are not started, and what would start them.
void say_not_started(const OwnMethods& own);

/// To be had by every command that initializes.
void add_method_commands(CLI::App& command, MethodArguments& arguments);

}  // namespace gpo
