// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/calibrate.h"
#include "engine/calibration/calibration_report.h"
#include "tests/engine/calibration/phone_and_board.h"
#include "tests/engine/recording/board/rendered_board.h"

#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

using Eigen::Vector2d, Eigen::Vector3d, testing::HasSubstr;

/// A hand that films the board from all sides; harmonics of random frequencies and phases.
class FilmingHand {
 public:
  explicit FilmingHand(std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int k = 0; k < 6; ++k) {
      frequency_hz_[k] = 0.2 + 0.5 * uniform(random);
      phase_[k] = 2 * std::numbers::pi * uniform(random);
    }
  }
  Pose pose_at(double time_s) const {
    const auto wave = [&](int k) {
      return std::sin(2 * std::numbers::pi * frequency_hz_[k] * time_s + phase_[k]);
    };
    const Eigen::Matrix3d R = so3_exp({0.6 * wave(0), 0.6 * wave(1), 0.5 * wave(2)});
    const Vector3d looked_at(0.1 + 0.05 * wave(3), 0.06 + 0.04 * wave(4), 0);
    return {R, looked_at - (0.42 + 0.08 * wave(5)) * R.col(2)};
  }

 private:
  double frequency_hz_[6], phase_[6];
};

struct Filmed {
  Camera camera = phone();
  double readout_s = 0;
  double noise_px = 0.1;
};

/// 40 views of 12 seconds, each row at its time, with exact velocities.
BoardSearch film(const Filmed& options, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, options.noise_px);
  const FilmingHand hand(random);
  const Camera& camera = options.camera;
  BoardSearch search;
  search.size = {camera.width, camera.height};
  for (int frame = 0; frame < 40; ++frame) {
    CalibrationView view{frame, {}, 1.5};
    for (const Vector3d& corner : board_points(kBoard)) {
      const auto at = [&](double time_s) {
        return project(camera, to_camera(hand.pose_at(time_s), corner));
      };
      const double time_s = 0.3 * frame;
      double later_s = 0;
      for (int pass = 0; pass < 4; ++pass)
        later_s = options.readout_s * row_from_middle(camera, at(time_s + later_s)) /
                  (readout_lines(camera) - 1);
      view.corners.push_back(at(time_s + later_s) + Vector2d(noise(random), noise(random)));
      view.velocities_px_s.push_back((at(time_s + 1e-4) - at(time_s - 1e-4)) / 2e-4);
    }
    ++search.examined;
    search.views.push_back(std::move(view));
  }
  return search;
}

double mean_normalized_square(const CameraCalibration& found, const Camera& truth) {
  const auto values = parameters(found.camera), expected = parameters(truth);
  double sum = 0;
  for (std::size_t k = 0; k < values.size(); ++k)
    sum += std::pow((values[k] - expected[k]) / found.camera.sigmas[k], 2);
  return sum / static_cast<double>(values.size());
}

TEST(BoardReadout, IsEstimatedTogetherWithTheCamera) {
  for (const double readout_s : {0.03, -0.02}) {
    double squares = 0, readout_squares = 0;
    constexpr int kSeeds = 3;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const auto found = calibrate_camera(film({.readout_s = readout_s}, seed), kBoard);
      ASSERT_TRUE(found.ok) << found.reason;
      ASSERT_TRUE(found.camera.readout) << readout_s << " " << seed;
      const Readout& readout = *found.camera.readout;
      EXPECT_NEAR(readout.seconds, readout_s, 6e-4);
      EXPECT_THAT(to_text(found), HasSubstr("ms, first row to last"));
      readout_squares += std::pow((readout.seconds - readout_s) / readout.sigma_s, 2) / kSeeds;
      squares += mean_normalized_square(found, phone()) / kSeeds;
    }
    EXPECT_LT(squares, 2) << readout_s;
    EXPECT_LT(readout_squares, 4) << readout_s;
  }
}

TEST(BoardReadout, WithoutVelocitiesShiftsTheCamera) {
  BoardSearch search = film({.readout_s = 0.03}, 1);
  for (CalibrationView& view : search.views) view.velocities_px_s.clear();
  const auto found = calibrate_camera(search, kBoard);
  EXPECT_FALSE(found.camera.readout);
  EXPECT_TRUE(!found.ok || mean_normalized_square(found, phone()) > 2);
}

