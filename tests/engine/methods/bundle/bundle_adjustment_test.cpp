// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/bundle/bundle_adjustment.h"

#include "tests/engine/methods/method_cases.h"

#include <iterator>

#include <Eigen/LU>

namespace gpo::test {
namespace {

using Eigen::Matrix3Xd, Eigen::Vector3d;
using Observations = std::span<const Observation>;

std::vector<Observation> observations_of(const Simulation& truth, bool on_plane) {
  return track_observations(truth.window,
                            [&](int, int track) { return truth.on_plane[track] || !on_plane; });
}

Bundle perturbed_bundle(const Simulation& truth, std::uint64_t seed = 1) {
  const Initialization start = perturbed_truth(truth, {.seed = seed});
  return bundle_on_plane(
      truth.window.K, start.cameras, start.plane.normal, truth.window.points_px[0]);
}

/// Half the summed squares of pi(K X_c) - p, without the engine's Jacobians and parameters.
double cost(const Simulation& truth,
            const std::vector<Pose>& cameras,
            const Matrix3Xd& positions,
            Observations observations) {
  double sum = 0;
  for (const auto& [frame, point, pixel] : observations) {
    const Vector3d seen = truth.window.K * to_camera(cameras[frame], positions.col(point));
    sum += (seen.hnormalized() - pixel).squaredNorm();
  }
  return sum / 2;
}

Matrix3Xd positions_of(const Simulation& truth, const Bundle& bundle) {
  Matrix3Xd positions(3, bundle.points.cols());
  for (Eigen::Index j = 0; j < positions.cols(); ++j)
    positions.col(j) = position(truth.window.K, bundle.points.col(j));
  return positions;
}

double squared_cost(const Simulation& truth, const Bundle& bundle, Observations observations) {
  return cost(truth, bundle.cameras, positions_of(truth, bundle), observations);
}

std::vector<Observation> observations_of_point(int point, Observations observations) {
  std::vector<Observation> of_point;
  std::ranges::copy_if(observations, std::back_inserter(of_point), [&](const Observation& o) {
    return o.point == point;
  });
  return of_point;
}

/// Expects that a Newton step along a single unknown gains hardly anything [px^2]: g^2 / 2h, by
/// finite differences.
void expect_no_gain(const std::function<double(double)>& cost_at) {
  constexpr double kPerturbation = 1e-6;
  const double before = cost_at(-kPerturbation);
  const double here = cost_at(0);
  const double after = cost_at(kPerturbation);
  const double g = (after - before) / (2 * kPerturbation);
  const double h = (after - 2 * here + before) / (kPerturbation * kPerturbation);
  EXPECT_LT(g * g / (2 * h), 1e-5);
}

/// Expects no gain along the coordinates of the cameras' positions and rotations.
void expect_no_gain_of_cameras(const Simulation& truth,
                               const Bundle& bundle,
                               Observations observations) {
  const Matrix3Xd positions = positions_of(truth, bundle);
  for (std::size_t i = 1; i < bundle.cameras.size(); ++i)
    for (int k = 0; k < 6; ++k)
      expect_no_gain([&](double h) {
        std::vector<Pose> cameras = bundle.cameras;
        const Vector3d step = h * Vector3d::Unit(k % 3);
        if (k < 3)
          cameras[i].p_wc += step;
        else
          cameras[i].R_wc = so3_exp(step) * cameras[i].R_wc;
        return cost(truth, cameras, positions, observations);
      });
}

void expect_no_gain_of_points(const Simulation& truth,
                              const Bundle& bundle,
                              Observations observations) {
  Matrix3Xd positions = positions_of(truth, bundle);
  for (int j = 0; j < truth.window.track_count(); ++j) {
    const Vector3d here = positions.col(j);
    const auto of_point = observations_of_point(j, observations);
    for (int k = 0; k < 3; ++k)
      expect_no_gain([&](double h) {
        positions.col(j) = here + h * Vector3d::Unit(k);
        return cost(truth, bundle.cameras, positions, of_point);
      });
    positions.col(j) = here;
  }
}

/// Expects no gain along the reference pixels and rotations of the normal.
void expect_no_gain_on_plane(const Simulation& truth,
                             const Bundle& bundle,
                             Observations observations) {
  Bundle moving = bundle;
  const auto moved_cost = [&](Observations of) {
    const Bundle on_plane =
        bundle_on_plane(truth.window.K, moving.cameras, moving.normal, moving.points.topRows<2>());
    return squared_cost(truth, on_plane, of);
  };
  for (int k = 0; k < 2; ++k) {
    expect_no_gain([&](double h) {
      moving.normal = so3_exp(h * Vector3d::Unit(k)) * bundle.normal;
      return moved_cost(observations);
    });
    moving.normal = bundle.normal;
    for (int j = 0; j < truth.window.track_count(); ++j) {
      const auto of_point = observations_of_point(j, observations);
      if (of_point.empty()) continue;
      expect_no_gain([&](double h) {
        // A step of a radian or a plane distance corresponds to some hundred pixels.
        moving.points.col(j) = bundle.points.col(j) + 100 * h * Vector3d::Unit(k);
        return moved_cost(of_point);
      });
      moving.points.col(j) = bundle.points.col(j);
    }
  }
}

/// Returns the true cameras and points; inverse depths from the same window without noise.
Bundle true_bundle(const Simulation& truth, SimulationOptions options) {
  options.noise_px = 0;
  const Simulation exact = simulate(options);
  const Eigen::Matrix3d K_inverse = exact.window.K.inverse();
  Bundle bundle = perturbed_bundle(exact);
  bundle.cameras = truth.cameras;
  for (int j = 0; j < exact.window.track_count(); ++j) {
    Eigen::Vector2d sums = Eigen::Vector2d::Zero();
    for (int i = 1; i < exact.window.frame_count(); ++i) {
      const Eigen::Matrix3d R_cw = truth.cameras[i].R_wc.transpose();
      const Vector3d x_1 = K_inverse * exact.window.points_px[0].col(j).homogeneous();
      const Vector3d x_i = K_inverse * exact.window.points_px[i].col(j).homogeneous();
      const Vector3d of_center = x_i.cross(R_cw * truth.cameras[i].p_wc);
      sums += Eigen::Vector2d(of_center.dot(x_i.cross(R_cw * x_1)), of_center.squaredNorm());
    }
    bundle.points(2, j) = sums.x() / sums.y();
  }
  return bundle;
}

class BundleOnMotion : public testing::TestWithParam<Motion> {
 protected:
  static SimulationOptions options(std::uint64_t seed) {
    return {.motion = GetParam(), .frames = 12, .points = 80, .off_plane = 0.2, .seed = seed};
  }
};

TEST_P(BundleOnMotion, FindsSameMinimumFromAllStarts) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Simulation truth = simulate(options(seed));
    const Eigen::Matrix3d& K = truth.window.K;
    const auto observations = observations_of(truth, false);
    const Bundle start = perturbed_bundle(truth, seed);
    const Bundle exact = true_bundle(truth, options(seed));
    const AdjustedBundle result = adjust_bundle(K, start, observations, {}, {});
    ASSERT_EQ(result.solver.termination, Termination::convergence);
    EXPECT_LE(result.solver.final_cost, squared_cost(truth, exact, observations));
    EXPECT_NEAR(result.solver.final_cost, squared_cost(truth, result.bundle, observations), 1e-6);
    expect_no_gain_of_cameras(truth, result.bundle, observations);
    expect_no_gain_of_points(truth, result.bundle, observations);
    const AdjustedBundle from_truth = adjust_bundle(K, exact, observations, {}, {});
    EXPECT_NEAR(result.solver.final_cost, from_truth.solver.final_cost, 1e-5);
    // The scale is that of the start.
    EXPECT_LT(angle_deg(result.bundle.cameras.back().p_wc, from_truth.bundle.cameras.back().p_wc),
              0.01);
    EXPECT_LT(angle_deg(position(K, result.bundle.points.col(79)),
                        position(K, from_truth.bundle.points.col(79))),
              1e-3);
  }
}

