// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/truth/truth.h"
#include "tests/engine/recording/board/rendered_board.h"
#include "tests/engine/rotation_error.h"
#include "tests/engine/test_folder.h"

#include <atomic>
#include <cstdlib>
#include <random>
#include <thread>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

cv::Mat rendered(const Board& board, const Camera& camera, const Pose& pose) {
  cv::Mat image = render_board(board, camera, pose);
  cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  return image;
}

/// The camera rolls by 20 deg per frame; frame 2 does not show the board.
Recording rolling_recording(const Board& board, int frames) {
  Recording recording;
  recording.camera = small_pinhole();
  recording.board = board;
  const auto decode = [board](int index) {
    if (index == 2) return cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(90));
    return rendered(board, small_pinhole(), looking_at(board, 0.4, 15, 20.0 * index));
  };
  recording.images = std::make_shared<const FrameCache>(frames, decode);
  for (int i = 0; i < frames; ++i) recording.timestamps_ns.push_back(i);
  return recording;
}

TEST(BoardTruth, ReturnsThePosesOfTheRequestedFrames) {
  const Recording recording = rolling_recording(kTwin, 6);
  std::vector<int> seen;
  const auto truth =
      board_truth(recording, 1, 4, {}, [&](int done, int of) { seen.push_back(10 * done + of); });
  EXPECT_EQ(truth.source, "chessboard");
  ASSERT_EQ(truth.poses.size(), 4U);
  EXPECT_FALSE(truth.poses[1]);
  EXPECT_FALSE(truth.uncertainties[1]);
  for (const int i : {0, 2, 3}) {
    ASSERT_TRUE(truth.poses[i]) << i;
    const Pose expected = looking_at(kTwin, 0.4, 15, 20.0 * (i + 1));
    EXPECT_LT(rotation_error_deg(*truth.poses[i], expected), 0.2) << i;
    EXPECT_LT((truth.poses[i]->p_wc - expected.p_wc).norm(), 2e-3) << i;
    EXPECT_LT(truth.uncertainties[i]->position_sigma_m, 1e-3) << i;
  }
  EXPECT_THAT(seen, ElementsAre(15, 25, 35, 45, 55));  // one more for the median of the RMS
}

TEST(BoardTruth, KeepsTheBoardsEndsWhileTheCameraRollsOver) {
  // Only continuity distinguishes the ends of these boards.
  for (const Board& board : {kTwin, Board{5, 5, 0.03}, Board{6, 6, 0.025}}) {
    const auto truth = board_truth(rolling_recording(board, 19), 0, 19);
    for (int i = 0; i < 19; ++i) {
      if (i == 2) continue;
      ASSERT_TRUE(truth.poses[i]) << i;
      const Eigen::Matrix3d turn = truth.poses[0]->R_wc.transpose() * truth.poses[i]->R_wc;
      const Eigen::Matrix3d expected = looking_at(board, 0.4, 15, 0).R_wc.transpose() *
                                       looking_at(board, 0.4, 15, 20.0 * i).R_wc;
      EXPECT_LT(rotation_error_deg(turn, expected), 0.4) << board.columns << " " << i;
    }
  }
}

TEST(BoardTruth, StopsAfterTheFramesInWork) {
  const Recording recording = rolling_recording(kTwin, 40);
  std::stop_source stop;
  int frames = 0;
  const auto truth = board_truth(recording, 0, 40, stop.get_token(), [&](int, int) {
    if (++frames == 2) stop.request_stop();
  });
  EXPECT_LE(frames, 2 + static_cast<int>(std::thread::hardware_concurrency()));
  ASSERT_EQ(truth.poses.size(), 40U);
  EXPECT_TRUE(truth.poses[0] || truth.poses[1]);
  EXPECT_FALSE(truth.poses[39]);
}

TEST(BoardTruth, PassesOnDecodingErrors) {
  Recording recording = rolling_recording(kTwin, 6);
  recording.images = std::make_shared<const FrameCache>(6, [](int index) -> cv::Mat {
    if (index == 3) throw InputError("video.mp4: frame 3 cannot be decoded");
    return cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(90));
  });
  EXPECT_EQ(error_of([&] { board_truth(recording, 0, 6); }),
            "video.mp4: frame 3 cannot be decoded");
}

TEST(BoardTruth, RejectsFramesThatFitMuchWorseThanTheOthers) {
  Recording recording = rolling_recording(kTwin, 8);
  recording.images = std::make_shared<const FrameCache>(8, [](int index) {
    // Simulates a rolling shutter: the lower rows of frame 5 are 4 px to the right.
    cv::Mat image = rendered(kTwin, small_pinhole(), looking_at(kTwin, 0.4, 15, 0));
    if (index == 5) {
      const cv::Mat below = image.rowRange(120, 240);
      const cv::Matx23d shift(1, 0, 4, 0, 1, 0);
      cv::Mat shifted;
      cv::warpAffine(below, shifted, shift, below.size(), cv::INTER_NEAREST, cv::BORDER_REPLICATE);
      shifted.copyTo(below);
    }
    return image;
  });
  const auto truth = board_truth(recording, 0, 8);
  EXPECT_FALSE(truth.poses[5]);
  EXPECT_EQ(std::ranges::count(truth.poses, true, [](auto& pose) { return pose.has_value(); }), 7);
  // Without other frames only the limit of 2 px applies.
  const auto alone = board_truth(recording, std::vector<int>{5});
  EXPECT_TRUE(!alone.poses[0] || alone.uncertainties[0]->rms_px > 0.5);
}

