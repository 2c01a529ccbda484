// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/linear_solutions.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/homography.h"
#include "engine/geometry/plane.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Returns the middle singular value from the characteristic polynomial of M^T M: faster than an
/// SVD, and accurate enough for a start.
double middle_singular_value(const Matrix3d& M) {
  Eigen::SelfAdjointEigenSolver<Matrix3d> eigen;
  eigen.computeDirect(M.transpose() * M, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()(1)));
}

constexpr int kRounds = 3;
/// Least ratio of the smallest to the largest eigenvalue of the normal matrix; below it the
/// cameras' motion does not determine a plane.
constexpr double kLeastCondition = 1e-9;

/// Normal equations over m, weighted to pixels by the depths for a previous m.
struct LinearSystem {
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  int in_front = 0;
  int behind = 0;
};

LinearSystem system_at(const Window& window,
                       const PlaneMotion& motion,
                       int plane,
                       const Vector3d& m) {
  const Matrix3d K_inverse = window.K.inverse();
  LinearSystem system;
  for (int i = 1; i < window.frame_count(); ++i) {
    const Matrix3d R_cw = motion.R_wc[i].transpose();
    const Vector3d tau_c = R_cw * motion.tau[i];
    for (const int j : window.planes[plane].tracks) {
      if (!window.planes[plane].inlier[i][j]) continue;
      const Vector3d ray_1 = K_inverse * window.points_px[0].col(j).homogeneous();
      const Vector3d seen = K_inverse * window.points_px[i].col(j).homogeneous();
      const Vector3d turned = R_cw * ray_1;
      const double depth = (turned - tau_c * m.dot(ray_1)).z();
      (depth > 0 && m.dot(ray_1) <= 0 ? system.in_front : system.behind) += 1;
      const double weight = 1 / std::max(depth * depth, 1e-6);
      // Two rows of [x_i]x: image error times depth.
      for (int row = 0; row < 2; ++row) {
        const double slope = tau_c(row) - seen(row) * tau_c.z();
        const double right = turned(row) - seen(row) * turned.z();
        system.A += weight * slope * slope * ray_1 * ray_1.transpose();
        system.b += weight * slope * right * ray_1;
      }
    }
  }
  return system;
}

std::optional<Vector3d> plane_from_cameras(const Window& window,
                                           const PlaneMotion& motion,
                                           int plane) {
  Vector3d m = Vector3d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    const LinearSystem system = system_at(window, motion, plane, m);
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(system.A);
    if (!(eigen.eigenvalues()(0) > kLeastCondition * eigen.eigenvalues()(2))) return std::nullopt;
    m = eigen.eigenvectors() *
        (eigen.eigenvectors().transpose() * system.b).cwiseQuotient(eigen.eigenvalues());
    if (!m.allFinite()) return std::nullopt;
  }
  const LinearSystem last = system_at(window, motion, plane, m);
  return last.behind * 10 > last.in_front ? std::nullopt : std::optional(m);
}

/// Twins with a smaller angle between their normals count as one.
constexpr double kLeastTwin_deg = 3;
/// Largest angle between the twin's normal and a frame's decomposition.
constexpr double kMostFromTwin_deg = 20;

std::vector<HomographyMotion> feasible_decompositions(const Window& window, int frame) {
  const Eigen::Matrix3d& H = window.H_i1[frame];
  if (!H.allFinite()) return {};
  return decompose_homography(
      H, window.K, window.points_px[0](Eigen::all, window.inlier_tracks(frame)));
}

}  // namespace

Matrix3d translation_times_normal(const Window& window, int frame) {
  const Matrix3d H = window.R_wc[frame] * window.K.inverse() * window.H_i1[frame] * window.K;
  const double lambda = std::copysign(middle_singular_value(H), H.determinant());
  return Matrix3d::Identity() - H / lambda;
}

