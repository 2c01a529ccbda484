// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/plane_lens.h"

#include "engine/base/stop.h"
#include "engine/geometry/pose.h"
#include "tests/engine/largest.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::AllOf, testing::Gt, testing::Lt;

/// Images of points on z = 0 from about 1 m.
struct SimulatedViews {
  Camera camera = {640, 480, 560, 565, 325, 232, Distortion::radial_tangential, {0.05, -0.1}};
  int points = 150;
  int images = 30;
  double half_m = 1.5;        ///< half the side of the square with the points
  double slant_deg = 35;      ///< largest angle of the plane's normal to the optical axis
  double kept_tilt_deg = 0;   ///< slant that all images share
  double moves_m = 0.5;       ///< largest motion sideways
  double noise_px = 0.3;      ///< for each observation
  double track_noise_px = 0;  ///< the same in all images of a point
  double unevenness_m = 0;    ///< largest height of the plane's waves
  double readout = 0;         ///< see LensPrior [frame intervals]
  double outliers = 0;        ///< share of observations that are up to 20 px off
};

struct SimulatedScene {
  ObservedPlane plane;
  std::vector<Pose> poses;  ///< camera of each view
};

constexpr int kFramesAView = 4;

/// Smooth motion of a hand: harmonics of random amplitudes and phases, from -1 to 1.
class Wander {
 public:
  explicit Wander(std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int k = 0; k < 3; ++k) {
      amplitude_[k] = (0.4 + 0.6 * uniform(random)) / (k + 1.0);
      phase_[k] = 2 * std::numbers::pi * uniform(random);
      frequency_[k] = (k + 0.5 + uniform(random));
    }
  }
  double operator()(double t) const {
    double sum = 0, all = 0;
    for (int k = 0; k < 3; ++k) {
      sum += amplitude_[k] * std::sin(2 * std::numbers::pi * frequency_[k] * t + phase_[k]);
      all += amplitude_[k];
    }
    return sum / all;
  }

 private:
  double amplitude_[3], phase_[3], frequency_[3];
};

/// Adds waves about as long as an image is wide.
void raise(Eigen::Matrix3Xd& points, double most_m, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 2 * std::numbers::pi);
  for (int wave = 0; wave < 4; ++wave) {
    const double heading = uniform(random), phase = uniform(random);
    const double rate = 4 + wave;  // [rad / m]
    const Eigen::Vector2d along = rate * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    for (auto point : points.colwise())
      point.z() += most_m / 4 * std::sin(along.dot(point.head<2>()) + phase);
  }
}

/// Motion of a hand-held camera over the plane; time from 0 to 1.
struct Way {
  const SimulatedViews& options;
  std::mt19937_64& random;
  Wander slant_x{random}, slant_y{random}, roll{random}, x{random}, y{random}, z{random};

  /// Looks along +z from z < 0, with the shared tilt and slants of its own.
  Pose pose_at(double t) const {
    const double slant = radians(options.slant_deg);
    const Eigen::Matrix3d R_wc =
        so3_exp({radians(options.kept_tilt_deg) + slant * slant_x(t), slant * slant_y(t), 0}) *
        so3_exp({0, 0, 0.4 * roll(t)});
    const Eigen::Vector3d looked_at(options.moves_m * x(t), options.moves_m * y(t), 0);
    return {R_wc, looked_at - (1 + 0.3 * options.moves_m * z(t)) * R_wc.col(2)};
  }
  Eigen::Vector2d pixel_at(double t, const Eigen::Vector3d& point) const {
    return project(options.camera, to_camera(pose_at(t), point));
  }
  /// Position at the time of its row, which depends on the position.
  Eigen::Vector2d read_at(double t, const Eigen::Vector3d& point) const {
    Eigen::Vector2d px = pixel_at(t, point);
    for (int pass = 0; options.readout != 0 && pass < 3; ++pass) {
      const double later = options.readout * ((px.y() + 0.5) / options.camera.height - 0.5);
      px = pixel_at(t + later * frame_step(), point);
    }
    return px;
  }
  Eigen::Vector2d flow_at(double t, const Eigen::Vector3d& point) const {
    return 0.5 * (pixel_at(t + frame_step(), point) - pixel_at(t - frame_step(), point));
  }
  double frame_step() const { return 1.0 / (kFramesAView * options.images); }
};

