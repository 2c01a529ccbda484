// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <array>
#include <string>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// By which the program knows a results.csv.
const std::string kResultsHead = "recording,configuration,";

TEST(Info, DeskHasEverything) {
  const Outcome text = program("info " + desk().string());
  EXPECT_EQ(text.exit_code, 0);
  for (const char* found : {"60", "640", "480", "200"}) EXPECT_THAT(text.out, HasSubstr(found));
  const Outcome outcome = program("info --json " + desk().string());
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(json::accept(outcome.out));
}

TEST(Info, JsonGoesWhereItIsWanted) {
  const fs::path folder = fresh_folder();
  const std::string recording = desk().string();
  const std::string file = (folder / "deep/info.json").string();
  const std::string printed = program("info --json " + recording).out;
  EXPECT_TRUE(json::accept(printed));
  for (const std::string& arguments :
       {recording + " --json", recording + " --json -", "--json - " + recording}) {
    const Outcome outcome = program("info " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << arguments << outcome.err;
    EXPECT_EQ(outcome.out, printed) << arguments;
  }
  for (const std::string& arguments : {recording + " --json " + file,
                                       "--json " + file + " " + recording,
                                       "--json=" + file + " " + recording}) {
    const Outcome outcome = program("info " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << arguments << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(read_file(file), printed) << arguments;
    fs::remove_all(folder / "deep");
  }
}

TEST(Info, JsonIsNotWrittenOverARecording) {
  const fs::path recipe = fresh_folder() / "mine.yaml";
  write_file(recipe, "seed: 1\n");
  const Outcome outcome = program("info --json " + recipe.string() + " " + desk().string());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("mine.yaml is there already and is no .json file"));
  EXPECT_EQ(read_file(recipe), "seed: 1\n");
  EXPECT_THAT(program("info --json").err, HasSubstr("recording"));
}

/// What people take for a recording, and what the program must know it for.
class KnownFile : public testing::TestWithParam<std::array<std::string, 3>> {};

TEST_P(KnownFile, IsNamedAsWhatItIs) {
  const auto& [name, content, message] = GetParam();
  const fs::path file = fresh_folder() / name;
  write_file(file, content);
  for (const char* command : {"info ", "run ", "evaluate --output /dev/null/x "}) {
    const Outcome outcome = program(command + file.string());
    EXPECT_EQ(outcome.exit_code, 2) << command;
    EXPECT_THAT(outcome.err, HasSubstr(name + ": found " + message)) << command;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All,
    KnownFile,
    testing::Values(
        std::array<std::string, 3>{"board.yaml",
                                   "{pattern: chessboard, columns: 9, rows: 6, square: 0.025}",
                                   "the description of a printed board, expected a recording"},
        std::array<std::string, 3>{"plane.yaml",
                                   "normal: [0, 0, 1]\ndistance: 0\n",
                                   "the true plane of a recording, expected"},
        std::array<std::string, 3>{"camera.yaml",
                                   "resolution: [8, 6]\nintrinsics: [6, 6, 4, 3]\n",
                                   "the calibration of a camera, expected"},
        std::array<std::string, 3>{"calibration.json",
                                   R"({"camera_matrix": {"rows": 3}})",
                                   "the calibration of a camera, expected"},
        std::array<std::string, 3>{
            "groundtruth.yaml", "T_truth_camera: []\n", "how a truth was measured, expected"},
        std::array<std::string, 3>{"s.json",
                                   R"({"kind": "gpo-inspector session", "version": 1})",
                                   "a session, expected a recording; `view --session` opens it"},
        std::array<std::string, 3>{
            "results.csv", kResultsHead, "results of `evaluate`, expected a recording"},
        std::array<std::string, 3>{"a.png", "x", "one picture, expected a recording"}));

TEST(Help, IsPointedToWhereTheUsageIsWrong) {
  const Outcome unknown = program("inspect sequences/desk");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("unknown command 'inspect', expected one of view, info"));
  EXPECT_THAT(unknown.err, HasSubstr("; see gpo-inspector --help\n"));
  EXPECT_EQ(std::ranges::count(unknown.err, '\n'), 1) << unknown.err;
  EXPECT_THAT(program("run --bogus x").err, HasSubstr("; see gpo-inspector run --help\n"));
  EXPECT_THAT(program("--bogus").err, HasSubstr("; see gpo-inspector --help\n"));
}

TEST(Help, EveryCommandExplainsItself) {
  EXPECT_EQ(program("--help").exit_code, 0);
  for (const char* command :
       {"view", "info", "run", "snapshot", "evaluate", "synthesize", "convert", "calibrate"}) {
    const Outcome outcome = program(std::string(command) + " --help");
    EXPECT_EQ(outcome.exit_code, 0) << command;
    EXPECT_FALSE(outcome.out.empty()) << command;
  }
}

TEST(Help, VersionIsTold) {
  const Outcome outcome = spawned("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out, testing::MatchesRegex("gpo-inspector [0-9.]+\n"));
}

TEST(View, WithoutADisplayPointsToSnapshot) {
  const Outcome outcome = program("view " + desk().string());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("snapshot"));
}

}  // namespace
}  // namespace gpo::test
