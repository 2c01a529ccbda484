// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/checks.h"
#include "engine/diagnosis/diagnosis.h"
#include "engine/diagnosis/focal_change.h"
#include "engine/diagnosis/moving_objects.h"
#include "engine/methods/initializers.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Vector2d;

/// A window with static tracks where `is_static` of the place in the reference image.
struct Marked {
  Window window;
  Tracks tracks;

  Marked(const std::function<bool(const Vector2d&)>& is_static)
      : window(simulate(noisy(Motion::sideways, 1, 0.1)).window) {
    tracks.raw_px = window.points_px;
    tracks.ids.resize(window.track_count());
    std::iota(tracks.ids.begin(), tracks.ids.end(), 100);
    for (int j = 0; j < window.track_count(); ++j)
      if (is_static(tracks.raw_px[0].col(j))) window.static_tracks.push_back(j);
    for (Eigen::Matrix2Xd& frame_px : window.points_px)
      for (const int j : window.static_tracks) frame_px.col(j).setConstant(NAN);
  }
  std::vector<Finding> findings() const {
    const auto all =
        findings_of({.window = &window, .tracks = &tracks, .ids = tracks.ids}, {Of::window});
    std::vector<Finding> found;
    std::ranges::copy_if(all, std::back_inserter(found), [](const Finding& finding) {
      return finding.key == "static-tracks";
    });
    return found;
  }
};

TEST(StaticTracksFinding, IsSilentWithoutThem) {
  EXPECT_TRUE(Marked([](const Vector2d&) { return false; }).findings().empty());
}

TEST(StaticTracksFinding, IsANoteOnACarrierInView) {
  const Marked marked([](const Vector2d& p) { return p.y() > 360; });
  const auto findings = marked.findings();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, Level::note);
  EXPECT_EQ(std::ssize(findings[0].tracks), std::ssize(marked.window.static_tracks));
  EXPECT_EQ(findings[0].tracks[0], 100 + marked.window.static_tracks[0]);
  EXPECT_NE(findings[0].sentence.find(
                fmt::format("{} of 150 tracks do not move", marked.window.static_tracks.size())),
            std::string::npos);
  EXPECT_NE(findings[0].sentence.find("carrier, or dirt; they"), std::string::npos);
  EXPECT_EQ(findings[0].sentence.find("move by 0 px"), std::string::npos);
  EXPECT_EQ(findings[0].advice, "");
}

TEST(StaticTracksFinding, IsWeakIfTheyAreTheMajority) {
  const auto findings = Marked([](const Vector2d& p) { return p.y() > 180; }).findings();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, Level::weak);
  EXPECT_TRUE(findings[0].command.starts_with("mask not ")) << findings[0].command;
  EXPECT_EQ(findings[0].advice, "if the camera moves, mask them");
}

TEST(StaticTracksFinding, IsWeakIfTheySurroundTheOthers) {
  const auto findings = Marked([](const Vector2d& p) {
                          return p.x() < 90 || p.x() > 550 || p.y() < 70 || p.y() > 410;
                        }).findings();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, Level::weak);
  EXPECT_EQ(findings[0].command, "");  // a rectangle would leave out all tracks
}

TEST(StaticTracksFinding, IsANoteOnTextInTheCorners) {
  const auto findings = Marked([](const Vector2d& p) {
                          return (p.x() < 110 || p.x() > 530) && (p.y() < 80 || p.y() > 400);
                        }).findings();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, Level::note);
}

Initialization true_result(const Simulation& simulation) {
  Initialization result;
  result.ok = true;
  result.plane = simulation.plane;
  result.cameras = simulation.cameras;
  return result;
}

/// Moves tracks of a window away, in pixels a frame, and marks them as outliers.
void move_away(Simulation& simulation, const std::vector<int>& tracks, const auto& step_px) {
  for (int i = 1; i < simulation.window.frame_count(); ++i) {
    for (const int j : tracks) {
      simulation.window.points_px[i].col(j) += i * step_px(j);
      simulation.window.inlier[i][j] = false;
    }
  }
}

std::vector<int> tracks_in(const Window& window, const Vector2d& from, const Vector2d& to) {
  std::vector<int> tracks;
  for (int j = 0; j < window.track_count(); ++j)
    if (Eigen::AlignedBox2d(from, to).contains(window.points_px[0].col(j).eval()))
      tracks.push_back(j);
  return tracks;
}

TEST(MovingObjects, AreFoundInTheirRegion) {
  for (const Motion motion : {Motion::sideways, Motion::orbit, Motion::wander}) {
    Simulation simulation = simulate(noisy(motion, 3, 0.2));
    const auto object = tracks_in(simulation.window, {200, 150}, {420, 330});
    ASSERT_GE(object.size(), 12U);
    move_away(simulation, object, [](int) { return Vector2d(0.8, -1.6); });
    const auto found = moving_objects(simulation.window, true_result(simulation));
    EXPECT_TRUE(std::ranges::includes(object, found));
    EXPECT_GE(found.size(), 0.7 * object.size()) << int(motion);
    std::vector<std::int64_t> ids(simulation.window.track_count());
    std::iota(ids.begin(), ids.end(), 100);
    const Initialization result = true_result(simulation);
    const auto findings =
        check::moving_objects({.window = &simulation.window, .ids = ids, .result = &result});
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings[0].level, Level::note);
    EXPECT_EQ(findings[0].tracks.front(), 100 + found.front());
  }
}