SimulatedScene simulate_views(const SimulatedViews& options, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> normal(0, 1);
  const Camera& camera = options.camera;
  Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Zero(3, options.points);
  Eigen::Matrix2Xd offsets(2, options.points);
  for (int j = 0; j < options.points; ++j) {
    points.col(j).head<2>() << options.half_m * uniform(random), options.half_m * uniform(random);
    offsets.col(j) << options.track_noise_px * normal(random),
        options.track_noise_px * normal(random);
  }
  if (options.unevenness_m > 0) raise(points, options.unevenness_m, random);
  const Way way{options, random};
  SimulatedScene scene;
  scene.plane.points = options.points;
  for (int i = 0; i < options.images; ++i) {
    const double t = static_cast<double>(i) / options.images;
    const Pose pose = way.pose_at(t);
    PlaneView view{kFramesAView * i, {}, Eigen::Matrix2Xd(2, options.points)};
    for (int j = 0; j < options.points; ++j) {
      if (to_camera(pose, points.col(j)).z() < 0.05) continue;
      Eigen::Vector2d px = way.read_at(t, points.col(j));
      if (!px.allFinite()) continue;
      px += offsets.col(j) + options.noise_px * Eigen::Vector2d(normal(random), normal(random));
      if (uniform(random) > 1 - 2 * options.outliers)
        px += 20 * Eigen::Vector2d(uniform(random), uniform(random));
      if (px.minCoeff() < 0 || px.x() > camera.width - 1 || px.y() > camera.height - 1) continue;
      view.raw_px.col(std::ssize(view.points)) = px;
      view.flow_px.col(std::ssize(view.points)) = way.flow_at(t, points.col(j));
      view.points.push_back(j);
    }
    view.raw_px.conservativeResize(2, std::ssize(view.points));
    view.flow_px.conservativeResize(2, std::ssize(view.points));
    scene.plane.views.push_back(std::move(view));
    scene.poses.push_back(pose);
  }
  return scene;
}

/// The guess of a recording without a calibration.
Camera guess_of(const Camera& camera, double k1 = 0) {
  const int width = camera.width, height = camera.height;
  const double cx = 0.5 * (width - 1), cy = 0.5 * (height - 1), f = 0.9 * width;
  return {width, height, f, f, cx, cy, Distortion::radial_tangential, {k1, 0, 0, 0}};
}

PlaneLens lens_from(const ObservedPlane& plane,
                    ReadoutDirection direction = ReadoutDirection::down) {
  Camera guess = guess_of(SimulatedViews{}.camera);
  guess.readout_direction = direction;
  return lens_from_planes({plane}, {}, guess);
}

LensVector normalized_errors(const PlaneLens& found, const Camera& truth) {
  return (found.lens - lens_of(truth)).cwiseQuotient(found.sigma);
}

/// Rotations between the views by a gyroscope with an unknown bias.
GyroRotations rotations_of(const SimulatedScene& scene, const Eigen::Vector3d& bias_rad_s) {
  GyroRotations gyro;
  constexpr double kStep_s = 4.0 / 30;
  for (std::size_t i = 1; i < scene.poses.size(); ++i) {
    const Eigen::Matrix3d R = scene.poses[i - 1].R_wc.transpose() * scene.poses[i].R_wc;
    gyro.rotations.push_back({scene.plane.views[i - 1].frame,
                              scene.plane.views[i].frame,
                              R * so3_exp(kStep_s * -bias_rad_s),
                              kStep_s * Eigen::Matrix3d::Identity(),
                              2e-4});
  }
  return gyro;
}

/// A lens in units of the image width, and the guess of its distortion.
struct UnlikeLens {
  const char* name;
  double focal, aspect;
  double cx, cy;  ///< from the image center
  double k1, k2, k1_of_guess;
};

