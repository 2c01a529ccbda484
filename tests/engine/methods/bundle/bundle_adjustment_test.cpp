// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/bundle/bundle_adjustment.h"

#include "tests/engine/methods/method_cases.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <functional>
#include <iterator>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector3d;
using test::Motion;
using test::perturbed_truth;
using test::simulate;
using test::Simulation;

constexpr double kPerturbation = 1e-6;

std::vector<Observation> observations_of(const Simulation& truth, bool on_plane) {
  std::vector<Observation> observations;
  for (int i = 0; i < truth.window.frame_count(); ++i) {
    for (int j = 0; j < truth.window.track_count(); ++j) {
      if (truth.on_plane[j] || !on_plane)
        observations.push_back({i, j, truth.window.points_px[i].col(j)});
    }
  }
  return observations;
}

PlaneBundle plane_bundle(const Simulation& truth, const Initialization& start) {
  return {start.cameras, start.plane.normal, truth.window.points_px[0]};
}

/// Written without the engine's Jacobians and parameters: half the summed squares of pi(K X_c) - p.
double cost(const Simulation& truth,
            const std::vector<Pose>& cameras,
            const Eigen::Matrix3Xd& positions,
            std::span<const Observation> observations) {
  double sum = 0;
  for (const auto& [frame, point, pixel] : observations) {
    const Vector3d seen = truth.window.K * to_camera(cameras[frame], positions.col(point));
    sum += (seen.hnormalized() - pixel).squaredNorm();
  }
  return sum / 2;
}

Eigen::Matrix3Xd positions_of(const Simulation& truth, const Bundle& bundle) {
  Eigen::Matrix3Xd positions(3, bundle.points.cols());
  for (Eigen::Index j = 0; j < positions.cols(); ++j)
    positions.col(j) = position(truth.window.K, bundle.points.col(j));
  return positions;
}

double squared_cost(const Simulation& truth,
                    const Bundle& bundle,
                    std::span<const Observation> observations) {
  return cost(truth, bundle.cameras, positions_of(truth, bundle), observations);
}

std::vector<Observation> seen_of(int point, std::span<const Observation> observations) {
  std::vector<Observation> of_point;
  std::ranges::copy_if(observations, std::back_inserter(of_point), [&](const Observation& o) {
    return o.point == point;
  });
  return of_point;
}

/// What one Newton step along a single unknown would still gain [px^2]: g^2 / 2h, by differences.
double gain_left(const std::function<double(double)>& cost_at) {
  const double before = cost_at(-kPerturbation);
  const double here = cost_at(0);
  const double after = cost_at(kPerturbation);
  const double g = (after - before) / (2 * kPerturbation);
  const double h = (after - 2 * here + before) / (kPerturbation * kPerturbation);
  return g * g / (2 * h);
}

/// The largest gain along any coordinate of a position or a rotation of a camera.
double largest_gain_of_cameras(const Simulation& truth,
                               const Bundle& bundle,
                               std::span<const Observation> observations) {
  const Eigen::Matrix3Xd positions = positions_of(truth, bundle);
  double largest = 0;
  for (std::size_t i = 1; i < bundle.cameras.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      std::vector<Pose> cameras = bundle.cameras;
      const auto moved = [&](double h) {
        cameras[i].p_wc = bundle.cameras[i].p_wc + h * Vector3d::Unit(k);
        return cost(truth, cameras, positions, observations);
      };
      largest = std::max(largest, gain_left(moved));
      cameras = bundle.cameras;
      const auto turned = [&](double h) {
        cameras[i].R_wc = so3_exp(h * Vector3d::Unit(k)) * bundle.cameras[i].R_wc;
        return cost(truth, cameras, positions, observations);
      };
      largest = std::max(largest, gain_left(turned));
    }
  }
  return largest;
}

