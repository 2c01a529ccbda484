// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <vector>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// Cached recordings of recipes with this name.
std::vector<fs::path> recordings_of(const std::string& name) {
  fs::create_directories(GPO_RECORDINGS_DIR);
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(GPO_RECORDINGS_DIR)) {
    if (entry.path().filename().string().starts_with(name + "-")) folders.push_back(entry.path());
  }
  return folders;
}

/// A recipe whose recording is not cached yet.
fs::path fresh_recipe(const std::string& name, const std::string& text) {
  for (const fs::path& folder : recordings_of(name)) fs::remove_all(folder);
  const fs::path recipe = fresh_folder() / (name + ".yaml");
  write_file(recipe, text);
  return recipe;
}

/// A recipe large enough for tracking.
std::string inspectable_recipe() {
  std::string text = small_recipe_with("resolution: [160, 120]", "resolution: [320, 240]");
  const std::string intrinsics = "[125, 124, 80.4, 59.2]";
  return text.replace(text.find(intrinsics), intrinsics.size(), "[250, 248, 160.4, 119.2]");
}

TEST(RecipeAsRecording, InfoNamesThePathOfTheRecipe) {
  const fs::path recipe = fresh_recipe("infotest", small_recipe_text());
  const Outcome first = succeeding("info --json " + recipe.string());
  EXPECT_EQ(first.err, "");  // no progress bar without a terminal
  const json info = json::parse(first.out);
  EXPECT_EQ(info["recording"], recipe.string());
  EXPECT_EQ(info["frames"], 4);
  EXPECT_EQ(program("info --json " + recipe.string()).out, first.out);
}

TEST(RecipeAsRecording, RunNamesTheRecordingAfterTheRecipe) {
  const fs::path recipe = fresh_recipe("runtest", inspectable_recipe());
  const Outcome outcome = program("run " + recipe.string() + " --frames 4 --json -");
  EXPECT_THAT(outcome.err, HasSubstr("recording   runtest\n"));
  EXPECT_EQ(json::parse(outcome.out)["recording"], recipe.string());
}

TEST(RecipeAsRecording, SnapshotDrawsIt) {
  const fs::path recipe = fresh_recipe("snapshottest", inspectable_recipe());
  const fs::path image = recipe.parent_path() / "picture.png";
  program("snapshot " + recipe.string() + " --frames 4 --view image --output " + image.string());
  EXPECT_TRUE(fs::exists(image));
}

/// Interrupts the program as soon as the file `begun` exists.
Outcome interrupted(const std::string& arguments, const std::string& begun) {
  return shell("'" GPO_PROGRAM "' " + arguments + " & pid=$!; for i in $(seq 4000); do [ -e " +
               begun + " ] && break; sleep 0.005; done; kill -INT $pid; wait $pid");
}

TEST(Synthesize, InterruptionLeavesNothing) {
  const fs::path recipe = fresh_recipe("interrupted", small_recipe_with("count: 4", "count: 1000"));
  const std::string output = (recipe.parent_path() / "out").string();
  const Outcome outcome = interrupted("synthesize " + recipe.string() + " --output " + output,
                                      output + ".unfinished/mav0/imu0/data.csv");
  expect_exit(1, outcome, "gpo-inspector: stopped; " + output + " was not written\n");
  EXPECT_FALSE(fs::exists(output));
  EXPECT_FALSE(fs::exists(output + ".unfinished"));
}

TEST(Synthesize, InterruptionOfRunLeavesNothing) {
  const fs::path recipe =
      fresh_recipe("interruptedrun", small_recipe_with("count: 4", "count: 1000"));
  const Outcome outcome = interrupted("run " + recipe.string(),
                                      GPO_RECORDINGS_DIR "/interruptedrun-*/*/mav0/imu0/data.csv");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.err, "gpo-inspector: stopped; the synthesis was discarded\n");
  for (const fs::path& folder : recordings_of("interruptedrun"))
    EXPECT_FALSE(fs::exists(folder / "interruptedrun")) << folder;
}

TEST(RecipeAsRecording, ConcurrentProcessesShareIt) {
  const fs::path recipe = fresh_recipe("sharetest", small_recipe_text());
  const std::string info = "'" GPO_PROGRAM "' info --json " + recipe.string();
  const std::string others =
      info + " > /dev/null & first=$! ; " + info + " > /dev/null & second=$! ; ";
  const Outcome outcome = shell(others + info + " && wait $first && wait $second");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["frames"], 4);
  EXPECT_EQ(recordings_of("sharetest").size(), 1U);
}

TEST(RecipeAsRecording, BrokenRecipeIsRefusedWithOneLine) {
  const fs::path recipe = fresh_recipe("brokentest", small_recipe_with("rate: 200", "rate: fast"));
  const fs::path empty = recipe.parent_path() / "empty";
  fs::create_directories(empty);
  for (const std::string command : {"info ", "run ", "view "})
    expect_refused(program(command + recipe.string()),
                   {"", "brokentest.yaml:27: key `gyroscope.rate`: found \"fast\""},
                   empty);
  EXPECT_TRUE(recordings_of("brokentest").empty());
  EXPECT_EQ(program("info " + (empty / "none.yaml").string()).exit_code, 2);
}

}  // namespace
}  // namespace gpo::test
