// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/solvers.h"

#include "engine/base/error.h"
#include "engine/geometry/pose.h"
#include "tests/engine/simulated_window.h"
#include "tests/engine/test_folder.h"

#include <limits>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

void expect_solution(const Initialization& found,
                     const Simulation& simulation,
                     double normal_deg,
                     double center) {
  ASSERT_TRUE(found.ok) << found.reason;
  EXPECT_LT(angle_deg(found.plane.normal, simulation.plane.normal), normal_deg);
  for (std::size_t i = 0; i < simulation.cameras.size(); ++i)
    EXPECT_LT((found.cameras[i].p_wc - simulation.cameras[i].p_wc).norm(), center) << i;
}

PlaneHomographies homographies_of(const Window& window) {
  return {.K = window.K, .H_i1 = window.H_i1, .R_wc = window.R_wc};
}

TEST(Solvers, AreExactForExactHomographiesInAnyWorld) {
  const auto simulation = simulate({.motion = Motion::orbit, .frames = 8, .noise_px = 0});
  PlaneHomographies homographies = homographies_of(simulation.window);
  for (Eigen::Matrix3d& R_wc : homographies.R_wc) R_wc = so3_exp({0.3, -0.4, 1.1}) * R_wc;
  expect_solution(closed_form_of_homographies(homographies), simulation, 1e-5, 1e-7);
  expect_solution(gpo_of_homographies(homographies), simulation, 1e-5, 1e-7);
}

TEST(Solvers, AreAccurateForNoisyHomographies) {
  const auto simulation = with_fitted_homographies(simulate({.motion = Motion::orbit}));
  PlaneHomographies homographies = homographies_of(simulation.window);
  homographies.points_px = simulation.window.points_px[0];
  expect_solution(closed_form_of_homographies(homographies), simulation, 0.3, 0.02);
  expect_solution(gpo_of_homographies(homographies), simulation, 0.3, 0.02);
}

TEST(Solvers, FindPlaneAndCamerasFromTracksWithExactAndRoughRotations) {
  const auto simulation = simulate(noisy(Motion::orbit, 2));
  PlaneTracks tracks{simulation.window.K, simulation.window.points_px, simulation.window.R_wc};
  tracks.points_px[3].col(5).setConstant(std::numeric_limits<double>::quiet_NaN());
  expect_solution(plane_and_cameras(tracks, RotationModel::known), simulation, 0.3, 0.02);
  for (std::size_t i = 1; i < tracks.R_wc.size(); ++i)
    tracks.R_wc[i] = tracks.R_wc[i] * so3_exp({0.004, -0.003, 0.002});
  const Initialization found = plane_and_cameras(tracks, RotationModel::free);
  expect_solution(found, simulation, 0.5, 0.03);
  ASSERT_TRUE(found.uncertainty);
  EXPECT_LT(found.uncertainty->normal_sigma_deg, 0.3);
}

TEST(Solvers, RejectListsOfDifferentLengths) {
  const auto simulation = simulate({.frames = 4});
  PlaneHomographies homographies = homographies_of(simulation.window);
  homographies.R_wc.pop_back();
  EXPECT_EQ(error_of([&] { gpo_of_homographies(homographies); }),
            "4 frames and 3 rotations, expected equal counts");
  PlaneTracks tracks{simulation.window.K, simulation.window.points_px, simulation.window.R_wc};
  tracks.points_px[2].conservativeResize(2, 7);
  EXPECT_EQ(error_of([&] { plane_and_cameras(tracks, RotationModel::known); }),
            "frame 2: 7 points, expected 150 as in frame 0");
}

}  // namespace
}  // namespace gpo::test
