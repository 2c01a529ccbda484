// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/solvers.h"

#include "engine/base/error.h"
#include "engine/geometry/homography.h"
#include "engine/methods/initializers.h"

#include <limits>

#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;

constexpr std::int64_t kFrame_ns = 33'333'333;  // without an effect on a global shutter
constexpr int kGrid = 12;                       // points in a row and in a column
const Eigen::Vector2d kNotSeen =
    Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

Matrix2Xd grid_over_image(const Matrix3d& K) {
  Matrix2Xd points(2, kGrid * kGrid);
  for (int row = 0; row < kGrid; ++row)
    for (int column = 0; column < kGrid; ++column)
      points.col(kGrid * row + column) =
          2.0 / (kGrid - 1) * Eigen::Vector2d(K(0, 2) * column, K(1, 2) * row);
  return points;
}

void check_frames(std::size_t frames, std::size_t rotations) {
  if (frames < 2) throw InputError(fmt::format("{} frames, expected at least 2", frames));
  if (frames != rotations)
    throw InputError(
        fmt::format("{} frames and {} rotations, expected equal counts", frames, rotations));
}

/// All observations are inliers.
Window trusted_window(const PlaneTracks& tracks) {
  check_frames(tracks.points_px.size(), tracks.R_wc.size());
  Window window;
  window.K = tracks.K;
  window.points_px = tracks.points_px;
  for (std::size_t i = 0; i < tracks.points_px.size(); ++i) {
    const Matrix2Xd& px = tracks.points_px[i];
    if (px.cols() != tracks.points_px[0].cols())
      throw InputError(fmt::format("frame {}: {} points, expected {} as in frame 0",
                                   i,
                                   px.cols(),
                                   tracks.points_px[0].cols()));
    window.timestamps_ns.push_back(static_cast<std::int64_t>(i) * kFrame_ns);
    window.R_wc.push_back(tracks.R_wc[0].transpose() * tracks.R_wc[i]);
    std::vector<bool>& inlier = window.inlier.emplace_back();
    for (Eigen::Index j = 0; j < px.cols(); ++j)
      inlier.push_back(px.col(j).allFinite() && tracks.points_px[0].col(j).allFinite());
    const std::vector<int> own = window.inlier_tracks(static_cast<int>(i));
    const auto H = fit_homography(tracks.points_px[0](Eigen::all, own), px(Eigen::all, own));
    window.H_i1.push_back(i == 0 ? Matrix3d::Identity()
                                 : H.value_or(Matrix3d::Constant(kNotSeen.x())));
  }
  refine_homographies(window);
  return window;
}

PlaneTracks transferred_tracks(const PlaneHomographies& homographies) {
  const auto& [K, H_i1, R_wc, points_px] = homographies;
  PlaneTracks tracks{K, {points_px.size() > 0 ? points_px : grid_over_image(K)}, R_wc};
  for (std::size_t i = 1; i < H_i1.size(); ++i) {
    Matrix2Xd& px = tracks.points_px.emplace_back(tracks.points_px[0]);
    for (auto point : px.colwise()) {
      const Eigen::Vector3d y = H_i1[i] * point.homogeneous();
      point = y.z() * H_i1[i](2, 2) > 0 ? Eigen::Vector2d(y.hnormalized()) : kNotSeen;
    }
  }
  return tracks;
}

}  // namespace

Initialization closed_form_of_homographies(const PlaneHomographies& homographies) {
  check_frames(homographies.H_i1.size(), homographies.R_wc.size());
  return initialize_closed_form(trusted_window(transferred_tracks(homographies)), {});
}

Initialization gpo_of_homographies(const PlaneHomographies& homographies) {
  check_frames(homographies.H_i1.size(), homographies.R_wc.size());
  return initialize_gpo(trusted_window(transferred_tracks(homographies)), {}, {});
}

Initialization plane_and_cameras(const PlaneTracks& tracks, RotationModel rotations) {
  if (rotations == RotationModel::bias)
    throw SettingError("rotations", "bias: needs a gyroscope; use `initialize`");
  Window window = trusted_window(tracks);
  window.rotations = rotations;
  if (rotations == RotationModel::known) return initialize_gpo(window, {}, {});
  return initialize_gpo_joint(window, {.shutter = Shutter::global}, {});
}

}  // namespace gpo