TEST(PlaneLens, EstimatesUnlikeLensesWithCorrectStandardDeviations) {
  const std::vector<UnlikeLens> lenses = {{"usual", 0.875, 1.005, 0.008, -0.01, 0.05, -0.1, 0},
                                          {"wide", 0.6, 1.002, 0.02, -0.015, -0.3, 0.08, -0.6},
                                          {"long", 1.4, 0.995, -0.03, 0.015, 0.1, -0.2, 0},
                                          {"off the middle", 1, 1, 0.03, 0.03, 0, 0, 0},
                                          {"bent", 0.8, 1, -0.01, 0.02, -0.15, 0.05, -0.2}};
  constexpr int kSeedsALens = 5;
  LensVector squares = LensVector::Zero();  // mean
  int within_three = 0;                     // sigma of f
  for (const UnlikeLens& lens : lenses)
    for (std::uint64_t seed = 1; seed <= kSeedsALens; ++seed) {
      const double fx = 640 * lens.focal, fy = fx * lens.aspect;
      const double cx = 319.5 + 640 * lens.cx, cy = 239.5 + 640 * lens.cy;
      const Camera camera{
          640, 480, fx, fy, cx, cy, Distortion::radial_tangential, {lens.k1, lens.k2, 5e-4, -4e-4}};
      const SimulatedViews options{.camera = camera,
                                   .points = 80,
                                   .images = 20,
                                   .half_m = 0.75 / lens.focal,
                                   .moves_m = 0.25 / lens.focal,
                                   .unevenness_m = 0.002,
                                   .outliers = 0.02};
      const auto found = lens_from_planes(
          {simulate_views(options, seed).plane}, {}, guess_of(camera, lens.k1_of_guess));
      EXPECT_TRUE(found.ok) << lens.name << " " << seed << ": " << found.reason;
      if (!found.ok) continue;
      const LensVector errors = normalized_errors(found, camera);
      squares += errors.cwiseAbs2() / kSeedsALens / static_cast<double>(lenses.size());
      within_three += std::abs(errors[0]) < 3 ? 1 : 0;
    }
  EXPECT_GE(within_three, 23);  // nine of ten
  // 99.9 % of a chi-square of 25 numbers; ten seeds a lens have a mean of 1.35.
  EXPECT_THAT(squares[0], AllOf(Gt(0.4), Lt(2.1)));
  for (int k = 1; k < 6; ++k) EXPECT_THAT(squares[k], AllOf(Gt(0.35), Lt(2.5))) << kLensNames[k];
}

TEST(PlaneLens, SeparatesRollingShutterFromDistortion) {
  double squares = 0, unknown_squares = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const SimulatedViews options{.points = 120, .images = 24, .half_m = 0.9, .readout = 0.7};
    auto scene = simulate_views(options, seed);
    LensVector truth = lens_of(options.camera);
    truth[kReadout] = options.readout;
    const auto found = lens_from(scene.plane);
    ASSERT_TRUE(found.ok) << found.reason;
    const LensVector errors = found.lens - truth;
    EXPECT_LT(test::largest(errors.cwiseQuotient(found.sigma)), 4) << seed;
    EXPECT_NEAR(found.lens[kReadout], options.readout, 0.02) << seed;
    squares += errors[0] * errors[0];
    const auto upward = lens_from(scene.plane, ReadoutDirection::up);
    EXPECT_NEAR(upward.lens[kReadout], -found.lens[kReadout], 1e-3);
    for (PlaneView& view : scene.plane.views) view.flow_px.setZero();
    const auto unknown = lens_from(scene.plane);
    unknown_squares += std::pow(unknown.lens[0] - truth[0], 2);
    EXPECT_TRUE(unknown.prior_only[kReadout]);
  }
  EXPECT_LT(squares, 0.05 * unknown_squares);
}

TEST(PlaneLens, EstimatesHeightsOfAnUnevenPlane) {
  // Waves of 4 mm, seen from 1 m, move points by a pixel as the camera moves around them.
  const SimulatedViews options{.images = 24, .half_m = 0.9, .unevenness_m = 0.004};
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto found = lens_from(simulate_views(options, seed).plane);
    ASSERT_TRUE(found.ok) << found.reason;
    EXPECT_LT(found.rms_px, 1.2 * std::numbers::sqrt2 * options.noise_px) << seed;
    EXPECT_LT(std::abs(normalized_errors(found, options.camera)[0]), 3.5) << seed;
  }
}

