// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <string>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

TEST(Info, JsonIsPrintedOrWrittenToAFile) {
  const std::string file = (fresh_folder() / "deep/info.json").string();
  const std::string printed = program("info --json {}", kDesk).out;
  EXPECT_TRUE(json::accept(printed));
  for (const auto& [arguments, to_file] : {std::pair{kDesk + " --json", false},
                                           {kDesk + " --json -", false},
                                           {"--json - " + kDesk, false},
                                           {kDesk + " --json " + file, true},
                                           {"--json " + file + " " + kDesk, true},
                                           {"--json=" + file + " " + kDesk, true}}) {
    const Outcome outcome = succeeding("info {}", arguments);
    EXPECT_EQ(outcome.out, to_file ? "" : printed) << arguments;
    EXPECT_EQ(to_file ? read_file(file) : outcome.out, printed) << arguments;
    fs::remove_all(fs::path(file).parent_path());
  }
}

TEST(Info, DoesNotOverwriteARecording) {
  const fs::path recipe = fresh_folder() / "mine.yaml";
  write_file(recipe, "seed: 1\n");
  expect_exit(2,
              program("info --json {} {}", recipe, kDesk),
              "mine.yaml already exists and is not a .json file");
  EXPECT_EQ(read_file(recipe), "seed: 1\n");
  EXPECT_THAT(program("info --json").err, HasSubstr("recording"));
}

/// A file that is easily mistaken for a recording.
struct Mistaken {
  std::string name, content, message;
};

const std::vector<Mistaken> kMistaken = {
    {"board.yaml",
     "{pattern: chessboard, columns: 9, rows: 6, square: 0.025}",
     "the description of a printed board, expected a recording"},
    {"plane.yaml", "normal: [0, 0, 1]\ndistance: 0\n", "the true plane of a recording, expected"},
    {"camera.yaml",
     "resolution: [8, 6]\nintrinsics: [6, 6, 4, 3]\n",
     "the calibration of a camera, expected"},
    {"calibration.json",
     R"({"camera_matrix": {"rows": 3}})",
     "the calibration of a camera, expected"},
    {"groundtruth.yaml", "T_truth_camera: []\n", "the mounting of a ground truth, expected"},
    {"s.json",
     R"({"kind": "gpo-inspector session", "version": 1})",
     "a session, expected a recording; `view --session` opens it"},
    {"results.csv", "recording,configuration,", "results of `evaluate`, expected a recording"},
    {"a.png", "x", "one image, expected a recording"}};

TEST(KnownFile, IsRecognizedAndRefused) {
  for (const auto& [name, content, message] : kMistaken) {
    const fs::path file = fresh_folder() / name;
    write_file(file, content);
    for (const std::string command : {"info ", "run ", "evaluate --output /dev/null/x "}) {
      SCOPED_TRACE(command + name);
      expect_refused(program(command + file.string()), name + ": found " + message);
    }
  }
}

TEST(Help, UsageErrorsPointToIt) {
  const Outcome unknown = program("inspect sequences/desk");
  expect_refused(unknown, "unknown command 'inspect', expected one of view, info");
  EXPECT_THAT(unknown.err, HasSubstr("; see gpo-inspector --help\n"));
  EXPECT_THAT(program("run --bogus x").err, HasSubstr("; see gpo-inspector run --help\n"));
  EXPECT_THAT(program("--bogus").err, HasSubstr("; see gpo-inspector --help\n"));
}

TEST(Help, EveryCommandHasAHelpText) {
  succeeding("--help");
  for (const char* command :
       {"view", "info", "run", "snapshot", "evaluate", "synthesize", "convert", "calibrate"})
    EXPECT_FALSE(succeeding("{} --help", command).out.empty()) << command;
}

TEST(Help, VersionIsPrinted) {
  EXPECT_THAT(succeeding("--version").out, testing::MatchesRegex("gpo-inspector [0-9.]+\n"));
}

}  // namespace
}  // namespace gpo::test
