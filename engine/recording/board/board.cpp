// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/board.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

/// Long sides of the reduced images that are searched, one after the other [px].
constexpr std::array kSearchSizes = {420, 840, 1680};
constexpr int kFineSquare = 24;       // [px] of a board that fills the smallest of them
constexpr double kMostAstray = 0.12;  // fraction of the corner distance, before refinement
constexpr double kSubPixReach = 0.3;  // fraction of the corner distance

/// Returns the image, reduced to a long side of at most `size` pixels.
cv::Mat reduced_to(int size, const cv::Mat& gray) {
  const double scale = static_cast<double>(size) / std::max(gray.cols, gray.rows);
  if (scale >= 1) return gray;
  cv::Mat reduced;
  cv::resize(gray, reduced, {}, scale, scale, cv::INTER_AREA);
  return reduced;
}

/// Corners by OpenCV in reduced images: full pixels, row by row, in an unspecified order.
std::vector<cv::Point2f> search(const cv::Mat& gray, const Board& board) {
  const cv::Size counts(board.columns, board.rows);
  const bool fine = kSearchSizes[0] < kFineSquare * (std::max(board.columns, board.rows) + 1);
  const int flags =
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  std::vector<cv::Point2f> corners;
  for (const int size : kSearchSizes) {
    const cv::Mat reduced = reduced_to(size, gray);
    // The first finder is faster and finds tilted boards, the second finds small ones among
    // clutter, but takes seconds in large images.
    const bool second = size == kSearchSizes[0] || (fine && size == kSearchSizes[1]);
    if (cv::findChessboardCorners(reduced, counts, corners, flags) ||
        (second &&
         cv::findChessboardCornersSB(reduced, counts, corners, cv::CALIB_CB_NORMALIZE_IMAGE))) {
      const auto sx = static_cast<float>(gray.cols) / static_cast<float>(reduced.cols);
      const auto sy = static_cast<float>(gray.rows) / static_cast<float>(reduced.rows);
      for (auto& corner : corners)
        corner = {(corner.x + 0.5F) * sx - 0.5F, (corner.y + 0.5F) * sy - 0.5F};
      return corners;
    }
    if (reduced.size() == gray.size()) break;
  }
  return {};
}

double least_spacing(const std::vector<cv::Point2f>& corners, const Board& board) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(corners.size()); ++i) {
    if (i % board.columns > 0) least = std::min(least, cv::norm(corners[i] - corners[i - 1]));
    if (i >= board.columns)
      least = std::min(least, cv::norm(corners[i] - corners[i - board.columns]));
  }
  return least;
}

/// How a lens bends lines, by the division model (Fitzgibbon 2001): the undistorted point is at
/// x / (1 + bend |x|^2), for a distorted point x in half diagonals of the image from its center.
/// -0.7 describes an equidistant lens of 130 degrees (horizontally, of 4:3).
constexpr std::array kBends = {0., -0.1, -0.2, -0.3, -0.4, -0.5, -0.6, -0.7, -0.85, -1., 0.1, 0.2};

struct BentGrid {
  std::vector<cv::Point2f> corners;  ///< expected places
  std::vector<double> off_px;        ///< distances of the found corners from them
};

/// Fits a homography of the whole board to corners that are undistorted by `bend`.
std::optional<BentGrid> fit_grid(const std::vector<cv::Point2f>& found,
                                 const Board& board,
                                 cv::Size size,
                                 double bend,
                                 double most_px) {
  const cv::Point2d center(0.5 * (size.width - 1), 0.5 * (size.height - 1));
  const double unit_px = std::hypot(center.x, center.y);
  std::vector<cv::Point2d> grid, straight, expected;
  for (int i = 0; i < static_cast<int>(found.size()); ++i) {
    const cv::Point2d x = (cv::Point2d(found[i]) - center) / unit_px;
    const double scale = 1 + bend * x.dot(x);
    if (!(scale > 0.05)) return std::nullopt;  // beyond the model
    grid.emplace_back(i % board.columns, i / board.columns);
    straight.push_back(x / scale);
  }
  const cv::Mat H = cv::findHomography(grid, straight, cv::RANSAC, most_px / unit_px);
  if (H.empty()) return std::nullopt;
  cv::perspectiveTransform(grid, expected, H);
  BentGrid result;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const cv::Point2d& u = expected[i];
    const double scale = 2 / (1 + std::sqrt(std::max(0., 1 - 4 * bend * u.dot(u))));
    result.corners.emplace_back(center + unit_px * scale * u);
    result.off_px.push_back(cv::norm(found[i] - result.corners.back()));
  }
  return result;
}

