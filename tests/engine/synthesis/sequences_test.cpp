// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspector.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/synthesis/synthesize.h"
#include "tests/engine/largest.h"
#include "tests/engine/synthesis/small_recipe.h"
#include "tests/engine/test_folder.h"

#include <algorithm>
#include <atomic>
#include <set>
#include <stdexcept>
#include <thread>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

Recipe sequence(const std::string& name) {
  return read_recipe(fs::path(GPO_SOURCE_DIR) / "sequences" / (name + ".yaml"));
}

/// Largest distance from the reference frame's camera in a window, relative to its height.
double travel(const Recipe& recipe, int start, int frames) {
  const Eigen::Vector3d from = camera_of(recipe, start).p_wc;
  double farthest = 0;
  for (int i = 1; i < frames; ++i)
    farthest = std::max(farthest, (camera_of(recipe, start + i).p_wc - from).norm());
  return farthest / from.z();
}

const std::vector<std::string> kWellConditioned = {
    "sideways", "orbit", "approach", "diagonal", "up-down", "wander", "fast-arc"};

std::vector<std::string> all_nine() {
  std::vector<std::string> names = kWellConditioned;
  names.insert(names.end(), {"low-parallax", "rotation-dominant"});
  return names;
}

void expect_board_in_every_frame(const Recipe& recipe, double margin_px) {
  ASSERT_TRUE(recipe.desk.board);
  for (int frame = 0; frame < recipe.frame_count; ++frame)
    for (const Eigen::Vector3d& corner : board_corners(*recipe.desk.board)) {
      const Eigen::Vector2d px =
          project(recipe.camera, to_camera(camera_of(recipe, frame), corner));
      EXPECT_TRUE((px.array() > margin_px).all() && px.x() < 640 - margin_px &&
                  px.y() < 480 - margin_px)
          << frame;
    }
}

TEST(Sequences, AreRecordingsOfAPhoneOfThreeSecondsWithTheBoardInEveryFrame) {
  for (const std::string& name : all_nine()) {
    SCOPED_TRACE(name);
    const Recipe recipe = sequence(name);
    expect_board_in_every_frame(recipe, 5);
    EXPECT_EQ(recipe.frame_count, 90);
    EXPECT_EQ(recipe.frame_rate, 30);
    EXPECT_EQ(recipe.camera.width, 640);
    EXPECT_EQ(recipe.camera.height, 480);
    EXPECT_EQ(recipe.camera.distortion, Distortion::radial_tangential);
    EXPECT_GT(std::abs(recipe.camera.coefficients[0]), 0.01);
    EXPECT_GT(recipe.image.noise, 0);
    EXPECT_GT(recipe.image.blur, 0);
    const GyroscopeRecipe& gyroscope = recipe.gyroscope;
    EXPECT_EQ(gyroscope.rate, 200);
    EXPECT_GE(gyroscope.noise_density, 0.0002);
    EXPECT_LE(gyroscope.noise_density, 0.0004);
    EXPECT_TRUE((gyroscope.bias.array().abs() > 0.001).all());
    EXPECT_LT(test::largest(gyroscope.bias), 0.01);
    ASSERT_TRUE(gyroscope.calibrated_bias);
    EXPECT_NEAR((*gyroscope.calibrated_bias - gyroscope.bias).norm(), 0.002, 0.0002);
  }
}

TEST(Sequences, DeskHasItsBoardInEveryFrameAndParallaxInEveryWindow) {
  const Recipe recipe = sequence("desk");
  expect_board_in_every_frame(recipe, 25);
  for (int start = 0; start + 30 <= recipe.frame_count; ++start) {
    EXPECT_GT(travel(recipe, start, 30), 0.22) << start;
    EXPECT_LT(travel(recipe, start, 30), 0.42) << start;
  }
}

TEST(Sequences, HaveTheParallaxAndRotationOfTheirNames) {
  for (const int start : {0, 10, 20, 30}) {
    for (const std::string& name : kWellConditioned) {
      const Recipe recipe = sequence(name);
      EXPECT_GT(travel(recipe, start, 10), 0.045) << name << start;
      EXPECT_GT(travel(recipe, start, 30), 0.12) << name << start;
      EXPECT_LT(travel(recipe, start, 60), 0.7) << name << start;
    }
    EXPECT_NEAR(travel(sequence("low-parallax"), start, 30), 0.04, 0.01) << start;
    EXPECT_LT(travel(sequence("low-parallax"), start, 60), 0.06) << start;
  }
  const Recipe recipe = sequence("rotation-dominant");
  const Pose first = camera_of(recipe, 0);
  double largest = 0;
  for (int i = 0; i < recipe.frame_count; ++i) {
    EXPECT_LT((camera_of(recipe, i).p_wc - first.p_wc).norm(), 0.0015) << i;
    const Eigen::Matrix3d rotation = first.R_wc.transpose() * camera_of(recipe, i).R_wc;
    largest = std::max(largest, Eigen::AngleAxisd(rotation).angle());
  }
  EXPECT_GT(largest, radians(10));
  EXPECT_LT(largest, radians(20));
}

