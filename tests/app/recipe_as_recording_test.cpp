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

TEST(RecipeAsRecording, InfoNamesThePathOfTheRecipe) {
  const fs::path recipe = fresh_recipe("infotest", small_recipe_text());
  const Outcome first = succeeding("info --json {}", recipe);
  EXPECT_EQ(first.err, "");  // no progress bar without a terminal
  const json info = json::parse(first.out);
  EXPECT_EQ(info["recording"], recipe.string());
  EXPECT_EQ(info["frames"], 4);
  EXPECT_EQ(program("info --json {}", recipe).out, first.out);
}

TEST(RecipeAsRecording, RunNamesTheRecordingAfterTheRecipe) {
  // Large enough for tracking.
  const fs::path recipe =
      fresh_recipe("runtest",
                   replaced(small_recipe_text(),
                            {{"resolution: [160, 120]", "resolution: [320, 240]"},
                             {"[125, 124, 80.4, 59.2]", "[250, 248, 160.4, 119.2]"}}));
  const Outcome outcome = program("run {} --frames 4 --json -", recipe);
  EXPECT_THAT(outcome.err, HasSubstr("recording   runtest\n"));
  EXPECT_EQ(json::parse(outcome.out)["recording"], recipe.string());
}

TEST(Synthesize, InterruptionLeavesNothing) {
  const fs::path recipe = fresh_recipe("interrupted", small_recipe_with("count: 4", "count: 1000"));
  const std::string output = (recipe.parent_path() / "out").string();
  const Outcome outcome = signaled("INT",
                                   "[ -e " + output + ".unfinished/mav0/imu0/data.csv ]",
                                   fmt::format("synthesize {} --output {}", recipe, output));
  expect_exit(1, outcome, "gpo-inspector: stopped; " + output + " was not written\n");
  EXPECT_FALSE(fs::exists(output));
  EXPECT_FALSE(fs::exists(output + ".unfinished"));
}

TEST(Synthesize, InterruptionOfRunLeavesNothing) {
  const fs::path recipe =
      fresh_recipe("interruptedrun", small_recipe_with("count: 4", "count: 1000"));
  const Outcome outcome =
      signaled("INT",
               "[ -e " GPO_RECORDINGS_DIR "/interruptedrun-*/*/mav0/imu0/data.csv ]",
               "run " + recipe.string());
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
  const Outcome outcome = shell("{}{} && wait $first && wait $second", others, info);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["frames"], 4);
  EXPECT_EQ(recordings_of("sharetest").size(), 1U);
}

TEST(RecipeAsRecording, BrokenRecipeIsRefusedWithOneLine) {
  const fs::path recipe = fresh_recipe("brokentest", small_recipe_with("rate: 200", "rate: fast"));
  for (const std::string command : {"info ", "run ", "view "})
    expect_refused(program(command + recipe.string()),
                   "brokentest.yaml:27: key `gyroscope.rate`: found \"fast\"");
  EXPECT_TRUE(recordings_of("brokentest").empty());
  EXPECT_EQ(program("info {}", recipe.parent_path() / "none.yaml").exit_code, 2);
}

}  // namespace
}  // namespace gpo::test
