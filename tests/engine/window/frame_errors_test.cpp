// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/decompositions.h"
#include "engine/geometry/homography.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/rolling_shutter.h"
#include "engine/planes/inliers.h"
#include "tests/engine/simulated_window.h"

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

Tracks made_tracks(const Window& window) {
  Tracks tracks;
  tracks.raw_px = window.points_px;
  for (int j = 0; j < window.track_count(); ++j) tracks.ids.push_back(j);
  return tracks;
}

Window made_window(const Window& like, const Tracks& tracks) {
  const Camera camera{
      640, 480, like.K(0, 0), like.K(1, 1), like.K(0, 2), like.K(1, 2), Distortion::none, {}};
  return make_window(tracks, camera, like.timestamps_ns, {});
}

TEST(FrameErrors, AreOfTheInliersAfterTheyAreSwapped) {
  const Window simulated = simulate({.off_plane = 0.15, .seed = 3}).window;
  Window window = made_window(simulated, made_tracks(simulated));
  const double before_px = homography_error_px(window);
  window.inlier[9].assign(window.inlier[9].size(), false);
  for (int j = 0; j < 10; ++j) window.inlier[9][j] = true;
  EXPECT_EQ(frame_errors(window, 9).inliers, 10);
  for (int i = 1; i < window.frame_count(); ++i) window.H_i1[i] = Eigen::Matrix3d::Identity();
  EXPECT_GT(homography_error_px(window), 2 * before_px);
}

TEST(FrameErrors, AreRecomputedForMovedPoints) {
  const Window simulated = simulate({.seed = 4}).window;
  const Window window = made_window(simulated, made_tracks(simulated));
  const PlaneMotion motion = *closed_form_motion(window);
  const Window moved = without_rolling_shutter(window, motion, RotationModel::known, {3e-5});
  EXPECT_NE(frame_errors(moved, 9).homography_px, frame_errors(window, 9).homography_px);
}

/// Returns the least summed squares of the errors of a frame over all rotations [px^2], by Newton's
/// method with numerical derivatives.
double least_rotation_squares(const Window& window, int frame) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  const std::vector<int> tracks = window.inlier_tracks(frame);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  const auto errors = [&](const Eigen::Vector3d& w) {
    Eigen::VectorXd all(2 * std::ssize(tracks));
    for (Eigen::Index k = 0; k < std::ssize(tracks); ++k)
      all.segment<2>(2 * k) =
          transfer(window.K * so3_exp(w) * R * K_inverse, window.points_px[0].col(tracks[k])) -
          window.points_px[frame].col(tracks[k]);
    return all;
  };
  for (int step = 0; step < 20; ++step) {
    constexpr double kStep_rad = 1e-6;
    Eigen::MatrixXd J(2 * std::ssize(tracks), 3);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d h = kStep_rad * Eigen::Vector3d::Unit(axis);
      J.col(axis) = (errors(h) - errors(-h)) / (2 * kStep_rad);
    }
    R = so3_exp(-least_squares(J, errors(Eigen::Vector3d::Zero()))) * R;
  }
  return errors(Eigen::Vector3d::Zero()).squaredNorm();
}

TEST(FrameErrors, RotationHasTheLeastSquares) {
  for (const Motion motion : kMotions) {
    const Window window = simulate({.motion = motion, .tilt_deg = 60, .seed = 6}).window;
    const double least = least_rotation_squares(window, 29);
    EXPECT_NEAR(frame_errors(window, 29).rotation_squares / least, 1, 1e-6);
  }
}

TEST(FrameErrors, AreZeroWithoutInliers) {
  Window window = simulate({.seed = 5}).window;
  window.inlier[7].assign(window.track_count(), false);
  EXPECT_EQ(frame_errors(window, 7).homography_px, 0);
  EXPECT_GT(frame_errors(window, 8).homography_px, 0);
}

}  // namespace
}  // namespace gpo::test
