// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/growth.h"

#include "engine/geometry/decompositions.h"
#include "engine/methods/certainty/shared_information.h"
#include "engine/methods/certainty/uncertainty.h"
#include "engine/methods/certainty/window_evidence.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/plane/closed_form_motion.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/window/frame_errors.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// A normal that moved farther calls for linearizing again; the quadratic errs by the square of it.
constexpr double kStale_rad = 2e-3;
constexpr double kStep_rad = 1e-6;    // and the normal is settled
constexpr double kAstray_deg = 5;     // from the closed form: the warm start is given up
constexpr double kTauSettled = 1e-9;  // length of a step [plane distances]
constexpr int kMostRounds = 20;

/// One frame's errors around a normal, its translation the best one for it and eliminated. Over the
/// normal in space: its tangents change from one linearization to the next, these axes do not.
struct LinearizedFrame {
  FrameObservations observations;
  Matrix3d translation_times_normal;
  Vector3d normal = Vector3d::Zero();  ///< where it was linearized; zero: nowhere yet
  Vector3d tau = Vector3d::Zero();
  FrameNormals normals = {};
  Matrix3d hessian = Matrix3d::Zero();   ///< [px^2]
  Vector3d gradient = Vector3d::Zero();  ///< [px^2]
  SharedInformation information = {};
};

struct Growing {
  PlaneObservations camera;  ///< its focal lengths; the frames keep their own observations
  std::vector<LinearizedFrame> frames;
  Vector3d normal;
  WindowEvidence evidence;
  int observations = 0;
};

/// False where no translation brings all points before the camera.
bool linearize(const Window& window,
               int frame,
               const Growing& growing,
               const Vector3d& normal,
               LinearizedFrame& f) {
  const Matrix3d& R_wc = window.R_wc[frame];
  PlaneMotion motion{
      .normal = normal, .tau = {f.translation_times_normal * normal}, .R_wc = {R_wc}};
  for (int round = 0; round < kMostRounds; ++round) {
    f.normals =
        frame_normals(f.observations, frame_state(growing.camera, motion, 0), Rotating::yes);
    if (!f.normals.in_front) return false;
    const Vector3d step =
        -solve_symmetric(f.normals.JtJ.bottomRightCorner<3, 3>(), f.normals.Jtr.tail<3>());
    if (!(step.norm() > kTauSettled)) break;
    motion.tau[0] += R_wc * step;
  }
  const Eigen::Matrix<double, 3, 2> N = normal_tangents(normal);
  const Eigen::Matrix2d reduced = frame_information(window, frame, f.normals, RotationModel::known);
  f.normal = normal;
  f.tau = motion.tau[0];
  f.hessian = N * reduced * N.transpose();
  f.gradient = N * f.normals.Jtr.head<2>();
  f.information = frame_information(window, frame, f.normals, window.rotations);
  return true;
}

/// The step of the normal that all linearized frames together ask for [rad].
Eigen::Vector2d normal_step(const Growing& growing) {
  Matrix3d hessian = Matrix3d::Zero();
  Vector3d gradient = Vector3d::Zero();
  for (const LinearizedFrame& f : growing.frames) {
    hessian += f.hessian;
    gradient += f.gradient + f.hessian * (growing.normal - f.normal);
  }
  const Eigen::Matrix<double, 3, 2> N = normal_tangents(growing.normal);
  return -solve_symmetric(N.transpose() * hessian * N, N.transpose() * gradient);
}

/// The closed form's, with the sign nearest to `like`.
Vector3d closed_form_normal(const Growing& growing, const Vector3d& like) {
  Matrix3d gram = Matrix3d::Zero();
  for (const LinearizedFrame& f : growing.frames)
    gram += f.translation_times_normal.transpose() * f.translation_times_normal;
  const Vector3d n = Eigen::SelfAdjointEigenSolver<Matrix3d>(gram).eigenvectors().col(2);
  return n.dot(like) < 0 ? Vector3d(-n) : n;
}

