// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/methods.h"

#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace gpo
