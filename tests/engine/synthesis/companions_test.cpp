// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspector.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/synthesis/synthesize.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace gpo {
namespace {

Recipe companion(const std::string& name) {
  return read_recipe(std::filesystem::path(GPO_SOURCE_DIR) / "sequences/companions" /
                     (name + ".yaml"));
}

/// What the defaults make of the first frames of a companion, drawn with a ray a pixel.
std::shared_ptr<const Inspection> inspect_start_of(const std::string& name, int frames) {
  Recipe recipe = companion(name);
  recipe.frame_count = frames;
  recipe.image.samples = 1;
  const std::filesystem::path folder = test_folder("out") / name;
  synthesize(recipe, folder);
  Settings settings;
  settings.frames = frames;
  return Inspector(open_recording(folder.string())).inspect(settings);
}

/// Of a normal that a window has in its reference camera, to a direction in the world [deg].
double angle_deg(const Pose& camera, const Eigen::Vector3d& normal, const Eigen::Vector3d& world) {
  return degrees(std::acos(std::clamp((camera.R_wc * normal).dot(world), -1.0, 1.0)));
}

TEST(Companions, CornersFloorAndWallsAreFoundWithAnUncalibratedGyroscope) {
  const auto inspection = inspect_start_of("corner", 20);
  const Initialization& result = *inspection->initialization;
  ASSERT_TRUE(result.ok) << result.reason;
  ASSERT_GE(result.planes.size(), 3U);
  const Pose camera = camera_motion(companion("corner").trajectory, 0).pose;
  EXPECT_LT(angle_deg(camera, result.plane.normal, {0, 0, 1}), 1);
  for (const Eigen::Vector3d& facing : {Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(-1, 0, 0)}) {
    const auto faces = [&](const PlaneEstimate& estimate) {
      return angle_deg(camera, estimate.plane.normal, facing) < 3;
    };
    EXPECT_TRUE(std::ranges::any_of(result.planes, faces)) << facing.transpose();
  }
  ASSERT_TRUE(result.bias_rad_s);
  EXPECT_LT((*result.bias_rad_s - companion("corner").gyroscope.bias).norm(), 0.004);
}

TEST(Companions, RubbleIsRefusedForWantOfAPlane) {
  const auto inspection = inspect_start_of("rubble", 20);
  EXPECT_FALSE(inspection->initialization->ok);
  ASSERT_TRUE(inspection->initialization->verdict);
  EXPECT_EQ(inspection->initialization->verdict->readiness, Readiness::no_plane);
}

TEST(Companions, CornersGyroscopeIsBiasedAsEurocsAndNobodyCalibratedIt) {
  const GyroscopeRecipe gyroscope = companion("corner").gyroscope;
  EXPECT_NEAR(gyroscope.bias.norm(), 0.08, 0.005);
  EXPECT_FALSE(gyroscope.calibrated_bias);
}

TEST(Companions, CamerasMoveAsThoseOfDronesDo) {
  const Trajectory trajectory = companion("corner").trajectory;
  for (const double start : {0.0, 0.6, 1.2, 1.8}) {
    const Eigen::Vector3d from = camera_motion(trajectory, start).pose.p_wc;
    const Eigen::Vector3d to = camera_motion(trajectory, start + 20 / 30.0).pose.p_wc;
    EXPECT_GT((to - from).norm() / from.z(), 0.1) << start;
    EXPECT_LT((to - from).norm() / from.z(), 0.25) << start;
  }
}

}  // namespace
}  // namespace gpo