/// Moves the normal until every frame is linearized near enough; how many were, or nothing where a
/// frame cannot be.
std::optional<int> settle(const Window& window, Growing& growing) {
  int linearized = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    for (std::size_t k = 0; k < growing.frames.size(); ++k) {
      LinearizedFrame& f = growing.frames[k];
      if ((f.normal - growing.normal).norm() < kStale_rad) continue;
      const int frame = static_cast<int>(k) + 1;
      if (!linearize(window, frame, growing, growing.normal, f)) return std::nullopt;
      ++linearized;
    }
    const Eigen::Vector2d step = normal_step(growing);
    if (!step.allFinite()) return std::nullopt;
    growing.normal = moved_normal(growing.normal, step);
    if (step.norm() < kStep_rad) break;
  }
  return linearized;
}

/// What a step's verdict rests on, its standard deviation as independent noise would have it.
struct Grounds {
  WindowEvidence evidence;
  std::optional<double> normal_sigma_deg;
  double travel = 0;  ///< largest |tau| [plane distance]
};

Grounds grounds_of(const Window& window, const Growing& growing) {
  double cost = 0;
  double travel = 0;
  for (const LinearizedFrame& f : growing.frames) {
    cost += f.normals.cost;
    travel = std::max(travel, f.tau.norm());
  }
  const int unknowns = 3 * static_cast<int>(growing.frames.size()) + 2;
  const double sigma_px = noise_px(2 * cost, 2 * growing.observations, unknowns);
  SharedInformation information = prior_information(window, window.rotations, sigma_px);
  for (const LinearizedFrame& f : growing.frames) information += f.information;
  return {growing.evidence, normal_sigma_deg(information, sigma_px), travel};
}

/// By how much the whole window's uncertainty, clustered by track, exceeds that of independent
/// noise. One factor for all lengths: the clusters of a few frames tell nothing, but what is wrong
/// with a track is wrong from its first frame on.
double over_independent_noise(const Window& window, const Growing& growing, const Grounds& whole) {
  if (!whole.normal_sigma_deg) return 1;
  PlaneMotion motion = resting(window);
  motion.normal = growing.normal;
  for (std::size_t k = 0; k < growing.frames.size(); ++k) motion.tau[k + 1] = growing.frames[k].tau;
  const auto u = uncertainty_of(window, plane_observations(window), motion, window.rotations);
  if (!u) return 1;
  // Not what bends, nor what neighbors share: with a bias that is held here everything does.
  double flat_deg2 = u->normal_sigma_deg * u->normal_sigma_deg;
  for (const auto& part_deg : {u->bend_sigma_deg, u->neighbors_sigma_deg})
    flat_deg2 -= part_deg.value_or(0) * part_deg.value_or(0);
  const double flat_deg = std::sqrt(std::max(0.0, flat_deg2));
  return std::max(1.0, flat_deg / *whole.normal_sigma_deg);
}

}  // namespace

std::vector<GrowthStep> grow(const Window& window, const std::stop_token& stop) {
  std::vector<GrowthStep> steps;
  std::vector<Grounds> grounds;
  Growing growing{{window.K(0, 0), window.K(1, 1), {}}, {}, -Vector3d::UnitZ(), {}, 0};
  const std::vector<FrameErrors> errors = frame_errors(window);
  for (int i = 1; i < window.frame_count() && !stop.stop_requested(); ++i) {
    if (window.inlier_count(i) < kLeastInliers) return {};
    growing.frames.push_back({frame_observations(window, i), translation_times_normal(window, i)});
    growing.evidence.add(errors[i]);
    growing.observations += growing.frames.back().observations.count;
    const Vector3d closed = closed_form_normal(growing, growing.normal);
    if (i == 1 || angle_deg(closed, growing.normal) > kAstray_deg) growing.normal = closed;
    const auto linearized = settle(window, growing);
    if (!linearized) return {};
    grounds.push_back(grounds_of(window, growing));
    steps.push_back({i + 1, growing.normal, {}, *linearized});
  }
  if (steps.empty()) return steps;
  const double factor = over_independent_noise(window, growing, grounds.back());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    auto sigma_deg = grounds[k].normal_sigma_deg;
    if (sigma_deg) *sigma_deg *= factor;
    steps[k].verdict = judged(grounds[k].evidence, sigma_deg, grounds[k].travel);
  }
  return steps;
}

}  // namespace gpo
