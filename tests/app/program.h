// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace gpo::test {

namespace fs = std::filesystem;
using nlohmann::json;

struct Outcome {
  int exit_code;
  std::string out;
  std::string err;
  long peak_kib = 0;  ///< peak memory
};

/// Runs a shell command in the source folder, without a display.
Outcome shell(const std::string& command);

/// Runs `gpo-inspector ARGUMENTS` as a process of its own, in the source folder and without a
/// display. Only for signals, redirections, limits and comparisons of peak memory.
Outcome spawned(const std::string& arguments);

/// Runs `gpo-inspector ARGUMENTS` in this process, in the source folder and without a display.
/// Words are quoted as in a shell, but no shell runs.
Outcome program(const std::string& arguments);

/// Runs `program` and expects exit code 0.
Outcome succeeding(const std::string& arguments);

/// Expects an exit code and a message: on standard error for 2, on either output for 1.
void expect_exit(int code, const Outcome& outcome, const std::string& message);

/// Runs `run ARGUMENTS --json -`. Returns the result, null if there is none.
json run_json(const std::string& arguments, int expected_exit = 0);

/// Expects equal values; numbers up to a relative tolerance.
void expect_same_json(const json& a, const json& b, double tolerance, const std::string& where);

/// Arguments that the program refuses, and part of its message.
struct BadInput {
  std::string arguments;
  std::string message;
};
std::ostream& operator<<(std::ostream& stream, const BadInput& bad);

/// Expects exit code 2 and one line on standard error that contains the message.
void expect_refused(const Outcome& outcome, const std::string& message);
/// Expects also that the folder is empty.
void expect_refused(const Outcome& outcome, const BadInput& bad, const fs::path& folder);

/// An empty folder for the running test.
fs::path fresh_folder();

std::string read_file(const fs::path& file);
void write_file(const fs::path& file, const std::string& content);

/// The bundled recording, and its path as an argument.
fs::path desk();
inline const std::string kDesk = GPO_SOURCE_DIR "/sequences/desk";

/// A recording that is not part of the repository; it may not exist.
fs::path shared(const std::string& name);

#define SKIP_WITHOUT(path) \
  if (!fs::exists(path)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR

/// Names of the recipes in sequences/ that tests initialize: one with easy motion, one with a
/// rolling shutter and one to be refused; all nine if GPO_ALL_RECORDINGS is set, as in
/// tests/nightly.sh.
std::vector<std::string> rendered_recordings();

}  // namespace gpo::test
