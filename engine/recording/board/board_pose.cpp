// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/decompositions.h"
#include "engine/recording/board/board.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

namespace gpo {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kMostRmsPx = 2;
constexpr std::size_t kLeastCorners = 6;
constexpr std::size_t kLeastCornersOfTag = 4;

/// Visible corners: on the board [m], in the raw image, and undistorted [px].
struct Visible {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector2d> raw_px;
  std::vector<Eigen::Vector2d> ideal_px;
};

Visible visible_corners(const std::vector<Eigen::Vector2d>& raw_px,
                        const Board& board,
                        const Camera& camera) {
  Visible visible;
  const auto points = board_points(board);
  for (std::size_t i = 0; i < std::min(points.size(), raw_px.size()); ++i) {
    if (!raw_px[i].allFinite()) continue;
    const Eigen::Vector2d ideal = undistort(camera, raw_px[i]);
    if (!ideal.allFinite()) continue;
    visible.points.push_back(points[i]);
    visible.raw_px.push_back(raw_px[i]);
    visible.ideal_px.push_back(ideal);
  }
  return visible;
}

/// Returns whether all points but at most one are collinear, so that they determine no homography.
bool nearly_collinear(const std::vector<Eigen::Vector3d>& points, const Board& board) {
  // A line meets at most max(columns, rows) corners.
  if (static_cast<int>(points.size()) > std::max(board.columns, board.rows) + 1) return false;
  const double flat = 1e-6 * board.square_m * board.square_m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const auto off = std::ranges::count_if(points, [&](const auto& point) {
        return (points[j] - points[i]).cross(point - points[i]).norm() > flat;
      });
      if (off <= 1) return true;
    }
  }
  return false;
}

std::vector<Pose> first_guesses(const Visible& visible, const Camera& camera) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const auto& point : visible.points) points.emplace_back(point.x(), point.y(), 0);
  for (const auto& pixel : visible.ideal_px) pixels.emplace_back(pixel.x(), pixel.y());
  const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  std::vector<cv::Mat> rvecs;
  std::vector<cv::Mat> tvecs;
  cv::solvePnPGeneric(points, pixels, K, cv::noArray(), rvecs, tvecs, false, cv::SOLVEPNP_IPPE);
  std::vector<Pose> guesses;
  for (std::size_t i = 0; i < rvecs.size(); ++i) {
    const auto vector = [](const cv::Mat& v) {
      return Eigen::Vector3d(v.at<double>(0), v.at<double>(1), v.at<double>(2));
    };
    guesses.push_back({so3_exp(vector(rvecs[i])), vector(tvecs[i])});
  }
  return guesses;
}

/// Sum of the squared residuals r and both sides of the normal equations.
/// J = dr / d(rotation [rad], translation [m]), applied to T_camera_board from the left.
struct Linearized {
  double squared_px2 = 0;
  Matrix6 JtJ = Matrix6::Zero();
  Vector6 Jtr = Vector6::Zero();
};

double squared_error(const Visible& visible, const Camera& camera, const Pose& T_camera_board) {
  double sum = 0;
  for (std::size_t i = 0; i < visible.points.size(); ++i) {
    const Eigen::Vector3d x = to_world(T_camera_board, visible.points[i]);
    if (x.z() <= 0) return std::numeric_limits<double>::infinity();
    sum += (project(camera, x) - visible.raw_px[i]).squaredNorm();
  }
  return sum;
}

/// Returns d(raw pixel) / d(point in the camera's frame), by central differences.
Eigen::Matrix<double, 2, 3> projection_jacobian(const Camera& camera, const Eigen::Vector3d& x) {
  const double step = 1e-6 * x.norm();
  Eigen::Matrix<double, 2, 3> J;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d h = step * Eigen::Vector3d::Unit(k);
    J.col(k) = (project(camera, x + h) - project(camera, x - h)) / (2 * step);
  }
  return J;
}

Linearized linearize(const Visible& visible, const Camera& camera, const Pose& T_camera_board) {
  Linearized sum;
  for (std::size_t i = 0; i < visible.points.size(); ++i) {
    const Eigen::Vector3d x = to_world(T_camera_board, visible.points[i]);
    const Eigen::Vector2d r = project(camera, x) - visible.raw_px[i];
    const Eigen::Matrix<double, 2, 3> P = projection_jacobian(camera, x);
    Eigen::Matrix<double, 2, 6> J;
    J << -P * skew(x), P;
    sum.squared_px2 += r.squaredNorm();
    sum.JtJ += J.transpose() * J;
    sum.Jtr += J.transpose() * r;
  }
  return sum;
}