/// Moves corners that contradict the others to where these predict them: some are far off.
/// The element of `kBends` with the least median distance predicts them; more than half are right.
void mend(std::vector<cv::Point2f>& corners, const Board& board, cv::Size size, double spacing) {
  const double most_px = kMostAstray * spacing;
  std::optional<BentGrid> best;
  for (const double bend : kBends) {
    auto grid = fit_grid(corners, board, size, bend, most_px);
    if (grid && (!best || median(grid->off_px) < median(best->off_px))) best = std::move(grid);
    if (best && std::ranges::max(best->off_px) <= most_px) return;
  }
  for (std::size_t i = 0; best && i < corners.size(); ++i)
    if (best->off_px[i] > most_px) corners[i] = best->corners[i];
}

Corners quarter_turn(const Corners& from, const Board& board) {
  const int n = board.columns;
  Corners turned(from.size());
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column)
      turned[row * n + column] = from[column * n + (n - 1 - row)];
  return turned;
}

Corners half_turn(const Corners& from) { return {from.rbegin(), from.rend()}; }

Corners right_handed(Corners corners, const Board& board) {
  const Eigen::Vector2d along_row = corners[board.columns - 1] - corners.front();
  const Eigen::Vector2d along_column = corners[corners.size() - board.columns] - corners.front();
  if (along_row.x() * along_column.y() - along_row.y() * along_column.x() > 0) return corners;
  for (auto row = corners.begin(); row != corners.end(); row += board.columns)
    std::reverse(row, row + board.columns);
  return corners;
}

double darkness_of_first(const cv::Mat& gray, const Corners& corners, const Board& board) {
  double difference = 0;
  for (int row = 0; row + 1 < board.rows; ++row) {
    for (int column = 0; column + 1 < board.columns; ++column) {
      const int i = row * board.columns + column;
      const Eigen::Vector2d center = (corners[i] + corners[i + 1] + corners[i + board.columns] +
                                      corners[i + board.columns + 1]) /
                                     4;
      const int x = std::clamp(static_cast<int>(std::lround(center.x())), 0, gray.cols - 1);
      const int y = std::clamp(static_cast<int>(std::lround(center.y())), 0, gray.rows - 1);
      difference += ((row + column) % 2 == 0 ? -1.0 : 1.0) * gray.at<std::uint8_t>(y, x);
    }
  }
  return difference;
}

/// Orders the corners consistently (OpenCV's order jumps): the first inner square is dark if that
/// distinguishes the board's rotations; among equals the rows run to the right.
Corners ordered(Corners corners, const cv::Mat& gray, const Board& board) {
  corners = right_handed(std::move(corners), board);
  std::vector<Corners> turns = {corners, half_turn(corners)};
  if (board.columns == board.rows) {
    turns.push_back(quarter_turn(corners, board));
    turns.push_back(half_turn(turns.back()));
  }
  std::vector<Corners> dark_first;
  for (const auto& turn : turns)
    if (darkness_of_first(gray, turn, board) > 0) dark_first.push_back(turn);
  if (!dark_first.empty()) turns = std::move(dark_first);
  return *std::ranges::max_element(
      turns, {}, [&](const Corners& turn) { return (turn[board.columns - 1] - turn.front()).x(); });
}

