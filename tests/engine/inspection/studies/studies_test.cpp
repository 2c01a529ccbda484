// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"

#include "engine/inspection/inspector.h"
#include "engine/methods/candidates/homography_candidates.h"
#include "tests/engine/desk.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d;

TEST(StartsToScan, AreMultiplesOfTheStepFromCoarseToFine) {
  for (const auto& [recorded, frames, step] :
       {std::tuple{60, 30, 1}, {60, 60, 1}, {31, 30, 7}, {1000, 20, 13}, {257, 1, 1}}) {
    const auto starts = starts_to_scan(recorded, frames, step);
    const std::set<int> once(starts.begin(), starts.end());
    EXPECT_EQ(once.size(), starts.size());
    for (int start = 0; start + frames <= recorded; start += step)
      EXPECT_TRUE(once.contains(start)) << start;
    EXPECT_EQ(once.size(), static_cast<std::size_t>((recorded - frames) / step + 1));
    // The gap between neighbors halves as their number doubles.
    for (std::size_t count = 4; count < starts.size(); count *= 2) {
      std::set<int> first(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(count));
      int gap = 0;
      for (auto at = first.begin(); std::next(at) != first.end(); ++at)
        gap = std::max(gap, *std::next(at) - *at);
      EXPECT_LE(gap, 4 * (recorded - frames) / static_cast<int>(count) + step);
    }
  }
  EXPECT_TRUE(starts_to_scan(20, 30, 1).empty());
  EXPECT_EQ(scan_step(60, 30), 1);
  EXPECT_LE(starts_to_scan(100'000, 30, scan_step(100'000, 30)).size(), 101U);
}

TEST(ScanStarts, MatchSingleInspections) {
  const Settings settings{.frames = 20};
  const std::vector<int> starts = starts_to_scan(desk()->frame_count(), 20, 10);
  std::vector<ScannedStart> found;
  scan_starts(desk(), settings, {starts, 2}, [&](const auto& one) { found.push_back(one); });
  ASSERT_EQ(found.size(), starts.size());
  Inspector inspector(desk());
  for (const ScannedStart& one : found) {
    Settings window = settings;
    window.start = one.start;
    const auto alone = inspector.inspect(window);
    EXPECT_EQ(one.ok, alone->initialization->ok);
    EXPECT_EQ(one.readiness, alone->initialization->verdict->readiness);
    EXPECT_EQ(one.sigma_deg, alone->initialization->uncertainty->normal_sigma_deg);
    EXPECT_EQ(one.pne_deg, alone->evaluation->pne_deg);
    EXPECT_EQ(one.reason, alone->initialization->verdict->reason);
  }
}

TEST(ScanStarts, ReportWhyAStartFails) {
  std::vector<ScannedStart> found;
  const std::vector<int> starts{3};
  scan_starts(desk(),
              {.frames = 20, .options = {.method = "gpoo"}},
              {.starts = starts},
              [&](const auto& one) { found.push_back(one); });
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].start, 3);
  EXPECT_FALSE(found[0].ok);
  EXPECT_NE(found[0].reason.find("gpoo"), std::string::npos) << found[0].reason;
  const std::string csv = to_csv(found, *desk());
  EXPECT_TRUE(csv.starts_with("start,time_s,status,verdict,sigma_deg,pne_deg,reason\n3,")) << csv;
  EXPECT_EQ(std::ranges::count(csv, ','), 12) << csv;
}

TEST(BestStart, HasTheBestReadinessThenTheLowestUncertainty) {
  const ScannedStart failed{.start = 0, .reason = "no parallax"};
  const ScannedStart certain{
      .start = 1, .ok = true, .readiness = Readiness::weak, .sigma_deg = 0.1};
  const ScannedStart ready{.start = 2, .ok = true, .readiness = Readiness::ready, .sigma_deg = 0.3};
  const ScannedStart best{
      .start = 3, .ok = true, .readiness = Readiness::ready, .sigma_deg = 0.2, .pne_deg = 0.05};
  const ScannedStart unknown{.start = 4, .ok = true, .readiness = Readiness::ready};
  const auto start_of = [](const std::vector<ScannedStart>& starts) {
    const ScannedStart* found = best_start(starts);
    return found == nullptr ? -1 : found->start;
  };
  EXPECT_EQ(start_of({failed, certain, ready, best, unknown}), 3);
  EXPECT_EQ(start_of({failed, unknown, certain}), 4);
  EXPECT_EQ(start_of({failed, certain}), 1);
  EXPECT_EQ(start_of({failed}), -1);
  EXPECT_EQ(start_of({}), -1);
  EXPECT_EQ(to_text(best), "3 (ready, normal +- 0.2 deg, PNE 0.05 deg)");
  EXPECT_EQ(to_text(failed), "0 (failed: no parallax)");
}