TEST_P(BundleOnMotion, PlaneAdjustmentFindsMinimumNoWorseThanTruth) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Simulation truth = simulate(options(seed));
    const auto observations = observations_of(truth, true);
    const AdjustedBundle result = adjust_bundle(truth.window.K,
                                                perturbed_bundle(truth, seed),
                                                observations,
                                                {.normal = PlaneNormal::free},
                                                {});
    ASSERT_EQ(result.solver.termination, Termination::convergence);
    const Bundle exact = true_bundle(truth, options(seed));
    const Bundle& adjusted = result.bundle;
    EXPECT_LE(result.solver.final_cost, squared_cost(truth, exact, observations));
    EXPECT_NEAR(result.solver.final_cost, squared_cost(truth, adjusted, observations), 1e-6);
    expect_no_gain_of_cameras(truth, adjusted, observations);
    expect_no_gain_on_plane(truth, adjusted, observations);
  }
}

INSTANTIATE_TEST_SUITE_P(All, BundleOnMotion, testing::ValuesIn(kUsualMotions));

TEST(RobustBundle, DropsFewInliersAndNoneWithinExpectedError) {
  const Simulation truth = simulate({.motion = Motion::orbit, .frames = 12});
  const auto observations = observations_of(truth, true);
  const Bundle start = perturbed_bundle(truth);
  const AdjustedBundle strict =
      adjust_bundle_robustly(truth.window.K, start, observations, 0.3, {});
  EXPECT_GT(strict.kept.size(), 0.95 * observations.size());
  EXPECT_LT(strict.kept.size(), observations.size());
  const AdjustedBundle lenient = adjust_bundle_robustly(truth.window.K, start, observations, 2, {});
  EXPECT_EQ(lenient.kept.size(), observations.size());
}

}  // namespace
}  // namespace gpo::test