double largest_gain_of_points(const Simulation& truth,
                              const Bundle& bundle,
                              std::span<const Observation> observations) {
  Eigen::Matrix3Xd positions = positions_of(truth, bundle);
  double largest = 0;
  for (int j = 0; j < truth.window.track_count(); ++j) {
    const Vector3d here = positions.col(j);
    const auto of_point = seen_of(j, observations);
    for (int k = 0; k < 3; ++k) {
      const auto moved = [&](double h) {
        positions.col(j) = here + h * Vector3d::Unit(k);
        return cost(truth, bundle.cameras, positions, of_point);
      };
      largest = std::max(largest, gain_left(moved));
    }
    positions.col(j) = here;
  }
  return largest;
}

/// The largest gain along a reference pixel, or by turning the normal with the points on it.
double largest_gain_on_plane(const Simulation& truth,
                             const PlaneBundle& bundle,
                             std::span<const Observation> observations) {
  double largest = 0;
  PlaneBundle moving = bundle;
  for (int k = 0; k < 2; ++k) {
    const Vector3d axis = Vector3d::Unit(k);
    const auto turned = [&](double h) {
      moving.normal = so3_exp(h * axis) * bundle.normal;
      return squared_cost(truth, free_bundle(truth.window.K, moving), observations);
    };
    largest = std::max(largest, gain_left(turned));
    moving.normal = bundle.normal;
    for (int j = 0; j < truth.window.track_count(); ++j) {
      const auto of_point = seen_of(j, observations);
      if (of_point.empty()) continue;
      const auto moved = [&](double h) {
        // A step of a radian or a plane distance is some hundred pixels.
        moving.pixels_1.col(j) = bundle.pixels_1.col(j) + 100 * h * Eigen::Vector2d::Unit(k);
        return squared_cost(truth, free_bundle(truth.window.K, moving), of_point);
      };
      largest = std::max(largest, gain_left(moved));
      moving.pixels_1.col(j) = bundle.pixels_1.col(j);
    }
  }
  return largest;
}

/// The true cameras and points; inverse depths from the same window without noise.
Bundle true_bundle(const Simulation& truth, test::SimulationOptions options) {
  options.noise_px = 0;
  const Simulation exact = simulate(options);
  const Eigen::Matrix3d K_inverse = exact.window.K.inverse();
  Bundle bundle = free_bundle(exact.window.K, plane_bundle(exact, perturbed_truth(exact)));
  bundle.cameras = truth.cameras;
  for (int j = 0; j < exact.window.track_count(); ++j) {
    Eigen::Vector2d sums = Eigen::Vector2d::Zero();
    for (int i = 1; i < exact.window.frame_count(); ++i) {
      const Vector3d x_1 = K_inverse * exact.window.points_px[0].col(j).homogeneous();
      const Vector3d x_i = K_inverse * exact.window.points_px[i].col(j).homogeneous();
      const Vector3d of_ray = x_i.cross(truth.cameras[i].R_wc.transpose() * x_1);
      const Vector3d of_center =
          x_i.cross(truth.cameras[i].R_wc.transpose() * truth.cameras[i].p_wc);
      sums += Eigen::Vector2d(of_center.dot(of_ray), of_center.squaredNorm());
    }
    bundle.points(2, j) = sums.x() / sums.y();
  }
  return bundle;
}

class BundleOnMotion : public ::testing::TestWithParam<Motion> {
 protected:
  static test::SimulationOptions options(std::uint64_t seed) {
    return {.motion = GetParam(), .frames = 12, .points = 80, .off_plane = 0.2, .seed = seed};
  }
};

TEST_P(BundleOnMotion, EndsAtAMinimumThatIsNoWorseThanTheTruth) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Simulation truth = simulate(options(seed));
    const auto observations = observations_of(truth, false);
    const Bundle start =
        free_bundle(truth.window.K, plane_bundle(truth, perturbed_truth(truth, {.seed = seed})));
    const AdjustedBundle result = adjust_bundle(truth.window.K, start, observations, {}, {});
    ASSERT_EQ(result.solver.termination, Termination::convergence);
    const Bundle exact = true_bundle(truth, options(seed));
    EXPECT_LE(result.solver.final_cost, squared_cost(truth, exact, observations));
    EXPECT_NEAR(result.solver.final_cost, squared_cost(truth, result.bundle, observations), 1e-6);
    EXPECT_LT(largest_gain_of_cameras(truth, result.bundle, observations), 1e-5);
    EXPECT_LT(largest_gain_of_points(truth, result.bundle, observations), 1e-5);
  }
}

