// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/orientations.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/plane/plane_result.h"
#include "engine/methods/plane/rolling_shutter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::ArrayXd;
using Eigen::Matrix2d;
using Eigen::Matrix3d;

/// Least preference that decides between two solutions. In 400 simulated ambiguous windows of `gpo`
/// and `gpo_joint` (straight and nearly straight paths of 4 to 30 % of the distance, noise 0.15 and
/// 0.5 px, with and without noise in the reference frame) a wrong solution was preferred by at most
/// 3.4, with a focal length 0.3 % off by 4.5; with 10 to 20 % of 300 tracks off the plane the right
/// one was by 5.5 to 8.4.
constexpr double kDecides = 5;
/// Solutions nearer than this, or than two standard deviations of the normal, are one.
constexpr double kOne_deg = 0.1;
constexpr double kOne_sigmas = 2;

RefusedSolution solution_of(const Initialization& result) { return {result.plane, result.cameras}; }

/// The squared residuals of an inlier of the main plane.
struct PlaneResiduals {
  double squares = 0;                  // sum over distances from transferred positions
  Matrix2d normal = Matrix2d::Zero();  // for the error of the position in the reference
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  // frame, which all frames share
  int count = 0;

  void add(const Matrix3d& H_i1, const Eigen::Vector2d& first, const Eigen::Vector2d& seen) {
    const Eigen::Vector3d y = H_i1 * first.homogeneous();
    const Eigen::Vector2d pixel = y.hnormalized();
    const Matrix2d J = (H_i1.topLeftCorner<2, 2>() - pixel * H_i1.row(2).head<2>()) / y.z();
    squares += (pixel - seen).squaredNorm();
    normal += J.transpose() * J;
    gradient += J.transpose() * (pixel - seen);
    ++count;
  }
  /// Returns their sum, with the best position in the reference frame if that one has noise, too.
  double sum(bool exact_reference) const {
    if (exact_reference) return squares;
    return squares - gradient.dot((normal + Matrix2d::Identity()).inverse() * gradient);
  }
};

/// Returns each track's summed squared residuals, limited to the squared threshold each [px^2].
ArrayXd squared_residuals(const Window& window, const RefusedSolution& solution) {
  const double most = window.threshold_px * window.threshold_px;
  const Matrix3d K_inverse = window.K.inverse();
  const Eigen::Matrix2Xd& first = window.points_px.front();
  RayPairs rays{.i = K_inverse * first.colwise().homogeneous(), .j = {}, .group = {}};
  ArrayXd sums = ArrayXd::Zero(window.track_count());
  std::vector<PlaneResiduals> on_plane(window.track_count());
  for (int i = 1; i < window.frame_count(); ++i) {
    const Pose& camera = solution.cameras[i];
    const Eigen::Matrix2Xd& seen = window.points_px[i];
    rays.j = K_inverse * seen.colwise().homogeneous();
    const ArrayXd epipolar = window.K(0, 0) * window.K(0, 0) *
                             squared_sampson_distances(skew(camera.p_wc) * camera.R_wc, rays);
    const Matrix3d H_i1 = homography_of(window, camera, solution.plane);
    for (int k = 0; k < window.track_count(); ++k) {
      if (!seen.col(k).allFinite() || !first.col(k).allFinite()) continue;
      if (window.inlier[i][k])
        on_plane[k].add(H_i1, first.col(k), seen.col(k));
      else
        sums[k] += epipolar[k] < most ? epipolar[k] : most;
    }
  }
  for (int k = 0; k < window.track_count(); ++k) {
    const double sum = on_plane[k].sum(window.exact_reference), limit = on_plane[k].count * most;
    sums[k] += sum < limit ? sum : limit;
  }
  return sums;
}

double rotation_apart_deg(std::span<const Matrix3d> R_wc, std::span<const Pose> cameras) {
  double sum = 0;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    sum += degrees(so3_log(R_wc[i].transpose() * cameras[i].R_wc).norm());
  return sum;
}

/// Judges a result by the solutions that were not chosen.
void compare(const Window& window,
             std::span<const RefusedSolution> others,
             Initialization& result) {
  Ambiguity& ambiguity = *result.ambiguity;
  const RefusedSolution chosen = solution_of(result);
  const double sigma_deg = result.uncertainty ? result.uncertainty->normal_sigma_deg : 0;
  const double one_deg = std::max(kOne_deg, kOne_sigmas * sigma_deg);
  const Window seen = as_seen_at_time_stamps(window, result);
  for (const RefusedSolution& other : others) {
    const double apart_deg = angle_deg(other.plane.normal, chosen.plane.normal);
    if (apart_deg <= one_deg) continue;
    const double sigmas = preference_sigmas(seen, chosen, other);
    // A wrong focal length may fit the wrong solution better.
    const bool decides = sigmas >= kDecides && !window.camera_is_guess;
    if (!ambiguity.rejected || sigmas < ambiguity.rejected->sigmas)
      ambiguity.rejected = {apart_deg, sigmas};
    if (!decides) ambiguity.undecided = {chosen, other};
  }
}

}  // namespace

double preference_sigmas(const Window& window, const RefusedSolution& a, const RefusedSolution& b) {
  const ArrayXd differences = squared_residuals(window, b) - squared_residuals(window, a);
  const double sum = differences.sum();
  const double by_tracks =
      differences.square().sum() - sum * sum / static_cast<double>(differences.size());
  // Both solutions have six unknowns in a frame, whose homography has eight: up to two of them
  // explain different parts of the noise, each with the variance 4 sigma^4 of its sum of squares.
  const double noise_px2 = std::pow(homography_error_px(window) / kMedianOfRayleigh, 2);
  const double by_unknowns = 8.0 * (window.frame_count() - 1) * noise_px2 * noise_px2;
  const double variance = by_tracks + by_unknowns;
  return variance > 0 ? sum / std::sqrt(variance) : 0;
}

MethodRun run_from_both(Window window,
                        const Rotations& rotations,
                        const std::function<Initialization(const Window&)>& run) {
  Initialization chosen = run(window);
  Window turned = window;
  turned.R_wc = rotations.R_wc_other;
  Initialization other = chosen.stopped ? chosen : run(turned);
  if (other.stopped) return {std::move(window), std::move(other)};
  const bool prefers_other =
      other.ok &&
      (!chosen.ok || preference_sigmas(window, solution_of(other), solution_of(chosen)) > 0);
  if (prefers_other) std::swap(chosen, other);
  chosen.ambiguity = {.apart_deg = rotations.orientations_apart_deg};
  if (!other.ok) chosen.ambiguity->failure = other.reason;
  if (!chosen.ok) return {std::move(window), std::move(chosen)};
  std::vector<RefusedSolution> others;
  if (other.ok) others.push_back(solution_of(other));
  if (chosen.other_minimum) others.push_back(*chosen.other_minimum);
  const bool is_turned = rotation_apart_deg(turned.R_wc, chosen.cameras) <
                         rotation_apart_deg(window.R_wc, chosen.cameras);
  Window& of_result = is_turned ? turned : window;
  compare(of_result, others, chosen);
  return {std::move(of_result), std::move(chosen)};
}

}  // namespace gpo
