// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/method_options.h"
#include "engine/methods/methods.h"
#include "engine/window/window.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace gpo {

/// A user's own method: a command of the shell that is asked a window a line and answers with a
/// line each (README.md beside this file).
struct MethodCommand {
  std::string name;     ///< its key and its title
  std::string command;  ///< for /bin/sh
};

/// "NAME=COMMAND". Throws InputError.
MethodCommand parse_method_command(const std::string& text);

struct CommandOptions {
  std::chrono::milliseconds time_limit{30'000};  ///< of a window, with the start of the process
  /// Told each line that a command writes on its standard error, on the thread that asks; bounded a
  /// window.
  std::function<void(const std::string& name, const std::string& line)> told = {};
  /// Nothing is started while it is false; null: the user has spelled the command.
  std::shared_ptr<const std::atomic<bool>> allowed = {};
};

/// The method, which starts processes when it is asked, as many as threads ask it at once, and
/// keeps them for further windows until the last copy of it is gone. Whatever a command does is a
/// failure of that window, with a reason in one line. `number`: of the user's own, for its color.
Method command_method(const MethodCommand& command, const CommandOptions& options, int number);

/// All that a user's own method is told of a window, as `method_window.schema.json` has it but for
/// `id`. What is not known is not there; what is not seen is null.
nlohmann::ordered_json window_json(const Window& window, const Sources& sources);

}  // namespace gpo