TEST(Sequences, DifferInSeedsDesksAndDisturbances) {
  int rolling = 0, blurred = 0, cluttered = 0;
  std::set<std::uint64_t> seeds, textures;
  for (const std::string& name : all_nine()) {
    const Recipe recipe = sequence(name);
    rolling += recipe.image.rolling_shutter > 0 ? 1 : 0;
    blurred += recipe.image.exposure > 0.01 ? 1 : 0;
    cluttered += recipe.desk.boxes.empty() ? 0 : 1;
    seeds.insert(recipe.seed);
    textures.insert(recipe.desk.texture_seed);
  }
  EXPECT_EQ(rolling, 1);
  EXPECT_EQ(blurred, 1);
  EXPECT_EQ(cluttered, 7);
  EXPECT_EQ(seeds.size(), 9U);
  EXPECT_EQ(textures.size(), 9U);
}

/// Inspects the first frames of a companion, at most 20, rendered with one ray a pixel.
std::shared_ptr<const Inspection> inspect_start_of(const std::string& name,
                                                   const MethodOptions& options = {},
                                                   int frames = 20) {
  Recipe recipe = sequence("companions/" + name);
  recipe.frame_count = 20;
  recipe.image.samples = 1;
  const fs::path folder = test_folder("out") / name;
  synthesize(recipe, folder);
  Settings settings;
  settings.frames = frames;
  settings.options.method_options = options;
  return Inspector(open_recording(folder.string())).inspect(settings);
}

TEST(Companions, FloorAndWallsOfTheCornerAreFoundWithAnUncalibratedGyroscope) {
  const auto inspection = inspect_start_of("corner");
  const Recipe recipe = sequence("companions/corner");
  const Initialization& result = *inspection->initialization;
  ASSERT_TRUE(result.ok) << result.reason;
  ASSERT_GE(result.planes.size(), 3U);
  const Pose camera = camera_motion(recipe.trajectory, 0).pose;
  EXPECT_LT(angle_deg(camera.R_wc * result.plane.normal, {0, 0, 1}), 1);
  for (const Eigen::Vector3d& facing : {Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(-1, 0, 0)}) {
    const auto faces = [&](const PlaneEstimate& estimate) {
      return angle_deg(camera.R_wc * estimate.plane.normal, facing) < 3;
    };
    EXPECT_TRUE(std::ranges::any_of(result.planes, faces)) << facing.transpose();
  }
  ASSERT_TRUE(result.bias_rad_s);
  EXPECT_LT((*result.bias_rad_s - recipe.gyroscope.bias).norm(), 0.004);
  EXPECT_NEAR(recipe.gyroscope.bias.norm(), 0.08, 0.005);  // EuRoC's
  EXPECT_FALSE(recipe.gyroscope.calibrated_bias);
}

TEST(Companions, JointModelSolvesTheCornerAlsoWhereAStepOnItsLossDiverges) {
  MethodOptions latent;
  latent.error = ErrorModel::latent;
  const auto inspection = inspect_start_of("corner", latent, 18);
  ASSERT_TRUE(inspection->initialization->ok) << inspection->initialization->reason;
  EXPECT_LT(*inspection->evaluation->pne_deg, 0.2);
}

TEST(Companions, RubbleIsRefusedForLackOfAPlane) {
  const auto inspection = inspect_start_of("rubble");
  EXPECT_FALSE(inspection->initialization->ok);
  ASSERT_TRUE(inspection->initialization->verdict);
  EXPECT_EQ(inspection->initialization->verdict->readiness, Readiness::no_plane);
}

TEST(Companions, CameraOfTheCornerMovesAsADrone) {
  const Trajectory trajectory = sequence("companions/corner").trajectory;
  for (const double start : {0.0, 0.6, 1.2, 1.8}) {
    const Eigen::Vector3d from = camera_motion(trajectory, start).pose.p_wc;
    const Eigen::Vector3d to = camera_motion(trajectory, start + 20 / 30.0).pose.p_wc;
    EXPECT_GT((to - from).norm() / from.z(), 0.1) << start;
    EXPECT_LT((to - from).norm() / from.z(), 0.25) << start;
  }
}

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
    for (int i = 0; i < 3; ++i)
      threads.emplace_back([&] {
        int last = 0;
        synthesized_recordings(std::vector{recipe}, cache, 1, [&](int done, int) {
          if (done - last == 1) ++frames;
          last = done;
        });
      });
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

TEST_F(Synthesized, RefusesBrokenAndMissingRecipesAndACacheThatCannotBeMade) {
  auto recipe_files = three_recipes();
  recipe_files.push_back(write_recipe("broken.yaml", small_recipe_with("count: 4", "count: many")));
  EXPECT_THAT(test::error_of([&] { make(recipe_files); }),
              testing::HasSubstr("broken.yaml:8: key `frames.count`"));
  EXPECT_FALSE(fs::exists(cache));
  EXPECT_NE(test::error_of([&] { make({recipes / "none.yaml"}); }), "no error");
  std::ofstream(recipes / "file") << "not a folder";
  const std::vector recipe{write_recipe("small.yaml")};
  EXPECT_THAT(test::error_of([&] { synthesized_recordings(recipe, recipes / "file", 1); }),
              testing::EndsWith("expected a folder to write into"));
}

}  // namespace
}  // namespace gpo
