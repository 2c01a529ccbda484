// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/method_options.h"
#include "engine/methods/methods.h"
#include "engine/window/window.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace gpo {

/// The name of a user's method with its command or files.
struct NamedText {
  std::string name;  ///< key and title
  std::string text;
};

/// Parses "NAME=TEXT". Throws InputError that names the option and the expected syntax.
NamedText parse_named(const std::string& text, const char* option, const char* expected);

/// Returns a row of the method table for a user's method. `number`: among these, for its color.
Method own_method(const std::string& name,
                  int number,
                  decltype(Method::initialize_from) initialize_from,
                  std::string identity);

/// Returns the CRC-32 of a file, 8 digits; empty if it is no file.
std::string checksum_of(const std::filesystem::path& file);

/// The user's own methods as written in options and sessions.
struct MethodSpecs {
  std::vector<std::string> commands;  ///< "NAME=COMMAND"
  std::vector<std::string> results;   ///< "NAME=FILE[,POINTS][,frame=camera|body]"
};

/// Returns the user's methods of a table, for a session.
MethodSpecs specs_in(const MethodTable& methods);

/// Returns a result's text with absolute paths.
std::string with_whole_paths(const std::string& result);

/// Returns `method_commands` and `results` of a session (JSON), empty for other files. Throws
/// InputError if these are no lists of texts.
MethodSpecs methods_in_session(const std::filesystem::path& file);

/// Parses "NAME=COMMAND". Throws InputError.
NamedText parse_method_command(const std::string& text);

struct CommandOptions {
  std::chrono::milliseconds time_limit{30'000};  ///< per window, including the start of the process
  bool resampled = false;  ///< `Method::resampled`: ten more windows for its own uncertainty
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