std::optional<PlaneMotion> closed_form_motion(const Window& window) {
  std::vector<Matrix3d> rank_one;  // tau_i n^T
  Matrix3d gram = Matrix3d::Zero();
  for (int i = 0; i < window.frame_count(); ++i) {
    rank_one.push_back(translation_times_normal(window, i));
    gram += rank_one.back().transpose() * rank_one.back();
  }
  if (!gram.allFinite()) return std::nullopt;
  PlaneMotion motion = motion_without_translation(window);
  motion.normal = Eigen::SelfAdjointEigenSolver<Matrix3d>(gram).eigenvectors().col(2);
  for (int i = 1; i < window.frame_count(); ++i) motion.tau[i] = rank_one[i] * motion.normal;
  return facing(window, std::move(motion));
}

// With y = R_ciw (x_1 - tau (n.x_1)), (u, v, 1) ~ y gives the rows (e_1 - u e_3).y = 0 and
// (e_2 - v e_3).y = 0; divided by y_z of the round before they are pixel errors.
Vector3d translation_given_normal(const Window& window, int frame, const Vector3d& normal) {
  const Matrix3d K_inverse = window.K.inverse();
  const Matrix3d R_ciw = window.R_wc[frame].transpose();
  Vector3d tau = Vector3d::Zero();
  for (int round = 0; round < 3; ++round) {
    Matrix3d AtA = Matrix3d::Zero();
    Vector3d Atb = Vector3d::Zero();
    for (int j = 0; j < window.track_count(); ++j) {
      if (!window.inlier[frame][j]) continue;
      const Vector3d ray_1 = K_inverse * window.points_px[0].col(j).homogeneous();
      const Vector3d seen = K_inverse * window.points_px[frame].col(j).homogeneous();
      const double height = normal.dot(ray_1);
      Eigen::Matrix<double, 2, 3> rows;
      rows << window.K(0, 0), 0, -window.K(0, 0) * seen.x(), 0, window.K(1, 1),
          -window.K(1, 1) * seen.y();
      rows = rows * R_ciw / R_ciw.row(2).dot(ray_1 - tau * height);
      AtA += height * height * rows.transpose() * rows;
      Atb += height * rows.transpose() * (rows * ray_1);
    }
    tau = solve_symmetric(AtA, Atb);
  }
  return tau;
}

std::vector<OtherPlane> other_planes(const Window& window, const PlaneMotion& motion) {
  std::vector<OtherPlane> planes;
  for (int k = 0; k < static_cast<int>(window.planes.size()); ++k) {
    if (k == window.leader || static_cast<int>(planes.size()) == kMostOtherPlanes) continue;
    if (const auto m = plane_from_cameras(window, motion, k)) planes.push_back({k, *m});
  }
  return planes;
}

std::vector<int> numbers_of(const std::vector<OtherPlane>& planes) {
  std::vector<int> numbers(planes.size());
  std::ranges::transform(planes, numbers.begin(), &OtherPlane::number);
  return numbers;
}

std::optional<PlaneMotion> twin_motion(const Window& window, const PlaneMotion& motion) {
  const auto angle_from = [](const Vector3d& normal) {
    return [normal](const HomographyMotion& m) { return angle_deg(m.normal, normal); };
  };
  const auto widest =
      std::ranges::max_element(motion.tau, {}, [](const Vector3d& tau) { return tau.norm(); });
  const auto motions =
      feasible_decompositions(window, static_cast<int>(widest - motion.tau.begin()));
  if (motions.size() < 2) return std::nullopt;
  const auto farthest = std::ranges::max_element(motions, {}, angle_from(motion.normal));
  if (angle_deg(farthest->normal, motion.normal) < kLeastTwin_deg) return std::nullopt;
  PlaneMotion twin{.normal = farthest->normal, .tau = motion.tau, .R_wc = motion.R_wc};
  for (int i = 1; i < window.frame_count(); ++i) {
    const auto of_frame = feasible_decompositions(window, i);
    const auto nearest = std::ranges::min_element(of_frame, {}, angle_from(twin.normal));
    if (nearest == of_frame.end() || angle_deg(nearest->normal, twin.normal) > kMostFromTwin_deg)
      continue;
    twin.tau[i] = nearest->tau;
    twin.R_wc[i] = nearest->R_21.transpose();
  }
  return twin;
}

}  // namespace gpo
