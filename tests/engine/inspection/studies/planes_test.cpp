// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/planes.h"

#include "engine/geometry/pose.h"
#include "engine/methods/candidates/homography_candidates.h"
#include "engine/truth/truth.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector3d;

const Vector3d kUp = Vector3d(0.1, -0.9, -0.4).normalized();  // in the reference camera

/// Returns a direction at an angle from up.
Vector3d tilted(double deg) {
  const Vector3d across = kUp.cross(Vector3d::UnitX()).normalized();
  return std::cos(radians(deg)) * kUp + std::sin(radians(deg)) * across;
}

Inspection of_planes(const std::vector<Plane>& planes, double gravity_sigma_deg = 0.5) {
  Inspection inspection;
  auto result = std::make_shared<Initialization>();
  auto window = std::make_shared<Window>();
  result->ok = true;
  result->plane = planes.front();
  for (int k = 0; k < static_cast<int>(planes.size()); ++k)
    result->planes.push_back({.number = k, .plane = planes[k]});
  window->planes.resize(planes.size());
  inspection.initialization = result;
  inspection.window = window;
  InertialAlignment inertial;
  inertial.ok = true;
  inertial.gravity_m_s2 = -9.81 * kUp;
  inertial.gravity_sigma_deg = gravity_sigma_deg;
  inertial.scale = 1.4;
  inertial.scale_known = true;
  inspection.inertial = inertial;
  return inspection;
}

std::string name_of(const Inspection& inspection, int number) {
  const auto name = plane_name(inspection, number);
  return name ? name->name : "";
}

TEST(PlaneName, FollowsFromNormalAndGravity) {
  const Inspection room = of_planes({{tilted(88), 1.2},
                                     {tilted(1), 1.0},
                                     {tilted(2), 0.6},
                                     {tilted(179), 0.8},
                                     {tilted(45), 1.0},
                                     {tilted(3), 0.97}});
  const std::vector<std::string> names{"wall", "floor", "table", "ceiling", "slanted", "floor"};
  for (int k = 0; k < 6; ++k) EXPECT_EQ(name_of(room, k), names[k]) << k;
  EXPECT_EQ(plane_title(room, 2), "plane 3 (table)");
  EXPECT_NEAR(plane_name(room, 0)->tilt_deg, 88, 1e-9);
  EXPECT_NEAR(plane_name(room, 0)->sigma_deg, 0.5, 1e-9);
}

TEST(PlaneName, HasWiderLimitsForUncertainPlanesUpToNone) {
  EXPECT_EQ(name_of(of_planes({{tilted(12), 1}}, 1), 0), "slanted");
  EXPECT_EQ(name_of(of_planes({{tilted(12), 1}}, 7), 0), "floor");
  EXPECT_EQ(name_of(of_planes({{tilted(12), 1}}, 16), 0), "");
}

TEST(PlaneName, UsesTheOnlyPlaneOfAMethod) {
  Inspection one = of_planes({{tilted(90), 1}});
  auto result = std::make_shared<Initialization>(*one.initialization);
  result->planes.clear();
  one.initialization = result;
  EXPECT_EQ(name_of(one, 0), "wall");
  EXPECT_EQ(name_of(one, 1), "");
}

TEST(PlaneName, NeedsGravity) {
  Inspection without = of_planes({{tilted(90), 1}});
  EXPECT_EQ(known_scale(without), 1.4);
  without.inertial->scale_known = false;
  EXPECT_FALSE(known_scale(without));
  without.inertial.reset();
  EXPECT_EQ(name_of(without, 0), "");
  EXPECT_EQ(plane_title(without, 0), "plane 1");
  EXPECT_FALSE(known_scale(without));
}

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
