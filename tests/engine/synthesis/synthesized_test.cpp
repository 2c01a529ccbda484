// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/synthesize.h"
#include "tests/engine/synthesis/small_recipe.h"
#include "tests/engine/test_folder.h"

#include <algorithm>
#include <atomic>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

class Synthesized : public testing::Test {
 protected:
  const fs::path recipes = test_folder("recipes");
  const fs::path cache = test_folder("out") / "cache";

  fs::path write_recipe(const std::string& name, const std::string& text = small_recipe_text()) {
    std::ofstream(recipes / name) << text;
    return recipes / name;
  }
  std::vector<fs::path> three_recipes() {
    return {write_recipe("a.yaml", small_recipe_with("seed: 3", "seed: 1")),
            write_recipe("b.yaml", small_recipe_with("count: 4", "count: 3")),
            write_recipe("c.yaml", small_recipe_with("exposure: 0.004", "rolling_shutter: 0.02"))};
  }
  /// Returns the number of frames made, by the progress.
  int make(const std::vector<fs::path>& which, int threads = 2) {
    int last = 0;
    const auto progress = [&](int done, int) { last = done; };
    folders = synthesized_recordings(which, cache, threads, progress);
    return last;
  }
  std::vector<fs::path> folders;  ///< result of `make`
};

TEST_F(Synthesized, IsMadeOnceAndNamedAfterItsRecipe) {
  const fs::path recipe = write_recipe("small.yaml");
  EXPECT_EQ(make({recipe, recipe}), 4);
  EXPECT_EQ(folders, std::vector(2, synthesized_folder(recipe, cache)));
  EXPECT_EQ(folders[0].filename(), "small");
  const auto first = fs::last_write_time(folders[0] / "mav0/cam0/data.csv");
  EXPECT_EQ(make({recipe}), 0);
  EXPECT_EQ(fs::last_write_time(folders[0] / "mav0/cam0/data.csv"), first);
  synthesize(read_recipe(recipe), cache / "same");
  EXPECT_EQ(folder_contents(folders[0]), folder_contents(cache / "same"));
}

TEST_F(Synthesized, EditedRecipeIsMadeAgain) {
  EXPECT_EQ(make({write_recipe("small.yaml")}), 4);
  const fs::path before = folders[0];
  EXPECT_EQ(make({write_recipe("small.yaml", small_recipe_with("count: 4", "count: 2"))}), 2);
  EXPECT_NE(folders[0], before);
  EXPECT_EQ(folders[0].filename(), "small");
  EXPECT_TRUE(fs::exists(before));
}

TEST_F(Synthesized, SeveralAtATimeAgreeWithOneByOne) {
  const auto recipe_files = three_recipes();
  EXPECT_EQ(make(recipe_files, 3), 11);
  for (std::size_t i = 0; i < recipe_files.size(); ++i) {
    const fs::path alone = cache / ("alone" + std::to_string(i));
    synthesize(read_recipe(recipe_files[i]), alone, {}, 1);
    EXPECT_EQ(folder_contents(folders[i]), folder_contents(alone));
  }
}

TEST_F(Synthesized, ProgressCountsAllMissingFrames) {
  const auto recipe_files = three_recipes();
  make({recipe_files[0]});
  std::vector<int> counts;
  synthesized_recordings(recipe_files, cache, 2, [&](int done, int of) {
    EXPECT_EQ(of, 7);
    counts.push_back(done);
  });
  EXPECT_TRUE(std::ranges::is_sorted(counts));
  EXPECT_EQ(counts.back(), 7);
}

TEST_F(Synthesized, ThreadsShareTheSameRecording) {
  const fs::path recipe = write_recipe("small.yaml");
  std::atomic<int> frames = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 3; ++i) {
      threads.emplace_back([&] {
        int last = 0;
        synthesized_recordings(std::vector{recipe}, cache, 1, [&](int done, int) {
          if (done - last == 1) ++frames;
          last = done;
        });
      });
    }
  }
  EXPECT_EQ(frames, 4);  // one thread makes it, the others find it complete
  EXPECT_EQ(folder_contents(cache).size(), 11U);
}

TEST_F(Synthesized, CompletesTheRecordingOfAKilledProcess) {
  const fs::path recipe = write_recipe("small.yaml");
  const fs::path folder = synthesized_folder(recipe, cache);
  fs::create_directories(folder.string() + ".unfinished/mav0");
  EXPECT_EQ(make({recipe}), 4);
  EXPECT_EQ(folder_contents(cache).size(), 11U);
}

TEST_F(Synthesized, LeavesNoFilesIfItIsStopped) {
  const auto stop = [](int done, int) {
    if (done == 2) throw std::runtime_error("stopped");
  };
  EXPECT_THAT([&] { synthesized_recordings(three_recipes(), cache, 2, stop); },
              testing::ThrowsMessage<std::runtime_error>("stopped"));
  EXPECT_TRUE(fs::is_empty(cache));
}

TEST_F(Synthesized, RefusesABrokenRecipeBeforeMakingOthers) {
  auto recipe_files = three_recipes();
  recipe_files.push_back(write_recipe("broken.yaml", small_recipe_with("count: 4", "count: many")));
  EXPECT_THAT(test::error_of([&] { make(recipe_files); }),
              testing::HasSubstr("broken.yaml:8: key `frames.count`"));
  EXPECT_FALSE(fs::exists(cache));
}

TEST_F(Synthesized, RefusesAMissingRecipeAndACacheThatCannotBeMade) {
  EXPECT_NE(test::error_of([&] { make({recipes / "none.yaml"}); }), "no error");
  std::ofstream(recipes / "file") << "not a folder";
  const std::vector recipe{write_recipe("small.yaml")};
  EXPECT_THAT(test::error_of([&] { synthesized_recordings(recipe, recipes / "file", 1); }),
              testing::EndsWith("expected a folder to write into"));
}

}  // namespace
}  // namespace gpo
