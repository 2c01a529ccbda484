// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"
#include "tests/engine/desk.h"
#include "tests/engine/simulated_window.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

constexpr int kAllFrames = 40, kKnown = 20;

/// A recording with tracks and true poses, in units of the plane's distance.
std::shared_ptr<const Recording> simulated_recording(const Simulation& simulation,
                                                     int frames_of_tracks = kAllFrames) {
  auto recording = std::make_shared<Recording>();
  recording->name = "simulated";
  recording->camera = Camera{640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}};
  recording->timestamps_ns = simulation.window.timestamps_ns;
  recording->truth = GroundTruth{"simulation", {}};
  for (const Pose& pose : simulation.cameras) recording->truth->poses.emplace_back(pose);
  for (int i = 0; i < frames_of_tracks; ++i)
    for (int j = 0; j < simulation.window.track_count(); ++j)
      recording->tracks.push_back(
          {.frame = i, .track = j, .raw_px = simulation.window.points_px[i].col(j)});
  return recording;
}

std::shared_ptr<const Inspection> inspected(const std::shared_ptr<const Recording>& recording) {
  Settings settings{.frames = kKnown};
  settings.options.method = "gpo";
  settings.options.rotations = RotationSource::truth;
  return Inspector(recording).inspect(settings);
}

Simulation moving(double noise_px) {
  return simulate({.motion = Motion::orbit,
                   .frames = kAllFrames,
                   .noise_px = noise_px,
                   .travel = 0.4,
                   .off_plane = 0.1});
}

TEST(Extrapolation, HasTheExactPosesOfExactTracks) {
  const Simulation exact = moving(0);
  const auto inspection = inspected(simulated_recording(exact));
  ASSERT_TRUE(inspection->initialization->ok) << inspection->initialization->reason;
  const auto after = extrapolate(inspection, 100);
  ASSERT_EQ(after->cameras.size(), kAllFrames - kKnown);
  EXPECT_EQ(after->end, "the recording ends");
  for (const ExtrapolatedCamera& camera : after->cameras) {
    const Pose& truth = exact.cameras[camera.frame];
    EXPECT_LT((camera.pose.p_wc - truth.p_wc).norm(), 1e-5) << camera.frame;
    EXPECT_LT(so3_log(camera.pose.R_wc.transpose() * truth.R_wc).norm(), 1e-5) << camera.frame;
    EXPECT_GT(camera.points, 100);
    EXPECT_LT(camera.median_px, 0.01);
    EXPECT_EQ(camera.timestamp_ns, exact.window.timestamps_ns[camera.frame]);
  }
}

TEST(Extrapolation, StaysNearTheTruthWithNoiseAndOutliers) {
  const Simulation noisy = moving(0.4);
  const auto after = extrapolate(inspected(simulated_recording(noisy)), 100);
  ASSERT_EQ(after->cameras.size(), kAllFrames - kKnown);
  for (const ExtrapolatedCamera& camera : after->cameras)
    EXPECT_LT((camera.pose.p_wc - noisy.cameras[camera.frame].p_wc).norm(), 0.02) << camera.frame;
}

constexpr double kLateRow_s = 6e-5;

/// Returns the window of a camera that reads its rows one after the other, or all at once, by
/// `gpo_joint`.
std::shared_ptr<const Inspection> rolling_window(const Simulation& simulation, double row_delay_s) {
  Recording recording = *simulated_recording(simulation);
  recording.camera.readout = Readout{row_delay_s * (recording.camera.height - 1), 1e-4};
  Settings settings{.frames = kKnown};
  settings.options.rotations = RotationSource::truth;
  return Inspector(std::make_shared<const Recording>(std::move(recording))).inspect(settings);
}

SimulationOptions brisk_orbit(double row_delay_s) {
  return {.motion = Motion::orbit,
          .frames = kAllFrames,
          .noise_px = 0.1,
          .travel = 0.8,
          .row_delay_s = row_delay_s};
}