Corners find_chessboard(const cv::Mat& gray, const Board& board) {
  auto found = search(gray, board);
  if (found.empty()) return {};
  const double spacing = least_spacing(found, board);
  mend(found, board, gray.size(), spacing);
  const double reach = kSubPixReach * spacing;
  refine_corners(found, gray, std::clamp(static_cast<int>(std::lround(reach)), 2, 7), reach);
  Corners corners;
  for (const auto& corner : found) corners.emplace_back(corner.x, corner.y);
  return ordered(std::move(corners), gray, board);
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t kLeastCorners = 6;
constexpr std::size_t kLeastCornersOfTag = 4;

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

/// J = dr / d(rotation [rad], translation [m]), applied to T_camera_board from the left.
struct Linearized {
  double squared_px2 = 0;
  Matrix6 JtJ = Matrix6::Zero();
  Vector6 Jtr = Vector6::Zero();
  bool in_front = true;  ///< whether all corners are in front of the camera

  double error() const { return in_front ? squared_px2 : std::numeric_limits<double>::infinity(); }
};

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
    sum.in_front = sum.in_front && x.z() > 0;
    sum.squared_px2 += r.squaredNorm();
    sum.JtJ += J.transpose() * J;
    sum.Jtr += J.transpose() * r;
  }
  return sum;
}

Pose refined(const Visible& visible, const Camera& camera, Pose T_camera_board) {
  double damping = 1e-4;
  Linearized now = linearize(visible, camera, T_camera_board);
  for (int iteration = 0; iteration < 30 && std::isfinite(now.error()); ++iteration) {
    Matrix6 A = now.JtJ;
    A.diagonal() *= 1 + damping;
    const Vector6 step = -solve_symmetric(A, now.Jtr);
    const Pose moved = Pose{so3_exp(step.head<3>()), step.tail<3>()} * T_camera_board;
    const Linearized there = linearize(visible, camera, moved);
    if (there.error() < now.error()) {
      const bool settled = now.error() - there.error() < 1e-10 * now.error();
      T_camera_board = moved;
      now = there;
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

std::optional<cv::Size> chessboard_counts(const cv::Mat& gray) {
  std::vector<cv::Point2f> corners;
  cv::Mat marks;  // one per corner
  const int flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_LARGER;
  if (!cv::findChessboardCornersSB(
          reduced_to(kSearchSizes[1], gray), {3, 3}, corners, flags, marks) ||
      marks.empty())
    return std::nullopt;
  return cv::Size(std::max(marks.cols, marks.rows), std::min(marks.cols, marks.rows));
}

std::vector<bool> refine_corners(std::vector<cv::Point2f>& corners,
                                 const cv::Mat& gray,
                                 int half_px,
                                 double reach_px) {
  const cv::TermCriteria enough(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 1e-3);
  const std::vector<cv::Point2f> starts = corners;
  cv::cornerSubPix(gray, corners, {half_px, half_px}, {-1, -1}, enough);
  std::vector<bool> kept(corners.size(), true);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    kept[i] = !(cv::norm(corners[i] - starts[i]) > reach_px);
    if (!kept[i]) corners[i] = starts[i];
  }
  return kept;
}

Corners find_board(const cv::Mat& gray, const Board& board) {
  if (board.tags) return find_april_tags(gray, board);
  return board.markers ? find_charuco(gray, board) : find_chessboard(gray, board);
}

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
                                    const Camera& camera,
                                    double most_rms) {
  const Visible visible = visible_corners(corners_raw_px, board, camera);
  const std::size_t least = board.tags && board.tags->alone ? kLeastCornersOfTag : kLeastCorners;
  if (visible.points.size() < least || nearly_collinear(visible.points, board)) return std::nullopt;
  const double most_rms_px = most_rms * pixel_unit(camera);
  std::optional<BoardPose> best;
  for (const Pose& guess : first_guesses(visible, camera)) {
    const BoardPose pose = with_uncertainty(visible, camera, refined(visible, camera, guess));
    const double rms_px = pose.uncertainty.rms_px;
    if (!(pose.pose.p_wc.z() < 0) || !(rms_px <= most_rms_px)) continue;
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
