// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/synthesis/synthesize.h"
#include "tests/engine/synthesis/small_recipe.h"

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
  /// How many frames were made, as far as the progress tells.
  int make(const std::vector<fs::path>& which, int threads = 2) {
    int last = 0;
    const auto progress = [&](int done, int) { last = done; };
    folders = synthesized_recordings(which, cache, threads, progress);
    return last;
  }
  std::vector<fs::path> folders;  ///< what `make` gave
};

TEST_F(Synthesized, IsCalledAfterItsRecipeAndIsWhatSynthesizeMakes) {
  const fs::path recipe = write_recipe("small.yaml");
  EXPECT_EQ(make({recipe}), 4);
  ASSERT_EQ(folders.size(), 1U);
  EXPECT_EQ(folders[0].filename(), "small");
  EXPECT_EQ(folders[0], synthesized_folder(recipe, cache));
  synthesize(read_recipe(recipe), cache / "same");
  EXPECT_EQ(folder_contents(folders[0]), folder_contents(cache / "same"));
}

TEST_F(Synthesized, IsMadeOnce) {
  const fs::path recipe = write_recipe("small.yaml");
  EXPECT_EQ(make({recipe}), 4);
  const auto first = fs::last_write_time(folders[0] / "mav0/cam0/data.csv");
  EXPECT_EQ(make({recipe}), 0);
  EXPECT_EQ(fs::last_write_time(folders[0] / "mav0/cam0/data.csv"), first);
}

TEST_F(Synthesized, RecipeThatIsGivenTwiceIsMadeOnce) {
  const fs::path recipe = write_recipe("small.yaml");
  EXPECT_EQ(make({recipe, recipe}), 4);
  EXPECT_EQ(folders, std::vector(2, synthesized_folder(recipe, cache)));
}

TEST_F(Synthesized, ChangedRecipeIsMadeAnew) {
  EXPECT_EQ(make({write_recipe("small.yaml")}), 4);
  const fs::path before = folders[0];
  EXPECT_EQ(make({write_recipe("small.yaml", small_recipe_with("count: 4", "count: 2"))}), 2);
  EXPECT_NE(folders[0], before);
  EXPECT_EQ(folders[0].filename(), "small");
  EXPECT_TRUE(fs::exists(before));
}

TEST_F(Synthesized, SeveralAtATimeAreWhatTheyAreOneByOne) {
  const auto recipe_files = three_recipes();
  EXPECT_EQ(make(recipe_files, 3), 11);
  for (std::size_t i = 0; i < recipe_files.size(); ++i) {
    const fs::path alone = cache / ("alone" + std::to_string(i));
    synthesize(read_recipe(recipe_files[i]), alone, {}, 1);
    EXPECT_EQ(folder_contents(folders[i]), folder_contents(alone));
  }
}

TEST_F(Synthesized, ProgressCountsTheFramesOfAllThatAreMade) {
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

TEST_F(Synthesized, ThreadsThatWantTheSameShareIt) {
  const fs::path recipe = write_recipe("small.yaml");
  std::atomic<int> frames = 0;
  {
    std::vector<std::jthread> threads;
    threads.reserve(3);
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
  EXPECT_EQ(frames, 4);  // made frame by frame by one of them, found whole by the others
  EXPECT_EQ(folder_contents(cache).size(), 11U);
}

TEST_F(Synthesized, TakesOverFromAProcessThatWasKilled) {
  const fs::path recipe = write_recipe("small.yaml");
  const fs::path folder = synthesized_folder(recipe, cache);
  fs::create_directories(folder.string() + ".unfinished/mav0");
  EXPECT_EQ(make({recipe}), 4);
  EXPECT_EQ(folder_contents(cache).size(), 11U);
}

TEST_F(Synthesized, LeavesNothingBehindWhereItIsStopped) {
  const auto stop = [](int done, int) {
    if (done == 2) throw std::runtime_error("stopped");
  };
  try {
    synthesized_recordings(three_recipes(), cache, 2, stop);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "stopped");
  }
  EXPECT_TRUE(fs::is_empty(cache));
}

TEST_F(Synthesized, BrokenRecipeIsRefusedBeforeAnythingIsMade) {
  auto recipe_files = three_recipes();
  recipe_files.push_back(write_recipe("broken.yaml", small_recipe_with("count: 4", "count: many")));
  try {
    make(recipe_files);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("broken.yaml:8: key `frames.count`"));
  }
  EXPECT_FALSE(fs::exists(cache));
}

TEST_F(Synthesized, NamesAMissingRecipeAndACacheThatCannotBeMade) {
  EXPECT_THROW(make({recipes / "none.yaml"}), InputError);
  std::ofstream(recipes / "file") << "not a folder";
  try {
    synthesized_recordings(std::vector{write_recipe("small.yaml")}, recipes / "file", 1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::EndsWith("expected a folder to write into"));
  }
}

}  // namespace
}  // namespace gpo