Pose refined(const Visible& visible, const Camera& camera, Pose T_camera_board) {
  double damping = 1e-4;
  double error = squared_error(visible, camera, T_camera_board);
  for (int iteration = 0; iteration < 30 && std::isfinite(error); ++iteration) {
    const Linearized now = linearize(visible, camera, T_camera_board);
    Matrix6 A = now.JtJ;
    A.diagonal() *= 1 + damping;
    const Vector6 step = -solve_symmetric(A, now.Jtr);
    const Pose moved = Pose{so3_exp(step.head<3>()), step.tail<3>()} * T_camera_board;
    const double moved_error = squared_error(visible, camera, moved);
    if (moved_error < error) {
      const bool settled = error - moved_error < 1e-10 * error;
      T_camera_board = moved;
      error = moved_error;
      damping /= 10;
      if (settled) break;
    } else {
      damping *= 10;
      if (damping > 1e6) break;
    }
  }
  return T_camera_board;
}

BoardPose with_uncertainty(const Visible& visible,
                           const Camera& camera,
                           const Pose& T_camera_board) {
  const Linearized at = linearize(visible, camera, T_camera_board);
  const auto n = static_cast<double>(visible.points.size());
  const Matrix6 covariance = at.squared_px2 / (2 * n - 6) * inverse_of_symmetric(at.JtJ);
  const Eigen::Matrix3d rotation = covariance.topLeftCorner<3, 3>();
  const Eigen::Vector3d normal = T_camera_board.R_wc.col(2);
  const auto sigma = [](double variance) { return std::sqrt(std::max(0.0, variance)); };
  BoardPose found{inverse(T_camera_board), {}};
  found.uncertainty.rms_px = std::sqrt(at.squared_px2 / n);
  // A rotation from the left is about the camera's center, so only the translation moves it.
  found.uncertainty.position_sigma_m = sigma(covariance.bottomRightCorner<3, 3>().trace());
  found.uncertainty.rotation_sigma_deg = degrees(sigma(rotation.trace()));
  found.uncertainty.normal_sigma_deg =
      degrees(sigma(rotation.trace() - normal.dot(rotation * normal)));
  return found;
}

}  // namespace

const char* board_title(const Board& board) {
  if (board.tags) return board.tags->alone ? "AprilTag" : "AprilGrid";
  return board.markers ? "ChArUco board" : "chessboard";
}

std::vector<Eigen::Vector3d> board_points(const Board& board) {
  const auto along = [&](int corner) {
    if (!board.tags) return corner * board.square_m;
    const int tag = corner / 2;
    return (tag * (1 + board.tags->spacing) + corner % 2) * board.square_m;
  };
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      points.emplace_back(along(column), along(row), 0);
  return points;
}

std::optional<BoardPose> board_pose(const std::vector<Eigen::Vector2d>& corners_raw_px,
                                    const Board& board,
                                    const Camera& camera) {
  const Visible visible = visible_corners(corners_raw_px, board, camera);
  const std::size_t least = board.tags && board.tags->alone ? kLeastCornersOfTag : kLeastCorners;
  if (visible.points.size() < least || nearly_collinear(visible.points, board)) return std::nullopt;
  std::optional<BoardPose> best;
  for (const Pose& guess : first_guesses(visible, camera)) {
    const BoardPose pose = with_uncertainty(visible, camera, refined(visible, camera, guess));
    const double rms_px = pose.uncertainty.rms_px;
    if (!(pose.pose.p_wc.z() < 0) || !(rms_px <= kMostRmsPx)) continue;
    if (!best || rms_px < best->uncertainty.rms_px) best = pose;
  }
  return best;
}

std::vector<Eigen::Vector2d> project_board(const Board& board,
                                           const Camera& camera,
                                           const Pose& pose) {
  std::vector<Eigen::Vector2d> corners;
  for (const auto& point : board_points(board))
    corners.push_back(project(camera, to_camera(pose, point)));
  return corners;
}

std::vector<Pose> board_symmetries(const Board& board) {
  if (board.markers || board.tags || (board.columns + board.rows) % 2 != 0) return {Pose{}};
  const Eigen::Vector3d center(
      0.5 * (board.columns - 1) * board.square_m, 0.5 * (board.rows - 1) * board.square_m, 0);
  const bool quarters = board.columns == board.rows && board.columns % 2 == 0;
  std::vector<Pose> symmetries;
  for (int quarter = 0; quarter < 4; quarter += quarters ? 1 : 2) {
    const Eigen::Matrix3d R = so3_exp({0, 0, 0.5 * quarter * std::numbers::pi});
    symmetries.push_back({R, center - R * center});
  }
  return symmetries;
}

}  // namespace gpo
