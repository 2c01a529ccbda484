// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/external_methods/own_method.h"
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

/// Parses "NAME=COMMAND". Throws InputError.
NamedText parse_method_command(const std::string& text);

struct CommandOptions {
  std::chrono::milliseconds time_limit{30'000};  ///< per window, including the start of the process
  /// Called for each line on a command's standard error, up to a limit per window, on the calling
  /// thread of the method.
  std::function<void(const std::string& name, const std::string& line)> on_line = {};
  /// While false, no process is started; null: the user gave the command.
  std::shared_ptr<const std::atomic<bool>> allowed = {};
};

/// Returns a user's own method: a shell command that reads each window as a line and answers with a
/// line (see README.md). It starts one process per calling thread and keeps the processes until its
/// last copy is destroyed. Errors of a command are failures of that window with a reason in one
/// line. `number`: among the user's methods, for its color.
Method command_method(const NamedText& command, const CommandOptions& options, int number);

/// Returns the input of a user's own method, as in `method_window.schema.json` but without `id`.
/// Unknown values are missing; unseen pixels are null.
nlohmann::ordered_json window_json(const Window& window, const Sources& sources);

}  // namespace gpo