TEST(BoardReadout, FollowsItsDirectionAndAGivenOne) {
  Filmed sideways{.readout_s = 0.02};
  sideways.camera.readout_direction = ReadoutDirection::left;
  const BoardSearch search = film(sideways, 1);
  const auto found =
      calibrate_camera(search, kBoard, {.readout_direction = ReadoutDirection::left});
  ASSERT_TRUE(found.ok && found.camera.readout) << found.reason;
  EXPECT_NEAR(found.camera.readout->seconds, 0.02, 6e-4);
  const Readout given{0.02, 1e-3};
  const auto known = calibrate_camera(
      search, kBoard, {.readout = given, .readout_direction = ReadoutDirection::left});
  ASSERT_TRUE(known.ok) << known.reason;
  EXPECT_EQ(known.camera.readout, given);
  EXPECT_EQ(known.camera.readout_direction, ReadoutDirection::left);
  EXPECT_NEAR(known.camera.fx, found.camera.fx, found.camera.sigmas[0]);
}

TEST(BoardReadout, IsLeftOutForAGlobalShutter) {
  for (const std::uint64_t seed : {1, 2}) {
    BoardSearch search = film({}, seed);
    const auto found = calibrate_camera(search, kBoard);
    ASSERT_TRUE(found.ok) << found.reason;
    EXPECT_FALSE(found.camera.readout) << found.camera.readout->seconds;
    for (CalibrationView& view : search.views) view.velocities_px_s.clear();
    EXPECT_EQ(parameters(found.camera), parameters(calibrate_camera(search, kBoard).camera));
  }
}

/// Images of the board by a camera with a tilt for each image.
FrameCache images_of_board(const Camera& camera, int count, double (*tilt_deg)(int frame)) {
  return {count, [=](int frame) {
            cv::Mat bgr;
            const Pose pose = looking_at(kBoard, 0.35, tilt_deg(frame), 5);
            cv::cvtColor(render_board(kBoard, camera, pose), bgr, cv::COLOR_GRAY2BGR);
            return bgr;
          }};
}

TEST(BoardReadout, VelocitiesComeFromNeighboringImages) {
  const Camera camera{320, 240, 300, 300, 160, 120, Distortion::none, {}};
  std::vector<std::int64_t> times_ns;
  for (int i = 0; i < 12; ++i) times_ns.push_back(1'000'000'000LL + 50'000'000LL * i);
  const FrameCache images = images_of_board(camera, 12, [](int frame) { return 2.0 * frame - 10; });
  const auto search = find_calibration_views(images, kBoard, 12, {}, times_ns);
  ASSERT_EQ(search.views.size(), 12U);
  for (int i = 0; i < 12; ++i) {
    const double most_px_s = i == 0 || i == 11 ? 12 : 5;  // from one side
    const auto at = [&](double frame) {
      return project_board(kBoard, camera, looking_at(kBoard, 0.35, 2 * frame - 10, 5));
    };
    const auto before = at(i - 0.1), after = at(i + 0.1);
    const CalibrationView& view = search.views[i];
    ASSERT_EQ(view.velocities_px_s.size(), view.corners.size()) << i;
    for (std::size_t j = 0; j < view.corners.size(); ++j)
      EXPECT_LT((view.velocities_px_s[j] - (after[j] - before[j]) / 0.01).norm(), most_px_s) << i;
  }
  const auto rows = find_calibration_views(images, kBoard, 10, {}, times_ns);
  std::vector<int> frames;
  for (const CalibrationView& view : rows.views) frames.push_back(view.frame);
  EXPECT_THAT(frames, testing::ElementsAre(0, 1, 2, 3, 4, 6, 7, 8, 9, 10));
  const auto photos = find_calibration_views(
      images_of_board(camera, 3, [](int frame) { return frame == 1 ? 20.0 : -10.0; }),
      kBoard,
      3,
      {},
      std::span(times_ns).first(3));
  const auto untimed = find_calibration_views(images, kBoard, 12);
  for (const auto& view : untimed.views) EXPECT_TRUE(view.velocities_px_s.empty());
  EXPECT_EQ(photos.views.size(), 3U);
  for (const auto& view : photos.views) EXPECT_TRUE(view.velocities_px_s.empty());
}

}  // namespace
}  // namespace gpo::test
