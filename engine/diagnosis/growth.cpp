// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/growth.h"

#include "engine/diagnosis/window_evidence.h"
#include "engine/geometry/decompositions.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/uncertainty/information.h"
#include "engine/methods/uncertainty/uncertainty.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Largest change of the normal without a new linearization; the error is quadratic in it.
constexpr double kStale_rad = 2e-3;
constexpr double kStep_rad = 1e-6;    // step of a settled normal
constexpr double kAstray_deg = 5;     // largest angle between the warm start and the closed form
constexpr double kTauSettled = 1e-9;  // step of a settled translation [plane distances]
constexpr int kMostRounds = 20;

/// One frame's errors around a normal, with the best translation eliminated. Hessian and gradient
/// are over the three-dimensional normal, because its tangents change between linearizations.
struct LinearizedFrame {
  FrameObservations observations;
  Matrix3d translation_times_normal;
  Vector3d normal = Vector3d::Zero();  ///< linearization point; zero before the first one
  Vector3d tau = Vector3d::Zero();
  FrameNormals normals = {};
  Matrix3d hessian = Matrix3d::Zero();   ///< [px^2]
  Vector3d gradient = Vector3d::Zero();  ///< [px^2]
  SharedInformation information = {};
};

struct Growing {
  PlaneObservations camera;  ///< focal lengths only; `frames` has the observations
  std::vector<LinearizedFrame> frames;
  Vector3d normal;
  WindowEvidence evidence;
  int observations = 0;
};

/// Returns false if no translation has all points in front of the camera.
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

/// Returns the Gauss-Newton step of the normal over all linearized frames [rad].
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

/// Returns the closed form's normal with the sign closer to `like`.
Vector3d closed_form_normal(const Growing& growing, const Vector3d& like) {
  Matrix3d gram = Matrix3d::Zero();
  for (const LinearizedFrame& f : growing.frames)
    gram += f.translation_times_normal.transpose() * f.translation_times_normal;
  const Vector3d n = Eigen::SelfAdjointEigenSolver<Matrix3d>(gram).eigenvectors().col(2);
  return n.dot(like) < 0 ? Vector3d(-n) : n;
}

/// Iterates until every frame's linearization is close to the normal. Returns the number of
/// linearizations; nullopt if one failed.
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

/// Input of a step's verdict, with the standard deviation for independent noise.
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
  SharedInformation information =
      prior_information(window, {0, gyro_unknowns(window, window.rotations)}, sigma_px);
  for (const LinearizedFrame& f : growing.frames) information += f.information;
  return {growing.evidence, normal_sigma_deg(information, sigma_px), travel};
}

/// Errors beyond independent noise, the same at all lengths.
struct Beyond {
  double factor = 1;    ///< multiplies the noise, for correlated errors
  double lens_deg = 0;  ///< contribution of the lens
};

/// Compares the whole window's uncertainty, clustered by track, with that of independent noise. One
/// factor for all lengths: the clusters of a few frames are too noisy, and systematic errors of a
/// track exist from its first frame on.
Beyond beyond_noise(const Window& window, const Growing& growing, const Grounds& whole, Lens lens) {
  if (!whole.normal_sigma_deg) return {};
  PlaneMotion motion = motion_without_translation(window);
  motion.normal = growing.normal;
  for (std::size_t k = 0; k < growing.frames.size(); ++k) motion.tau[k + 1] = growing.frames[k].tau;
  // The bias is held here, whose error affects what looks like errors of neighbors and surfaces.
  const auto u = uncertainty_of(
      {window, plane_observations(window), motion}, window.rotations, Errors::of_noise);
  if (!u) return {};
  double flat_deg2 = u->normal_sigma_deg * u->normal_sigma_deg;
  double lens_deg2 = std::pow(normal_sigma_deg(*u, lens), 2) - flat_deg2;
  const double of_lens_deg2 = std::pow(u->lens_sigma_deg.value_or(0), 2);
  flat_deg2 -= of_lens_deg2;
  lens_deg2 += of_lens_deg2;
  const double flat_deg = std::sqrt(std::max(0.0, flat_deg2));
  return {std::max(1.0, flat_deg / *whole.normal_sigma_deg), std::sqrt(std::max(0.0, lens_deg2))};
}

}  // namespace

std::vector<GrowthStep> grow(const Window& window, Lens lens, const std::stop_token& stop) {
  std::vector<GrowthStep> steps;
  std::vector<Grounds> grounds;
  Growing growing{{window.K(0, 0), window.K(1, 1), {}}, {}, -Vector3d::UnitZ(), {}, 0};
  for (int i = 1; i < window.frame_count() && !stop.stop_requested(); ++i) {
    if (window.inlier_count(i) < kLeastInliers) return {};
    growing.frames.push_back({frame_observations(window, i), translation_times_normal(window, i)});
    growing.evidence.add(frame_errors(window, i));
    growing.observations += growing.frames.back().observations.count;
    const Vector3d closed = closed_form_normal(growing, growing.normal);
    if (i == 1 || angle_deg(closed, growing.normal) > kAstray_deg) growing.normal = closed;
    const auto linearized = settle(window, growing);
    if (!linearized) return {};
    grounds.push_back(grounds_of(window, growing));
    steps.push_back({i + 1, growing.normal, {}, *linearized});
  }
  if (steps.empty()) return steps;
  const Beyond beyond = beyond_noise(window, growing, grounds.back(), lens);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    auto sigma_deg = grounds[k].normal_sigma_deg;
    if (sigma_deg) sigma_deg = std::hypot(beyond.factor * *sigma_deg, beyond.lens_deg);
    steps[k].numbers = numbers_of(grounds[k].evidence, sigma_deg, grounds[k].travel);
  }
  return steps;
}

}  // namespace gpo
