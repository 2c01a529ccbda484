// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/uncertainty/shared_information.h"

#include "engine/geometry/decompositions.h"
#include "engine/methods/plane/plane_motion.h"

namespace gpo {
SharedInformation prior_information(const Window& window,
                                    const UnknownsLayout& layout,
                                    double sigma_px) {
  SharedInformation prior = SharedInformation::Zero(layout.size(), layout.size());
  const GyroVector sigmas = gyro_prior_sigmas(window, layout.gyro);
  for (int k = 0; k < layout.gyro; ++k)
    prior(layout.of_gyro() + k, layout.of_gyro() + k) = prior_weight(sigma_px, sigmas(k));
  return prior;
}

SharedInformation frame_information(const Window& window,
                                    int frame,
                                    const FrameNormals& normals,
                                    RotationModel model) {
  const int gyro = gyro_unknowns(window, model);
  const int own = model == RotationModel::free ? 6 : 3;
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(8, 2 + gyro);  // d(u, phi, t) / d(shared unknowns)
  M.topLeftCorner<2, 2>().setIdentity();
  if (gyro > 0) M.block<3, 3>(2, 2) = window.gyro->d_bias[frame];
  if (gyro > 3) M.block<3, 1>(2, 5) = window.gyro->d_offset[frame];
  const Eigen::MatrixXd FM = normals.JtJ * M;
  const auto os = FM.bottomRows(own);
  return M.transpose() * FM -
         os.transpose() * solve_symmetric(normals.JtJ.bottomRightCorner(own, own), os);
}

std::optional<double> normal_sigma_deg(const SharedInformation& information, double sigma_px) {
  const auto covariance = inverse_information(information);
  if (!covariance) return std::nullopt;
  return degrees(sigma_px * std::sqrt(covariance->topLeftCorner<2, 2>().trace()));
}

std::optional<double> normal_bound_deg(const Window& window,
                                       const Plane& plane,
                                       std::span<const Pose> cameras,
                                       double sigma_px) {
  const PlaneObservations observations = plane_observations(window);
  const PlaneMotion motion = motion_of(plane, cameras);
  SharedInformation information = SharedInformation::Zero(2, 2);
  for (int i = 1; i < window.frame_count(); ++i) {
    const FrameNormals normals =
        frame_normals(observations.frames[i], frame_state(observations, motion, i), Rotating::no);
    information += frame_information(window, i, normals, RotationModel::known);
  }
  return normal_sigma_deg(information, sigma_px);
}

std::optional<Eigen::MatrixXd> inverse_information(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return std::nullopt;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const auto [values, vectors] = symmetric_eigen(scaled);
  if (!(values(0) > 1e-12)) return std::nullopt;
  const Eigen::MatrixXd inverse =
      vectors * values.cwiseInverse().asDiagonal() * vectors.transpose();
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

}  // namespace gpo