double worst_error(const Inspection& inspection, const Simulation& simulation) {
  const auto after = extrapolate(std::make_shared<const Inspection>(inspection), 10);
  double worst = after->cameras.size() == 10 ? 0 : 1;
  for (const ExtrapolatedCamera& camera : after->cameras)
    worst = std::max(worst, (camera.pose.p_wc - simulation.cameras[camera.frame].p_wc).norm());
  return worst;
}

TEST(Extrapolation, FollowsTheRowsOfARollingShutter) {
  const Simulation simulation = simulate(brisk_orbit(kLateRow_s));
  Inspection inspection = *rolling_window(simulation, kLateRow_s);
  ASSERT_TRUE(inspection.initialization->row_delay_s);
  const double by_rows = worst_error(inspection, simulation);
  inspection.row_motions.clear();
  EXPECT_LT(by_rows, 0.005);
  EXPECT_GT(worst_error(inspection, simulation), 3 * by_rows);
}

TEST(Growth, IsTheSameWithARollingShutter) {
  const auto late = rolling_window(simulate(brisk_orbit(kLateRow_s)), kLateRow_s);
  const auto still = rolling_window(simulate(brisk_orbit(0)), 0);
  ASSERT_EQ(late->growth.size(), still->growth.size());
  for (std::size_t k = 5; k + 1 < late->growth.size(); ++k)
    EXPECT_LT(*late->growth[k].normal_sigma_deg, 1.5 * *still->growth[k].normal_sigma_deg) << k;
}

TEST(Extrapolation, EndsWithItsTracksAndSaysWhy) {
  const auto after = extrapolate(inspected(simulated_recording(moving(0.2), 27)), 100);
  EXPECT_EQ(after->last_frame(), 26);
  EXPECT_THAT(after->end,
              HasSubstr("frame 27: 0 points of the planes seen, at least 8 are needed"));
  EXPECT_EQ(to_json(*after)["frames"].size(), 27U - kKnown);
  EXPECT_EQ(to_json(*after)["end"], after->end);
}

TEST(Extrapolation, ExtendsTheWindowForViewsAndLeavesItsResultAlone) {
  const auto inspection = inspected(simulated_recording(moving(0.2)));
  const auto after = extrapolate(inspection, 6);
  EXPECT_EQ(after->end, "");
  const Inspection& longer = *after->extended;
  EXPECT_EQ(longer.extrapolated_from, kKnown);
  EXPECT_EQ(longer.window->frame_count(), kKnown + 6);
  EXPECT_EQ(longer.tracks->frame_count(), kKnown + 6);
  EXPECT_EQ(longer.initialization->cameras.size(), kKnown + 6U);
  EXPECT_EQ(longer.truth->cameras.size(), kKnown + 6U);
  EXPECT_EQ(inspection->window->frame_count(), kKnown);
  EXPECT_EQ(longer.initialization->plane.normal, inspection->initialization->plane.normal);
  // The inliers of the last frame agree with the homography of plane and camera.
  const auto residuals = residuals_px(longer, kKnown + 5);
  EXPECT_GT(residuals.size(), 100U);
  EXPECT_LT(std::ranges::max(residuals), inspection->window->threshold_px);
  EXPECT_FALSE(track_life(longer, 100).verdict.empty());
}

TEST(Extrapolation, FollowsTheImagesOfADeskAndAgreesWithItsTruth) {
  const auto inspection = Inspector(desk()).inspect({.frames = 20});
  ASSERT_TRUE(inspection->initialization->ok);
  const auto after = extrapolate(inspection, 10);
  ASSERT_EQ(after->cameras.size(), 10U) << after->end;
  const Inspection& longer = *after->extended;
  ASSERT_TRUE(longer.truth && inspection->evaluation && inspection->evaluation->scale);
  const Pose& reference = *longer.truth->cameras[0];
  for (const ExtrapolatedCamera& camera : after->cameras) {
    const Pose& truth = *longer.truth->cameras[camera.frame];
    const Eigen::Vector3d moved_m = to_camera(reference, truth.p_wc);
    const Eigen::Vector3d found_m = *inspection->evaluation->scale * camera.pose.p_wc;
    EXPECT_LT((found_m - moved_m).norm(), 0.1 * moved_m.norm()) << camera.frame;
  }
}

}  // namespace
}  // namespace gpo::test
