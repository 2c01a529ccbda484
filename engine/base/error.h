// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace gpo {

/// A text as people can read it in one line, whatever its bytes: controls and what is not UTF-8
/// become \x1B and the like, line ends \n; what is beyond `most` bytes becomes "...".
std::string legible(std::string_view text, std::size_t most);

/// Bad input that a user can mend: a file, a key, a line, an option. The message is one line that
/// names the file, the line or key, what was found and what was expected; what was found is made
/// legible here. Caught once, in `app` (exit code 2) and in the worker of the window. What merely
/// fails to initialize is not an error but a value with a reason (`Initialization`).
struct InputError : std::runtime_error {
  explicit InputError(std::string_view message);
};

/// Bad input in a value that has a name: a setting, or an argument. The message is
/// "NAME: what was found, what was expected"; the command line, where the value is an option,
/// writes the name as one.
struct SettingError : InputError {
  SettingError(const std::string& name, std::string_view message);
  std::string name;  ///< "ransac_threshold_px"
};

/// What to say of an exception: its message where it is bad input or something that the system
/// refuses (a file, a thread), else that it is an internal error.
std::string message_of(const std::exception& error);

}  // namespace gpo
