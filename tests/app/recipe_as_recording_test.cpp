// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::fresh_folder;
using test::Outcome;
using test::program;
using ::testing::HasSubstr;

/// A recipe of this test's own, whose recording is not there yet.
fs::path fresh_recipe(const std::string& name, const std::string& text) {
  fs::create_directories(GPO_RECORDINGS_DIR);
  for (const auto& made : fs::directory_iterator(GPO_RECORDINGS_DIR)) {
    if (made.path().filename().string().starts_with(name + "-")) fs::remove_all(made.path());
  }
  const fs::path recipe = fresh_folder() / (name + ".yaml");
  test::write_file(recipe, text);
  return recipe;
}

/// Enough of it to follow points through.
std::string inspectable_recipe() {
  std::string text = small_recipe_with("resolution: [160, 120]", "resolution: [320, 240]");
  const std::string intrinsics = "[125, 124, 80.4, 59.2]";
  return text.replace(text.find(intrinsics), intrinsics.size(), "[250, 248, 160.4, 119.2]");
}

TEST(RecipeAsRecording, InfoDescribesTheRecordingUnderThePathThatWasGiven) {
  const fs::path recipe = fresh_recipe("infotest", small_recipe_text());
  const Outcome first = program("info --json " + recipe.string());
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(first.err, "");  // no progress where nobody watches
  const json info = json::parse(first.out);
  EXPECT_EQ(info["recording"], recipe.string());
  EXPECT_EQ(info["frames"], 4);
  EXPECT_EQ(program("info --json " + recipe.string()).out, first.out);
}

TEST(RecipeAsRecording, RunNamesTheRecordingAfterTheRecipe) {
  const fs::path recipe = fresh_recipe("runtest", inspectable_recipe());
  const fs::path result = recipe.parent_path() / "result.json";
  const Outcome outcome =
      program("run " + recipe.string() + " --frames 4 --json " + result.string());
  EXPECT_THAT(outcome.out, HasSubstr("recording   runtest\n")) << outcome.err;
  EXPECT_EQ(json::parse(test::read_file(result))["recording"], recipe.string());
}

TEST(RecipeAsRecording, SnapshotDrawsIt) {
  const fs::path recipe = fresh_recipe("snapshottest", inspectable_recipe());
  const fs::path picture = recipe.parent_path() / "picture.png";
  program("snapshot " + recipe.string() + " --frames 4 --view image --output " + picture.string());
  EXPECT_TRUE(fs::exists(picture));
}

TEST(RecipeAsRecording, BrokenRecipeIsRefusedWithOneLine) {
  const fs::path recipe = fresh_recipe("brokentest", small_recipe_with("rate: 200", "rate: fast"));
  const fs::path empty = recipe.parent_path() / "empty";
  fs::create_directories(empty);
  for (const std::string command : {"info ", "run ", "view "}) {
    test::expect_refused(program(command + recipe.string()),
                         {"", "brokentest.yaml:27: key `gyroscope.rate`: found \"fast\""},
                         empty);
  }
  EXPECT_EQ(program("info " + (empty / "none.yaml").string()).exit_code, 2);
}

}  // namespace
}  // namespace gpo
