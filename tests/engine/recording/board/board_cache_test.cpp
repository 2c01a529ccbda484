// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/recording/board/board.h"
#include "engine/truth/truth.h"
#include "tests/engine/recording/board/rendered_board.h"
#include "tests/engine/test_folder.h"

#include <atomic>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using test::kTwin;

class BoardCache : public testing::Test {
 protected:
  BoardCache() {
    folder_.write("1.png", "not decoded");
    folder_.write("2.png", "not decoded either");
  }

  /// A recording that counts decoded images.
  Recording recording(int frames = 8) {
    Recording recording;
    recording.camera = {160, 120, 150, 151, 79.5, 60, Distortion::none, {}};
    recording.board = kTwin;
    recording.cache_folder = folder_.path() / "cache";
    recording.image_files = {folder_.path() / "1.png", folder_.path() / "2.png"};
    for (int i = 0; i < frames; ++i) recording.timestamps_ns.push_back(i);
    static const cv::Mat kImage = [camera = recording.camera] {
      const Pose pose = test::looking_at(kTwin, 0.42, 15, 8);
      cv::Mat image = test::render_board(kTwin, camera, pose);
      cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
      return image;
    }();
    const auto decode = [this](int) {
      ++decoded_;
      return kImage;
    };
    recording.images = std::make_shared<const FrameCache>(frames, decode);
    return recording;
  }

  int decoded_for(int start, int frames, int of = 8) {
    decoded_ = 0;
    board_truth(recording(of), start, frames);
    return decoded_;
  }

  test::TestFolder folder_;
  std::atomic<int> decoded_ = 0;
};

TEST_F(BoardCache, ProcessesEachFrameOnce) {
  EXPECT_EQ(decoded_for(0, 32, 40), 32);
  EXPECT_EQ(decoded_for(0, 32, 40), 0);
  EXPECT_EQ(decoded_for(5, 31, 40), 4);  // frames 32 to 35
  EXPECT_TRUE(fs::is_directory(folder_.path() / "cache/boards"));
}

TEST_F(BoardCache, ReturnsTheSameResultsAgain) {
  const GroundTruth first = board_truth(recording(), 0, 8);
  const GroundTruth again = board_truth(recording(), 0, 8);
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(first.poses[i]);
    EXPECT_EQ(first.poses[i]->R_wc, again.poses[i]->R_wc);
    EXPECT_EQ(first.poses[i]->p_wc, again.poses[i]->p_wc);
    EXPECT_EQ(first.uncertainties[i]->rms_px, again.uncertainties[i]->rms_px);
    EXPECT_EQ(first.uncertainties[i]->normal_sigma_deg, again.uncertainties[i]->normal_sigma_deg);
  }
}

TEST_F(BoardCache, DependsOnImagesCameraAndBoard) {
  const Recording one = recording();
  const auto file = board_cache_file(one);
  EXPECT_EQ(board_cache_file(one), file);
  Recording other = one;
  other.camera.coefficients = {0.1, 0, 0, 0};
  EXPECT_NE(board_cache_file(other), file);
  other = one;
  other.board->square_m = 0.026;
  EXPECT_NE(board_cache_file(other), file);
  other.board = kTwin;
  other.board->markers = BoardMarkers{0.02, "DICT_4X4_50"};
  EXPECT_NE(board_cache_file(other), file);
  folder_.write("2.png", "another picture");
  EXPECT_NE(board_cache_file(one), file);
  other.image_files.clear();
  EXPECT_FALSE(board_cache_file(other));
  fs::remove(folder_.path() / "2.png");
  EXPECT_FALSE(board_cache_file(one));
}

TEST_F(BoardCache, IsRebuiltIfTruncatedDamagedOrForeign) {
  const auto file = *board_cache_file(recording());
  EXPECT_EQ(decoded_for(0, 4), 8);
  const std::string whole = folder_.read(fs::relative(file, folder_.path()).string());
  const auto put = [&](const std::string& content) {
    folder_.write(fs::relative(file, folder_.path()).string(), content);
    return decoded_for(0, 4);
  };
  EXPECT_EQ(put(whole), 0);
  EXPECT_EQ(put(whole.substr(0, whole.size() / 2)), 8);
  EXPECT_EQ(put(""), 8);
  EXPECT_EQ(put("something else"), 8);
  std::string damaged = whole;
  damaged[whole.size() / 2] ^= 1;
  EXPECT_EQ(put(damaged), 8);
  std::string renamed = whole;
  renamed[20] = renamed[20] == '0' ? '1' : '0';
  EXPECT_EQ(put(renamed), 8);
  EXPECT_EQ(decoded_for(0, 4), 0);  // the last one was renewed
}

TEST_F(BoardCache, IgnoresAFolderThatCannotBeWritten) {
  folder_.write("cache", "a file where the folder should be");
  EXPECT_EQ(decoded_for(0, 4), 8);
  EXPECT_EQ(decoded_for(0, 4), 8);
}

TEST_F(BoardCache, KeepsResultsFromBeforeAStop) {
  constexpr int kFrames = 40;
  const Recording stopped = recording(kFrames);
  std::stop_source stop;
  int seen = 0;
  board_truth(stopped, 0, kFrames, stop.get_token(), [&](int, int) {
    if (++seen == 5) stop.request_stop();
  });
  EXPECT_GE(seen, 5);
  EXPECT_LT(seen, kFrames);
  EXPECT_EQ(decoded_for(0, kFrames, kFrames), kFrames - seen);
}

// A writer may lose frames of the other, which are then processed again.
TEST_F(BoardCache, StaysValidWithTwoWriters) {
  const auto file = *board_cache_file(recording());
  save_board_views(file, {{0, std::nullopt}});
  const auto write = [&](int first) {
    for (int i = 0; i < 50; ++i) {
      save_board_views(file, {{first + i, std::nullopt}});
      EXPECT_TRUE(load_board_views(file).contains(0));
    }
  };
  {
    const std::jthread one([&] { write(1); });
    const std::jthread two([&] { write(51); });
  }
  const BoardViews views = load_board_views(file);
  EXPECT_TRUE(views.contains(50) || views.contains(100));  // the last writer's
}

TEST_F(BoardCache, WritesNothingUnlessRequested) {
  setenv("XDG_CACHE_HOME", (folder_.path() / "home").c_str(), 1);
  setenv("HOME", (folder_.path() / "home").c_str(), 1);
  Recording unrequested = recording();
  unrequested.cache_folder.clear();
  EXPECT_FALSE(board_cache_file(unrequested));
  board_truth(unrequested, 0, 4);
  EXPECT_FALSE(fs::exists(folder_.path() / "home"));
}

}  // namespace
}  // namespace gpo
