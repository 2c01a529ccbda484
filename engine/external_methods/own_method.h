// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/methods.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace gpo {

/// A method of the user's, as a name and something: a command, or files.
struct NamedText {
  std::string name;  ///< its key and its title
  std::string text;
};

/// "NAME=TEXT". Throws InputError that names the option and says what the text is.
NamedText parse_named(const std::string& text, const char* option, const char* expected);

/// A row of the table for a method of the user's. `number`: among these, for its color.
Method own_method(const std::string& name,
                  int number,
                  decltype(Method::initialize_from) initialize_from,
                  std::string identity);

/// Of a file's bytes, 8 digits; empty of what is no file.
std::string checksum_of(const std::filesystem::path& file);

}  // namespace gpo