const Vector3d kUp = Vector3d(0.1, -0.9, -0.4).normalized();  // in the reference camera

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
    result->planes.push_back({.number = k,
                              .plane = planes[k],
                              .normal_covariance = Eigen::Matrix3d(Eigen::Matrix3d::Zero())});
  window->planes.resize(planes.size());
  inspection.initialization = result;
  inspection.window = window;
  InertialAlignment inertial;
  inertial.ok = true;
  inertial.gravity_m_s2 = -9.81 * kUp;
  const double sigma = radians(gravity_sigma_deg);
  inertial.direction_covariance =
      sigma * sigma / 2 * (Eigen::Matrix3d::Identity() - kUp * kUp.transpose());
  inertial.scale = 1.4;
  inertial.scale_known = true;
  inspection.inertial = inertial;
  return inspection;
}

std::string name_of(const Inspection& inspection, int number) {
  const auto name = plane_name(inspection, number);
  return name ? name->name : "";
}

TEST(PlaneName, FollowsFromNormalAndGravityWithWiderLimitsIfUncertain) {
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
  EXPECT_NEAR(plane_name(room, 0)->sigma_deg.value(), 0.5 / std::sqrt(2), 1e-9);
  EXPECT_NEAR(plane_name(room, 1)->sigma_deg.value(), 0.5, 1e-9) << "any change tilts a floor";
  EXPECT_EQ(name_of(of_planes({{tilted(12), 1}}, 1), 0), "slanted");
  EXPECT_EQ(name_of(of_planes({{tilted(12), 1}}, 7), 0), "floor");
  EXPECT_EQ(name_of(of_planes({{tilted(12), 1}}, 16), 0), "");
}

TEST(PlaneName, HasTheUncertaintyOfItsTiltAlone) {
  Inspection room = of_planes({{tilted(60), 1.0}});
  auto result = std::make_shared<Initialization>(*room.initialization);
  const Vector3d axis = kUp.cross(tilted(60)).normalized();  // rotations about it change the tilt
  const Vector3d along = axis.cross(tilted(60));
  const double tilts = radians(1), turns = radians(7);
  result->planes[0].normal_covariance = Eigen::Matrix3d(tilts * tilts * along * along.transpose() +
                                                        turns * turns * axis * axis.transpose());
  room.initialization = result;
  EXPECT_NEAR(plane_name(room, 0)->sigma_deg.value(), std::sqrt(1 + 0.5 * 0.5 / 2), 1e-9);
}

TEST(PlaneName, HasNoUncertaintyWhereTheMethodGivesNoneForThePlane) {
  Inspection room = of_planes({{tilted(1), 1.0}, {tilted(91), 1.2}});
  auto result = std::make_shared<Initialization>(*room.initialization);
  result->planes[1].normal_covariance.reset();
  result->uncertainty.emplace().normal_sigma_deg = 0.1;
  room.initialization = result;
  EXPECT_EQ(name_of(room, 1), "wall");
  EXPECT_TRUE(plane_name(room, 0)->sigma_deg);
  EXPECT_FALSE(plane_name(room, 1)->sigma_deg);
}

TEST(PlaneName, UsesTheOnlyPlaneOfAMethodAndNeedsGravity) {
  Inspection one = of_planes({{tilted(90), 1}});
  auto result = std::make_shared<Initialization>(*one.initialization);
  result->planes.clear();
  one.initialization = result;
  EXPECT_EQ(name_of(one, 0), "wall");
  EXPECT_EQ(name_of(one, 1), "");
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
Studied made(Motion motion) {
  const Simulation simulation = simulate({.motion = motion, .frames = 15});
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
  const Studied studied = made(Motion::sideways);
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

TEST(NormalStudy, HasTheTrueNormalFacingTheReferenceCameraAndIsNullIfStopped) {
  Studied studied = made(Motion::sideways);
  const auto normal = true_normal(studied.inspection);
  ASSERT_TRUE(normal);
  EXPECT_LT(angle_deg(*normal, studied.normal), 1e-9);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(study_normals(studied.inspection, stop.get_token()), nullptr);
  studied.inspection.truth = nullptr;
  EXPECT_FALSE(true_normal(studied.inspection));
}

}  // namespace
}  // namespace gpo::test