TEST(MedianUncertainty, CoversOnlyFramesWithAPose) {
  const std::vector<std::optional<PoseUncertainty>> some = {PoseUncertainty{1, 2, 3, 4},
                                                            std::nullopt,
                                                            PoseUncertainty{9, 1, 7, 5},
                                                            PoseUncertainty{3, 9, 1, 6}};
  EXPECT_THAT(median_uncertainty(some), testing::Optional(testing::FieldsAre(3, 2, 3, 5)));
  EXPECT_FALSE(median_uncertainty({}));
}

class BoardCache : public testing::Test {
 protected:
  BoardCache() {
    folder_.write("1.png", "not decoded");
    folder_.write("2.png", "not decoded either");
  }

  /// Returns a recording that counts decoded images.
  Recording recording(int frames = 8) {
    Recording recording;
    recording.camera = {160, 120, 150, 151, 79.5, 60, Distortion::none, {}};
    recording.board = kTwin;
    recording.cache_folder = folder_.path() / "cache";
    recording.image_files = {folder_.path() / "1.png", folder_.path() / "2.png"};
    for (int i = 0; i < frames; ++i) recording.timestamps_ns.push_back(i);
    static const cv::Mat kImage = rendered(kTwin, recording.camera, looking_at(kTwin, 0.42, 15, 8));
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

  TestFolder folder_;
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

TEST_F(BoardCache, DependsOnImagesAndBoardButNotOnTheCamera) {
  const Recording one = recording();
  const auto file = board_cache_file(one);
  EXPECT_EQ(board_cache_file(one), file);
  Recording other = one;
  other.camera.coefficients = {0.1, 0, 0, 0};
  EXPECT_EQ(board_cache_file(other), file);
  other = one;
  other.board->square_m = 0.026;
  EXPECT_NE(board_cache_file(other), file);
  other.board = kTwin;
  other.board->markers = BoardMarkers{0.02, "DICT_4X4_50"};
  EXPECT_NE(board_cache_file(other), file);
  other = one;
  other.timestamps_ns.back() += 1;
  EXPECT_NE(board_cache_file(other), file);
  folder_.write("2.png", "another picture");
  EXPECT_NE(board_cache_file(one), file);
  other.image_files.clear();
  EXPECT_FALSE(board_cache_file(other));
  fs::remove(folder_.path() / "2.png");
  EXPECT_FALSE(board_cache_file(one));
}

TEST_F(BoardCache, IsRebuiltIfTruncatedDamagedOrForeign) {
  const std::string file = fs::relative(*board_cache_file(recording()), folder_.path()).string();
  EXPECT_EQ(decoded_for(0, 4), 8);
  const std::string whole = folder_.read(file);
  folder_.write(file, whole);
  EXPECT_EQ(decoded_for(0, 4), 0);
  std::string damaged = whole, renamed = whole;
  damaged[whole.size() / 2] ^= 1;
  renamed[20] = renamed[20] == '0' ? '1' : '0';
  for (const std::string& bad :
       {whole.substr(0, whole.size() / 2), std::string(), std::string("else"), damaged, renamed}) {
    folder_.write(file, bad);
    EXPECT_EQ(decoded_for(0, 4), 8) << bad.size();
  }
  EXPECT_EQ(decoded_for(0, 4), 0);  // the last one was renewed
}

TEST_F(BoardCache, IgnoresAFolderThatCannotBeWritten) {
  folder_.write("cache", "a file where the folder should be");
  for (int run = 0; run < 2; ++run) EXPECT_EQ(decoded_for(0, 4), 8);
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

/// Corners that a moving camera sees with a rolling shutter.
BoardCorners rolling_corners(const Recording& recording, const auto& pose_at) {
  BoardCorners all;
  const Camera& camera = recording.camera;
  for (int frame = 0; frame < recording.frame_count(); ++frame) {
    const double time_s = 1e-9 * static_cast<double>(recording.timestamps_ns[frame]);
    for (const Eigen::Vector3d& point : board_points(*recording.board)) {
      Eigen::Vector2d px = project(camera, to_camera(pose_at(time_s), point));
      for (int pass = 0; pass < 4; ++pass) {
        const double later_s =
            camera.readout->seconds * row_from_middle(camera, px) / (readout_lines(camera) - 1);
        px = project(camera, to_camera(pose_at(time_s + later_s), point));
      }
      all[frame].push_back(px);
    }
  }
  return all;
}

/// Turns and rises in front of the board.
Pose brisk_path(double time_s) {
  return looking_at(kTwin, 0.42, 15 + 60 * time_s, 8 + 40 * std::sin(3 * time_s));
}

TEST_F(BoardCache, PosesAreThoseAtTheTimeStampsOfARollingShutter) {
  Recording rolling = recording(12);
  for (int i = 0; i < 12; ++i) rolling.timestamps_ns[i] = 33'000'000LL * i;
  for (const auto direction : {ReadoutDirection::down, ReadoutDirection::left}) {
    rolling.camera.readout = Readout{0.025, 1e-4};
    rolling.camera.readout_direction = direction;
    rolling.timestamps_ns.back() += static_cast<int>(direction);  // a cache file of its own
    save_board_corners(*board_cache_file(rolling), rolling_corners(rolling, brisk_path));
    const auto truth = board_truth(rolling, std::vector{0, 5, 11});
    rolling.camera.readout.reset();
    const auto uncorrected = board_truth(rolling, std::vector{0, 5, 11});
    for (int k = 0; k < 3; ++k) {
      const int frame = std::array{0, 5, 11}[k];
      const Pose expected = brisk_path(1e-9 * static_cast<double>(rolling.timestamps_ns[frame]));
      ASSERT_TRUE(truth.poses[k] && uncorrected.poses[k]) << frame;
      EXPECT_LT(rotation_error_deg(*truth.poses[k], expected), 0.05) << frame;
      EXPECT_LT((truth.poses[k]->p_wc - expected.p_wc).norm(), 5e-4) << frame;
      EXPECT_GT(rotation_error_deg(*uncorrected.poses[k], expected), 0.07) << frame;
    }
  }
}

struct KnownAndUnknown {
  GroundTruth known, unknown;
};

/// Returns the truth from noisy corners of a camera with known and with unknown readout time.
KnownAndUnknown truth_of_noisy(Recording recording, double readout_s, unsigned seed) {
  for (int i = 0; i < recording.frame_count(); ++i) recording.timestamps_ns[i] = 33'000'000LL * i;
  recording.timestamps_ns.back() += seed;  // a cache file of its own
  recording.camera.readout = Readout{readout_s, 1e-4};
  recording.camera.sigmas.assign(4 + recording.camera.coefficients.size(), 0);
  BoardCorners corners = rolling_corners(recording, brisk_path);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise_px(0, 0.1);
  for (auto& [frame, in_frame] : corners)
    for (Eigen::Vector2d& px : in_frame) px += Eigen::Vector2d(noise_px(random), noise_px(random));
  save_board_corners(*board_cache_file(recording), corners);
  GroundTruth known = board_truth(recording, 0, recording.frame_count());
  recording.camera.readout.reset();
  return {std::move(known), board_truth(recording, 0, recording.frame_count())};
}

TEST_F(BoardCache, AnUnknownReadoutTimeIsEstimated) {
  double squares = 0;
  constexpr int kSeeds = 20;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const double readout_s = seed % 2 == 0 ? 0.035 : -0.03;
    const auto [known, unknown] = truth_of_noisy(recording(30), readout_s, seed);
    ASSERT_TRUE(unknown.estimated_readout && !known.estimated_readout) << seed;
    const auto [seconds, sigma_s] = *unknown.estimated_readout;
    squares += std::pow((seconds - readout_s) / sigma_s, 2) / kSeeds;
    for (const int frame : {0, 6}) {
      ASSERT_TRUE(known.poses[frame] && unknown.poses[frame]);
      EXPECT_LT(rotation_error_deg(*unknown.poses[frame], *known.poses[frame]), 0.06) << seed;
    }
  }
  EXPECT_LT(squares, 1.5);
}

TEST_F(BoardCache, AGlobalShutterHasNoReadoutTime) {
  for (int seed = 0; seed < 20; ++seed)
    EXPECT_FALSE(truth_of_noisy(recording(30), 0, seed).unknown.estimated_readout) << seed;
}

TEST_F(BoardCache, FramesWithoutVelocitiesHaveNoPoseWithARollingShutter) {
  Recording rolling = recording(1);
  rolling.camera.readout = Readout{0.025, 1e-4};
  EXPECT_FALSE(board_truth(rolling, 0, 1).poses[0]);
  rolling.camera.readout = Readout{0, 1e-4};
  EXPECT_TRUE(board_truth(rolling, 0, 1).poses[0]);
}

// A writer may lose frames of the other, which are then processed again.
TEST_F(BoardCache, StaysValidWithTwoWriters) {
  const auto file = *board_cache_file(recording());
  save_board_corners(file, {{0, {}}});
  const auto write = [&](int first) {
    for (int i = 0; i < 50; ++i) {
      save_board_corners(file, {{first + i, {}}});
      EXPECT_TRUE(load_board_corners(file).contains(0));
    }
  };
  {
    const std::jthread one([&] { write(1); });
    const std::jthread two([&] { write(51); });
  }
  const BoardCorners corners = load_board_corners(file);
  EXPECT_TRUE(corners.contains(50) || corners.contains(100));  // the last writer's
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
}  // namespace gpo::test
