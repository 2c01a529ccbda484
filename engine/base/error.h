// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <stdexcept>
#include <string>
#include <string_view>

namespace gpo {

/// Escapes a text of any bytes for one line: controls and invalid UTF-8 as in \x1B, line breaks as
/// \n. Replaces everything beyond `max_bytes` by "...".
std::string legible(std::string_view text, std::size_t max_bytes);

/// Bad input that a user can correct. The message is one line with the file, line, key or option,
/// the found and the expected value; the constructor makes it legible. Caught in `app` (exit code
/// 2) and in the window's worker. A failed initialization is no error but a value with a reason.
struct InputError : std::runtime_error {
  explicit InputError(std::string_view message);
};

/// Bad value of a setting or argument. The message is "NAME: ..."; the command line replaces the
/// name by the option.
struct SettingError : InputError {
  SettingError(const std::string& name, std::string_view message);
  std::string name;  ///< "ransac_threshold_px"
};

/// Returns the message of an InputError or system error; all other exceptions are reported as
/// internal errors.
std::string message_of(const std::exception& error);

/// "1 track", "0 tracks", "7 tracks". `noun` is a singular whose plural ends in s.
template <std::integral Count>
std::string counted(Count count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace gpo