TEST(MovingObjects, AreNotScatteredOutliers) {
  for (int seed = 1; seed <= 20; ++seed) {
    Simulation simulation = simulate(noisy(Motion::orbit, seed, 0.2));
    std::mt19937_64 random(seed);
    std::normal_distribution<double> step_px(0, 2);
    std::vector<int> outliers;
    for (int j = 0; j < simulation.window.track_count(); ++j)
      if (random() % 3 == 0) outliers.push_back(j);
    std::vector<Vector2d> steps;
    for (int j = 0; j < simulation.window.track_count(); ++j)
      steps.emplace_back(step_px(random), step_px(random));
    move_away(simulation, outliers, [&](int j) { return steps[j]; });
    EXPECT_EQ(moving_objects(simulation.window, true_result(simulation)), std::vector<int>{});
  }
}

TEST(MovingObjects, AreNotPointsOffThePlane) {
  for (int seed = 1; seed <= 10; ++seed) {
    SimulationOptions options = noisy(Motion::orbit, seed, 0.5);
    options.off_plane = 0.4;
    const Simulation simulation = simulate(options);
    EXPECT_EQ(moving_objects(simulation.window, true_result(simulation)), std::vector<int>{});
  }
}

/// Scales the points around the principal point as a focal length that grows with time does.
void zoom(Window& window, double share) {
  const Vector2d center = window.K.topRightCorner<2, 1>();
  for (int i = 0; i < window.frame_count(); ++i) {
    const double scale = 1 + share * i / (window.frame_count() - 1.0);
    window.points_px[i] = (scale * (window.points_px[i].colwise() - center)).colwise() + center;
  }
}

void take_lens_as_exact(Window& window) {
  window.lens_moves_px = {window.points_px};
  for (auto& moves_px : window.lens_moves_px[0]) moves_px.setZero();
}

std::vector<Finding> findings_on_focal_length(const Window& window, const Initialization& result) {
  return check::changing_focal_length({.window = &window, .result = &result});
}

TEST(ChangingFocalLength, IsFoundInMostWindowsWithSidewaysAndUpDownMotion) {
  int windows = 0, found_in = 0;
  for (const Motion motion : {Motion::wander, Motion::up_down, Motion::arc})
    for (const std::uint64_t seed : {1, 2, 3, 4})
      for (const double share : {-0.01, 0.0, 0.01}) {
        SCOPED_TRACE(fmt::format("motion {}, seed {}, {}", int(motion), seed, share));
        Simulation simulation = simulate(noisy(motion, seed, 0.1));
        take_lens_as_exact(simulation.window);
        zoom(simulation.window, share);
        simulation.window.rotations = RotationModel::free;
        simulation = with_fitted_homographies(std::move(simulation));
        const Initialization result =
            initialize_gpo_joint(simulation.window, {.shutter = Shutter::global}, {});
        ASSERT_TRUE(result.ok) << result.reason;
        const auto change = focal_change(simulation.window, result);
        ASSERT_TRUE(change);
        EXPECT_NEAR(change->share, share, 4 * change->sigma_share);
        const auto found = findings_on_focal_length(simulation.window, result);
        if (share == 0) {
          EXPECT_TRUE(found.empty());
          continue;
        }
        ++windows;
        if (found.empty()) continue;
        ++found_in;
        EXPECT_EQ(found[0].level, Level::weak);
        EXPECT_TRUE(found[0].sentence.starts_with(
            fmt::format("the focal length changes by {}", share > 0 ? '+' : '-')));
      }
  EXPECT_GE(found_in, 0.75 * windows);
}

TEST(ChangingFocalLength, IsLessCertainWithATypicalLensAndAnEstimatedRowDelay) {
  Simulation simulation = simulate(noisy(Motion::wander, 1, 0.1));
  Window exact = simulation.window;
  take_lens_as_exact(exact);
  Initialization result = true_result(simulation);
  const double sigma = focal_change(exact, result)->sigma_share;
  EXPECT_GT(focal_change(simulation.window, result)->sigma_share, 1.05 * sigma);
  result.row_delay_s = 0;
  result.uncertainty = Uncertainty{.rotations = RotationModel::free};
  EXPECT_GT(focal_change(exact, result)->sigma_share, 1.05 * sigma);
}

TEST(ChangingFocalLength, IsUnknownWithoutAResult) {
  const Simulation simulation = simulate(noisy(Motion::orbit, 1));
  EXPECT_FALSE(focal_change(simulation.window, failed("no convergence")));
  EXPECT_TRUE(findings_on_focal_length(simulation.window, failed("no convergence")).empty());
}

}  // namespace
}  // namespace gpo::test