TEST(PlaneLens, WithoutFarAcceptsPlanesWithoutObservations) {
  const std::vector<ObservedPlane> planes{{3, {{0, {}, Eigen::Matrix2Xd(2, 0)}}}};
  std::vector<int> left_out;
  EXPECT_EQ(counts_of(without_far(planes, {{Eigen::VectorXd(0)}}, 1, left_out)).observations, 0);
  EXPECT_THAT(left_out, testing::IsEmpty());
}

TEST(PlaneLens, CountsTheErrorsOfAPointAsOne) {
  // Half a pixel that is the same in all images of a point hardly changes the residuals.
  double squares = 0, sigmas = 0;
  constexpr int kSeeds = 6;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const SimulatedViews options{.noise_px = 0.1, .track_noise_px = 0.6};
    const auto found = lens_from(simulate_views(options, seed).plane);
    ASSERT_TRUE(found.ok) << found.reason;
    squares += std::pow(normalized_errors(found, options.camera)[0], 2) / kSeeds;
    sigmas += found.sigma[0] / kSeeds;
  }
  EXPECT_LT(std::sqrt(squares), 1.8);
  EXPECT_LT(sigmas, 0.01);
}

TEST(PlaneLens, RefusesConstantTiltAndTooFewImagesAndReportsPriorOnlyParameters) {
  const auto found = lens_from(simulate_views({.slant_deg = 2}, 1).plane);
  EXPECT_FALSE(found.ok);
  EXPECT_THAT(found.reason, testing::HasSubstr("keeps its tilt to the plane"));
  EXPECT_LT(found.tilt_deg, 8);
  const auto few = lens_from(simulate_views({.points = 300, .images = 4}, 1).plane);
  EXPECT_FALSE(few.ok);
  EXPECT_EQ(few.reason, "a plane is seen in 4 images; at least 6 are needed");
  const auto vague = lens_from(simulate_views({.slant_deg = 1}, 2).plane);
  EXPECT_TRUE(vague.prior_only[0]) << vague.sigma.transpose();
  const auto determined = lens_from(simulate_views({}, 2).plane);
  EXPECT_FALSE(determined.prior_only[0]) << determined.sigma.transpose();
  EXPECT_FALSE(determined.prior_only[4]) << determined.sigma.transpose();
}

TEST(PlaneLens, AGyroscopeOfUnknownBiasReducesTheUncertaintyOfTheFocalLength) {
  const SimulatedViews options{.slant_deg = 3, .kept_tilt_deg = 30};
  double sigma_without = 0, sigma_with = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto scene = simulate_views(options, seed);
    const auto with = lens_from_planes(
        {scene.plane}, rotations_of(scene, {0.05, -0.03, 0.02}), guess_of(options.camera));
    ASSERT_TRUE(with.ok) << with.reason;
    sigma_without += lens_from(scene.plane).sigma[0];
    sigma_with += with.sigma[0];
    EXPECT_LT(std::abs(normalized_errors(with, options.camera)[0]), 3.5) << seed;
  }
  EXPECT_LT(sigma_with, 0.9 * sigma_without);
}

TEST(PlaneLens, SeveralPlanesShareTheLens) {
  const SimulatedViews options{.images = 12};
  std::vector<ObservedPlane> planes;
  for (const std::uint64_t seed : {1, 2, 3}) planes.push_back(simulate_views(options, seed).plane);
  const auto found = lens_from_planes(planes, {}, guess_of(options.camera));
  ASSERT_TRUE(found.ok) << found.reason;
  EXPECT_EQ(found.views, 36);
  EXPECT_LT(test::largest(normalized_errors(found, options.camera)), 4);
}

TEST(PlaneLens, LeavesOutImagesThatDisagreeAndEndsEarlyWhenStopped) {
  auto scene = simulate_views({}, 1);
  PlaneView& bad = scene.plane.views[11];
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 4);
  for (auto column : bad.raw_px.colwise()) column += Eigen::Vector2d(noise(random), noise(random));
  const auto found = lens_from(scene.plane);
  ASSERT_TRUE(found.ok) << found.reason;
  EXPECT_THAT(found.left_out, testing::ElementsAre(bad.frame));
  std::stop_source stop;
  stop.request_stop();
  const StopWatch watch{.stop = stop.get_token()};
  const StopScope scope(&watch);
  EXPECT_THROW(lens_from(simulate_views({}, 1).plane), Stopped);
}

}  // namespace
}  // namespace gpo
