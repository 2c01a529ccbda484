// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/external_methods/own_method.h"
#include "ui/workbench/work/worker.h"

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gpo {

/// Messages of the user's own methods, for standard error and the window's log. Thread-safe.
class MethodLog {
 public:
  /// Prints and collects a line. After 200 lines, further ones are dropped.
  void add(const std::string& name, const std::string& line);
  /// Returns the lines since the last call.
  std::vector<std::string> take();
  /// `changed` is called after each line, on the thread that added it.
  void on_change(std::function<void()> changed);

 private:
  std::mutex mutex_;
  std::vector<std::string> lines_;
  std::function<void()> changed_;
  int count_ = 0;
};

struct MethodArguments {
  MethodSpecs specs;
  double timeout_s = 30;        ///< limit of a command per window
  bool resample = false;        ///< nine more windows each, for a command's own uncertainty
  bool allow_commands = false;  ///< also starts the commands of sessions
};

/// The user's own methods: those of the command line, then those of sessions.
class OwnMethods {
 public:
  explicit OwnMethods(const MethodArguments& arguments);

  /// Adds the methods of a session; known names keep theirs. Throws InputError and adds none.
  void add_session(const std::filesystem::path& file);
  /// Adds the names of the methods that computed the shards.
  void add_shards(const std::vector<std::filesystem::path>& folders);

  MethodTable table;  ///< built-in methods and these
  std::shared_ptr<MethodLog> log = std::make_shared<MethodLog>();
  /// "NAME=COMMAND" of the last session, not started while `allowed` is false.
  std::vector<std::string> waiting;
  std::shared_ptr<std::atomic<bool>> allowed;

 private:
  void add(const MethodSpecs& specs, const CommandOptions& options);
  CommandOptions options_;
  bool allow_commands_;
};

/// Returns what reads the methods of sessions in the background, and adds them to `own`, which must
/// outlive it, on the thread of the window. `added` is called there before the methods are used.
ReadMethods session_methods(OwnMethods& own, std::function<void(const OwnMethods& added)> added);

/// Logs each waiting command as not started, with the option that would start it.
void report_not_started(const OwnMethods& own);

void add_method_commands(CLI::App& command, MethodArguments& arguments);

}  // namespace gpo
