// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/pose.h"
#include "engine/inspection/studies/planes.h"
#include "engine/methods/candidates/homography_candidates.h"
#include "engine/truth/truth.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace gpo {
namespace {

/// An inspection of a simulated window whose true world is rotated against its reference camera.
struct Studied {
  Inspection inspection;
  Eigen::Vector3d normal;
};
Studied made(test::Motion motion) {
  const test::Simulation simulation = test::simulate({.motion = motion, .frames = 15});
  Studied studied{{}, simulation.plane.normal};
  studied.inspection.window = std::make_shared<const Window>(simulation.window);
  const Eigen::Matrix3d R = so3_exp({0.3, -0.5, 1});
  WindowTruth truth;
  truth.plane = Plane{-(R * simulation.plane.normal), 1};  // its sign is arbitrary
  truth.cameras.push_back(Pose{R, {1, 2, 3}});
  studied.inspection.truth = std::make_shared<const WindowTruth>(truth);
  return studied;
}

TEST(NormalStudy, FindsTheNormalByLandscapeAndClusters) {
  const Studied studied = made(test::Motion::sideways);
  const auto study = study_normals(studied.inspection);
  ASSERT_NE(study, nullptr);
  EXPECT_EQ(study->window, studied.inspection.window);
  EXPECT_EQ(study->candidates.size(), 15U);
  EXPECT_TRUE(study->candidates[0].empty());
  ASSERT_FALSE(study->clusters.empty());
  EXPECT_LT(angle_deg(study->clusters[0].normal, studied.normal), 2);
  EXPECT_GE(study->clusters[0].members, 3);
  EXPECT_GT(study->clusters[0].weight, 0.1);
  for (std::size_t k = 1; k < study->clusters.size(); ++k)
    EXPECT_LE(study->clusters[k].weight, study->clusters[k - 1].weight + 1e-12);
  const std::vector<float> rms = rms_px(study->landscape, 15);
  const auto least = std::ranges::min_element(rms, [](float a, float b) {
    return (std::isnan(a) ? INFINITY : a) < (std::isnan(b) ? INFINITY : b);
  });
  const int cell = static_cast<int>(least - rms.begin()), side = study->landscape.side;
  EXPECT_LT(
      angle_deg(normal_from_disc(disc_of_cell(side, cell / side, cell % side)), studied.normal), 4);
}

TEST(NormalStudy, HasTheTrueNormalFacingTheReferenceCamera) {
  Studied studied = made(test::Motion::sideways);
  const auto normal = true_normal(studied.inspection);
  ASSERT_TRUE(normal);
  EXPECT_LT(angle_deg(*normal, studied.normal), 1e-9);
  studied.inspection.truth = nullptr;
  EXPECT_FALSE(true_normal(studied.inspection));
}

TEST(NormalStudy, IsNullIfStopped) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(study_normals(made(test::Motion::sideways).inspection, stop.get_token()), nullptr);
}

}  // namespace
}  // namespace gpo
