// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace gpo::test {

struct Outcome {
  int exit_code;
  std::string out;
  std::string err;
  long peak_kib = 0;  ///< the most memory that it took
};

/// Runs a shell command in the source folder, without a display.
Outcome shell(const std::string& command);

/// Runs `gpo-inspector ARGUMENTS` that way, as a process of its own. Needed for signals,
/// redirections, limits, peaks that are compared, and methods of the user's, which a process
/// registers once.
Outcome spawned(const std::string& arguments);

/// Runs `gpo-inspector ARGUMENTS` in this process, in the source folder and without a display.
/// Words are quoted as in a shell, which none runs.
Outcome program(const std::string& arguments);

/// Arguments that the program refuses, and what its one line must say.
struct BadInput {
  std::string arguments;
  std::string message;
};
std::ostream& operator<<(std::ostream& stream, const BadInput& bad);

/// Expects exit code 2, one line that holds the message, and nothing in the folder.
void expect_refused(const Outcome& outcome,
                    const BadInput& bad,
                    const std::filesystem::path& folder);

/// An empty folder for the running test.
std::filesystem::path fresh_folder();

std::string read_file(const std::filesystem::path& file);
void write_file(const std::filesystem::path& file, const std::string& content);

/// The bundled recording.
std::filesystem::path desk();

/// Names of the recipes in sequences/ that tests initialize: one of easy motion, one with a rolling
/// shutter and one that is to be refused; all nine where GPO_ALL_RECORDINGS is set, as
/// tests/nightly.sh does.
std::vector<std::string> rendered_recordings();

}  // namespace gpo::test
