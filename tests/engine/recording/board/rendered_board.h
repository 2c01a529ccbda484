// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/plane.h"
#include "engine/recording/board/board.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gpo::test {

inline const Board kChessboard{9, 6, 0.025};  // its two ends differ in color
inline const Board kTwin{8, 6, 0.025};        // looks the same after half a turn

inline Camera small_pinhole() { return {320, 240, 300, 302, 158.5, 121.5, Distortion::none, {}}; }
inline Camera small_lens() {
  return {
      320, 240, 300, 302, 158.5, 121.5, Distortion::radial_tangential, {-0.2, 0.05, 1e-3, 5e-4}};
}
inline Camera large_lens() {
  return {640, 480, 600, 603, 318, 243, Distortion::radial_tangential, {-0.15, 0.04, 1e-3, 5e-4}};
}

/// Gray of a chessboard's plane at a point [m]: squares, a white margin, gray around it.
inline double board_gray(const Board& board, double x, double y) {
  const double column = x / board.square_m;
  const double row = y / board.square_m;
  if (column < -2 || row < -2 || column > board.columns + 1 || row > board.rows + 1) return 110;
  if (column < -1 || row < -1 || column > board.columns || row > board.rows) return 230;
  const int parity = static_cast<int>(std::floor(column)) + static_cast<int>(std::floor(row));
  return parity % 2 == 0 ? 25 : 230;
}

/// Renders the plane z = 0, whose gray at a point [m] is `gray(x, y)`, with 4 x 4 rays per pixel
/// through the exact lens model: no interpolation shifts the corners.
template <class Gray>
cv::Mat render_plane(const Camera& camera, const Pose& pose, Gray&& gray) {
  constexpr int kSamples = 4;
  const Plane plane{-Eigen::Vector3d::UnitZ(), 0};
  cv::Mat image(camera.height, camera.width, CV_8UC1);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      double sum = 0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const int row = k / kSamples;
        const Eigen::Vector2d raw(u - 0.5 + (k % kSamples + 0.5) / kSamples,
                                  v - 0.5 + (row + 0.5) / kSamples);
        const Eigen::Vector2d ideal =
            camera.distortion == Distortion::none ? raw : undistort(camera, raw);
        const Eigen::Vector3d ray(
            (ideal.x() - camera.cx) / camera.fx, (ideal.y() - camera.cy) / camera.fy, 1);
        const auto point = intersect(plane, pose, ray);
        sum += point ? gray(point->x(), point->y()) : 110;
      }
      image.at<std::uint8_t>(v, u) =
          static_cast<std::uint8_t>(std::lround(sum / (kSamples * kSamples)));
    }
  return image;
}

inline cv::Mat render_board(const Board& board, const Camera& camera, const Pose& pose) {
  return render_plane(camera, pose, [&](double x, double y) { return board_gray(board, x, y); });
}

/// Renders a print of a ChArUco board; `texture` has its squares without a margin.
inline cv::Mat render_print(const cv::Mat& texture,
                            const Board& board,
                            const Camera& camera,
                            const Pose& pose) {
  const double texels = texture.cols / ((board.columns + 1) * board.square_m);
  return render_plane(camera, pose, [&](double x, double y) -> double {
    const int u = static_cast<int>(std::floor((x + board.square_m) * texels));
    const int v = static_cast<int>(std::floor((y + board.square_m) * texels));
    const int margin = texture.cols / (2 * (board.columns + 1));
    if (u < -margin || v < -margin || u >= texture.cols + margin || v >= texture.rows + margin)
      return 110;
    const bool print = u >= 0 && v >= 0 && u < texture.cols && v < texture.rows;
    return print ? 25 + 0.8 * texture.at<std::uint8_t>(v, u) : 229;
  });
}

/// First codes of the family 36h11 from AprilTag and Kalibr, independent of OpenCV: white bits are
/// 1, row by row from the top left, the highest bit first.
// clang-format off
inline constexpr std::array<std::uint64_t, 12> kTag36h11 = {
    0xd5d628584, 0xd97f18b49, 0xdd280910e, 0xe479e9c98, 0xebcbca822, 0xf31dab3ac,
    0x056a5d085, 0x10652e1d4, 0x22b1dfead, 0x265ad0472, 0x34fe91b86, 0x3ff962cd5};
// clang-format on

/// Gray of a board of tags at a point [m], relative to the top left corner of its top left tag, as
/// Kalibr draws it: number 0 at the bottom left, white paper around, and black squares between the
/// corners if `squares`.
inline double tag_gray(const Board& board, double x, double y, bool squares = true) {
  constexpr double kBlack = 25, kWhite = 230;
  const double pitch = 1 + board.tags->spacing;  // in sides of a tag
  const int columns = board.columns / 2, rows = board.rows / 2;
  const double u = x / board.square_m, v = y / board.square_m;
  const double margin = std::max(0.3, board.tags->spacing);
  if (u < -margin || v < -margin || u > pitch * columns - pitch + 1 + margin ||
      v > pitch * rows - pitch + 1 + margin)
    return 110;
  const int column = static_cast<int>(std::floor(u / pitch));
  const int row = static_cast<int>(std::floor(v / pitch));
  const double du = u - pitch * column, dv = v - pitch * row;  // from the tag's corner
  if (du >= 1 && dv >= 1) return squares ? kBlack : kWhite;    // between four tags
  if (column < 0 || row < 0 || column >= columns || row >= rows || du >= 1 || dv >= 1)
    return kWhite;
  const int bits = 6 + 2 * board.tags->border;
  const int i = static_cast<int>(dv * bits) - board.tags->border;
  const int j = static_cast<int>(du * bits) - board.tags->border;
  if (i < 0 || j < 0 || i >= 6 || j >= 6) return kBlack;
  const int id = columns * (rows - 1 - row) + column;
  const std::uint64_t code = kTag36h11.at(board.tags->alone.value_or(id));
  return (code >> (35 - (6 * i + j)) & 1) != 0 ? kWhite : kBlack;
}

/// Returns a camera that looks at the middle of the corners from `distance` [m], tilted and rolled
/// [deg].
inline Pose looking_at(const Board& board, double distance, double tilt_deg, double roll_deg) {
  const Eigen::Vector3d middle = board_points(board).back() / 2;
  const Eigen::Matrix3d R =
      so3_exp({radians(tilt_deg), 0.3 * radians(tilt_deg), 0}) * so3_exp({0, 0, radians(roll_deg)});
  return {R, middle - distance * R.col(2)};
}

/// Errors of the visible corners.
struct CornerErrors {
  int seen = 0;
  double rms_px = 0, largest_px = 0;
};
inline CornerErrors corner_errors(const std::vector<Eigen::Vector2d>& corners,
                                  const Board& board,
                                  const Camera& camera,
                                  const Pose& pose) {
  CornerErrors result;
  const auto truth = project_board(board, camera, pose);
  double squares = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!corners[i].allFinite()) continue;
    ++result.seen;
    const double error = (corners[i] - truth[i]).norm();
    squares += error * error;
    result.largest_px = std::max(result.largest_px, error);
  }
  result.rms_px = std::sqrt(squares / std::max(1, result.seen));
  return result;
}

}  // namespace gpo::test
