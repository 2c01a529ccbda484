// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/evaluation/truth_conventions.h"

#include "tests/engine/simulated_window.h"

#include <functional>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using testing::HasSubstr;

const Matrix3d kOpenGl = Eigen::Vector3d(1, -1, -1).asDiagonal();

Matrix3d w_first(const Matrix3d& R) {
  const Quaterniond q(R);  // written as w x y z and read as x y z w
  return Quaterniond(q.z(), q.w(), q.x(), q.y()).toRotationMatrix();
}

Matrix3d w_last(const Matrix3d& R) {
  const Quaterniond q(R);
  return Quaterniond(q.x(), q.y(), q.z(), q.w()).toRotationMatrix();
}

Matrix3d inverted(const Matrix3d& R) { return R.transpose(); }

/// Returns R_wc of the images with `sigma_deg` of noise; the first one is I.
std::vector<Matrix3d> images(const Simulation& s, double sigma_deg = 0.02) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, radians(sigma_deg));
  std::vector<Matrix3d> R_wc{Matrix3d::Identity()};
  for (std::size_t i = 1; i < s.cameras.size(); ++i)
    R_wc.push_back(s.cameras[i].R_wc * so3_exp({noise(random), noise(random), noise(random)}));
  return R_wc;
}

/// Returns the true cameras in another world as a file with another convention is read.
WindowTruth read_as(const Simulation& s,
                    const std::function<Matrix3d(const Matrix3d&)>& convention) {
  const Matrix3d R_world_ref = so3_exp({0.4, -1.2, 0.8});
  WindowTruth truth{"groundtruth.txt", {}, {}};
  for (const Pose& camera : s.cameras)
    truth.cameras.push_back(Pose{convention(R_world_ref * camera.R_wc), camera.p_wc});
  return truth;
}

std::optional<TruthConvention> found_in(const WindowTruth& truth, const Simulation& s) {
  return truth_convention(truth, images(s), radians(0.02));
}

struct Written {
  std::function<Matrix3d(const Matrix3d&)> read;
  const char* name;
  const char* advice;
};

TEST(TruthConventions, AreNamedWithWhatToChange) {
  const Written conventions[] = {
      {w_first, "its quaternions are read w first", "write each quaternion as qx qy qz qw"},
      {w_last, "its quaternions are read w last", "write each quaternion as qw qx qy qz"},
      {inverted, "its poses are inverted, from world to camera", "camera to world"},
      {[](const Matrix3d& R) { return Matrix3d(R * kOpenGl); },
       "its axes are x right, y up, z back (OpenGL)",
       "write T_truth_camera with the rotation [1 0 0; 0 -1 0; 0 0 -1] into groundtruth.yaml"},
      {[](const Matrix3d& R) { return w_first(inverted(R)); },
       "its quaternions are read w first and its poses are inverted, from world to camera",
       "write each quaternion as qx qy qz qw, write each pose from camera to world"},
      {[](const Matrix3d& R) { return inverted(R * kOpenGl); },
       "its poses are inverted, from world to camera and its axes are x right, y up, z back "
       "(OpenGL)",
       "into groundtruth.yaml"},
      {[](const Matrix3d& R) {
         Matrix3d body;  // x forward, y left, z up
         body << 0, 0, 1, -1, 0, 0, 0, -1, 0;
         return Matrix3d(R * body.transpose());
       },
       "its axes are x forward, y left, z up (a body's)",
       "[0 0 1; -1 0 0; 0 -1 0]"},
      {[](const Matrix3d& R) {
         const Eigen::Vector3d mirror(1, -1, 1);
         return Matrix3d(mirror.asDiagonal() * R * mirror.asDiagonal());
       },
       "its axes are x right, y up, z forward (left-handed)",
       "right-handed axes"}};
  for (const Motion motion : {Motion::wander, Motion::orbit, Motion::arc})
    for (const int frames : {10, 30}) {
      const Simulation s = simulate({.motion = motion, .frames = frames, .noise_px = 0});
      for (const Written& one : conventions) {
        const auto found = found_in(read_as(s, one.read), s);
        ASSERT_TRUE(found) << one.name << static_cast<int>(motion) << frames;
        EXPECT_EQ(found->name, one.name) << static_cast<int>(motion) << frames;
        EXPECT_THAT(found->advice, HasSubstr(one.advice));
        EXPECT_GT(found->as_read_deg, 5 * found->fitted_deg);
        EXPECT_LT(found->fitted_deg, 0.1);
      }
    }
}

TEST(TruthConventions, FindTheConstantRotationOfABody) {
  const Simulation s = simulate({.motion = Motion::wander, .noise_px = 0});
  const auto turned = [&](const Eigen::Vector3d& turn_rad) {
    return read_as(s, [=](const Matrix3d& R) { return Matrix3d(R * so3_exp(-turn_rad)); });
  };
  const auto found = found_in(turned({0.3, 0.5, -0.2}), s);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->name, "its axes are turned by 35.3 deg against the camera's");
  EXPECT_LT(found->fitted_deg, 0.1);
  EXPECT_FALSE(found_in(turned({0.08, 0.1, -0.05}), s)) << "extrinsics that are a little off";
}

TEST(TruthConventions, AreFoundBehindTheExtrinsicsOfTheFile) {
  const Simulation s = simulate({.motion = Motion::wander, .noise_px = 0});
  WindowTruth truth = read_as(s, [](const Matrix3d& R) { return R; });
  truth.R_measured_camera = so3_exp({0.3, 0.5, -0.2});
  EXPECT_FALSE(found_in(truth, s));
  for (auto& camera : truth.cameras)
    camera->R_wc =
        w_first(camera->R_wc * truth.R_measured_camera.transpose()) * truth.R_measured_camera;
  truth.cameras[3].reset();
  const auto found = found_in(truth, s);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->name, "its quaternions are read w first");
  truth.cameras.front().reset();
  EXPECT_FALSE(found_in(truth, s)) << "nothing to compare with";
}

TEST(TruthConventions, AreNotBlamedForRotationsThatNoneOfThemExplains) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, radians(3));
  for (const Motion motion : kMotions)
    for (const int frames : {3, 10, 30}) {
      const Simulation s = simulate({.motion = motion, .frames = frames, .noise_px = 0});
      const auto wrong = [&](const Matrix3d& R) {
        return Matrix3d(R * so3_exp({noise(random), noise(random), noise(random)}));
      };
      EXPECT_FALSE(found_in(read_as(s, [](const Matrix3d& R) { return R; }), s));
      EXPECT_FALSE(found_in(read_as(s, wrong), s)) << static_cast<int>(motion) << frames;
    }
  const Simulation s = simulate({.motion = Motion::wander, .noise_px = 0});
  const WindowTruth inverse = read_as(s, inverted);
  EXPECT_TRUE(truth_convention(inverse, images(s), radians(0.02)));
  EXPECT_FALSE(truth_convention(inverse, images(s), radians(5))) << "the images know no better";
  EXPECT_FALSE(truth_convention(inverse, {}, 0)) << "no rotations by images";
}

}  // namespace
}  // namespace gpo::test
