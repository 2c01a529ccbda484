// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <initializer_list>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

/// Writes paths without quotes.
template <>
struct fmt::formatter<std::filesystem::path> : fmt::formatter<std::string> {
  auto format(const std::filesystem::path& path, auto& context) const {
    return fmt::formatter<std::string>::format(path.string(), context);
  }
};

namespace gpo::test {

namespace fs = std::filesystem;
using nlohmann::json;

struct Outcome {
  int exit_code;
  std::string out, err;
  long peak_kib = 0;  ///< peak memory
};

/// Runs a shell command in the source folder, without a display.
Outcome shell(const std::string& command);

/// Runs `gpo-inspector ARGUMENTS` as a process of its own, in the source folder and without a
/// display. Only for signals, redirections, limits and comparisons of peak memory.
Outcome spawned(const std::string& arguments);

/// Sends a signal to the program as soon as a shell's condition is true.
Outcome signaled(const char* signal, const std::string& condition, const std::string& arguments);

/// Runs `gpo-inspector ARGUMENTS` in this process, in the source folder and without a display.
/// Words are quoted as in a shell, but no shell runs.
Outcome program(const std::string& arguments);

/// Runs `program` and expects exit code 0.
Outcome succeeding(const std::string& arguments);

/// Runs `run ARGUMENTS --json -` and expects exit code 0. Returns the result.
json run_json(const std::string& arguments);

// The same for arguments as in fmt::format.
template <class First, class... More>
Outcome shell(fmt::format_string<First, More...> command, First&& first, More&&... more) {
  return shell(fmt::format(command, std::forward<First>(first), std::forward<More>(more)...));
}
template <class First, class... More>
Outcome program(fmt::format_string<First, More...> arguments, First&& first, More&&... more) {
  return program(fmt::format(arguments, std::forward<First>(first), std::forward<More>(more)...));
}
template <class First, class... More>
Outcome succeeding(fmt::format_string<First, More...> arguments, First&& first, More&&... more) {
  return succeeding(
      fmt::format(arguments, std::forward<First>(first), std::forward<More>(more)...));
}
template <class First, class... More>
json run_json(fmt::format_string<First, More...> arguments, First&& first, More&&... more) {
  return run_json(fmt::format(arguments, std::forward<First>(first), std::forward<More>(more)...));
}

/// Expects an exit code and a message: on standard error for 2, on either output for 1.
void expect_exit(int code, const Outcome& outcome, const std::string& message);

void expect_same_json(const json& a, const json& b, double tolerance, const std::string& where);

struct BadInput {
  std::string arguments, message;
};
/// Expects exit code 2 and one line on standard error that contains the message.
void expect_refused(const Outcome& outcome, const std::string& message);
/// Expects that `program(command + arguments)`, in which {} is the test's folder, is refused and
/// leaves nothing there.
void expect_each_refused(const std::string& command, const std::vector<BadInput>& inputs);

/// An empty folder for the running test.
fs::path fresh_folder();

std::string read_file(const fs::path& file);
inline json read_json(const fs::path& file) { return json::parse(read_file(file)); }
/// Parts of the text that match; the group with this number if it is not 0.
std::set<std::string> matches_in(const std::string& text, const char* pattern, int group = 0);
void write_file(const fs::path& file, const std::string& content);
/// The text with the first occurrence of each first text replaced by the second.
std::string replaced(std::string text,
                     const std::vector<std::pair<std::string, std::string>>& changes);

/// The bundled recording, and its path as an argument.
inline const std::string kDesk = GPO_SOURCE_DIR "/sequences/desk";
inline fs::path desk() { return kDesk; }

/// Copies the bundled recording, without some of its files and folders. Returns the copy.
fs::path copy_of_desk(const fs::path& copy, std::initializer_list<const char*> without = {});

/// A recording that is not part of the repository; it may not exist.
inline fs::path shared(const std::string& name) { return fs::path(GPO_SHARED_DIR) / "data" / name; }

#define SKIP_WITHOUT(path) \
  if (!fs::exists(path)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR

/// Debian's Python, even if another one comes first on this machine.
#define DEBIANS_PYTHON "PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "

#define SKIP_WITHOUT_PYTHONS(modules)                                 \
  if (shell(DEBIANS_PYTHON "-c 'import " modules "'").exit_code != 0) \
  GTEST_SKIP() << "Debian's Python has not all of " modules " on this machine"

/// Returns whether GPO_ALL_RECORDINGS is set, as in tests/nightly.sh.
bool all_recordings();

/// Names of the recipes in sequences/ that tests initialize: easy motion, a rolling shutter, and
/// one to be refused, or all nine.
std::vector<std::string> rendered_recordings();

}  // namespace gpo::test