TEST_P(BundleOnMotion, PerturbedStartsReturnToTheSameMinimum) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Simulation truth = simulate(options(seed));
    const auto observations = observations_of(truth, false);
    const AdjustedBundle from_truth =
        adjust_bundle(truth.window.K, true_bundle(truth, options(seed)), observations, {}, {});
    const Bundle start =
        free_bundle(truth.window.K, plane_bundle(truth, perturbed_truth(truth, {.seed = seed})));
    const AdjustedBundle result = adjust_bundle(truth.window.K, start, observations, {}, {});
    EXPECT_NEAR(result.solver.final_cost, from_truth.solver.final_cost, 1e-5);
    // The scale is that of the start; the shape is what was measured.
    const Vector3d p = result.bundle.cameras.back().p_wc;
    EXPECT_LT(angle_deg(p, from_truth.bundle.cameras.back().p_wc), 0.01);
    EXPECT_LT(angle_deg(position(truth.window.K, result.bundle.points.col(79)),
                        position(truth.window.K, from_truth.bundle.points.col(79))),
              1e-3);
  }
}

TEST_P(BundleOnMotion, ResidualAndGradientAreZeroAtTheTruthOfANoiseFreeWindow) {
  test::SimulationOptions noise_free = options(1);
  noise_free.noise_px = 0;
  const Simulation truth = simulate(noise_free);
  const Bundle exact = true_bundle(truth, noise_free);
  const auto observations = observations_of(truth, false);
  for (const double error : reprojection_errors_px(truth.window.K, exact, observations))
    EXPECT_LT(error, 1e-9);
  const AdjustedBundle result = adjust_bundle(truth.window.K, exact, observations, {}, {});
  EXPECT_EQ(result.solver.termination, Termination::convergence);
  EXPECT_LT(result.solver.final_cost, 1e-16);
}

TEST_P(BundleOnMotion, PlaneAdjustmentEndsAtAMinimumThatIsNoWorseThanTheTruth) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Simulation truth = simulate(options(seed));
    const auto observations = observations_of(truth, true);
    const PlaneBundle start = plane_bundle(truth, perturbed_truth(truth, {.seed = seed}));
    const AdjustedPlaneBundle result =
        adjust_plane_bundle(truth.window.K, start, observations, PlaneNormal::free, {});
    ASSERT_EQ(result.solver.termination, Termination::convergence);
    const Bundle exact = true_bundle(truth, options(seed));
    const Bundle adjusted = free_bundle(truth.window.K, result.bundle);
    EXPECT_LE(result.solver.final_cost, squared_cost(truth, exact, observations));
    EXPECT_NEAR(result.solver.final_cost, squared_cost(truth, adjusted, observations), 1e-6);
    EXPECT_LT(largest_gain_of_cameras(truth, adjusted, observations), 1e-5);
    EXPECT_LT(largest_gain_on_plane(truth, result.bundle, observations), 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All,
    BundleOnMotion,
    ::testing::Values(Motion::sideways, Motion::orbit, Motion::approach, Motion::wander));

TEST(RobustBundle, DropsAGoodObservationInAHundredAndNoneWithinTheExpectedError) {
  const Simulation truth = simulate({.motion = Motion::orbit, .frames = 12});
  const auto observations = observations_of(truth, true);
  const Bundle start = free_bundle(truth.window.K, plane_bundle(truth, perturbed_truth(truth)));
  const RobustBundle strict = adjust_bundle_robustly(truth.window.K, start, observations, 0.3, {});
  EXPECT_GT(strict.kept.size(), 0.95 * observations.size());
  EXPECT_LT(strict.kept.size(), observations.size());
  const RobustBundle lenient = adjust_bundle_robustly(truth.window.K, start, observations, 2, {});
  EXPECT_EQ(lenient.kept.size(), observations.size());
}

}  // namespace
}  // namespace gpo
