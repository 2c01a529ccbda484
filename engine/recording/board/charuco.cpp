// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "engine/recording/board/board.h"
#include "engine/recording/board/opencv_aruco.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

/// Largest distance between two markers' predictions of a corner, of a square's side.
constexpr double kMostApart = 0.2;

/// Names of the predefined dictionaries in the order of OpenCV's enumeration.
const std::vector<std::string>& dictionaries() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const char* bits : {"4X4", "5X5", "6X6", "7X7"})
      for (const int size : {50, 100, 250, 1000})
        names.push_back(fmt::format("DICT_{}_{}", bits, size));
    for (const char* other :
         {"ARUCO_ORIGINAL", "APRILTAG_16h5", "APRILTAG_25h9", "APRILTAG_36h10", "APRILTAG_36h11"})
      names.push_back(fmt::format("DICT_{}", other));
    return names;
  }();
  static_assert(cv::aruco::DICT_4X4_50 == 0 && cv::aruco::DICT_7X7_1000 == 15 &&
                cv::aruco::DICT_APRILTAG_36h11 == 20);
  return kNames;
}

int dictionary_of(const std::string& name) {
  const auto found = std::ranges::find(dictionaries(), name);
  CV_Assert(found != dictionaries().end());
  return static_cast<int>(found - dictionaries().begin());
}

/// A visible marker: the homography from the board [squares, from its outer corner] to the image,
/// the side of a square there, and its corners.
struct VisibleMarker {
  cv::Matx33d H;
  double square_px = 0;
  std::vector<cv::Point2f> corners;
};

/// Returns the square (column, row) of each marker, by the markers' numbers.
std::vector<cv::Point> marker_squares(const Board& board, bool light_first) {
  std::vector<cv::Point> squares;
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = 0; column <= board.columns; ++column)
      if (((column + row) % 2 == 0) == light_first) squares.emplace_back(column, row);
  }
  return squares;
}

/// By square: row * (columns + 1) + column.
using MarkersBySquare = std::vector<std::optional<VisibleMarker>>;

MarkersBySquare place_markers(const Board& board, const OpencvMarkers& seen, bool light_first) {
  const auto& [ids, corners] = seen;
  const auto squares = marker_squares(board, light_first);
  const auto side = static_cast<float>(board.markers->side_m / board.square_m);
  const float margin = (1 - side) / 2;
  const int square_count = (board.columns + 1) * (board.rows + 1);
  MarkersBySquare markers(static_cast<std::size_t>(square_count));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] >= static_cast<int>(squares.size())) continue;
    const cv::Point& square = squares[ids[i]];
    const cv::Point2f first(static_cast<float>(square.x) + margin,
                            static_cast<float>(square.y) + margin);
    const std::vector<cv::Point2f> on_board = {first,
                                               first + cv::Point2f(side, 0),
                                               first + cv::Point2f(side, side),
                                               first + cv::Point2f(0, side)};
    const cv::Mat H = cv::getPerspectiveTransform(on_board, corners[i]);
    const double side_px = cv::arcLength(corners[i], true) / 4;
    markers[square.y * (board.columns + 1) + square.x] =
        VisibleMarker{cv::Matx33d(H), side_px / side, corners[i]};
  }
  return markers;
}

/// Predicted position of a corner, and the radius of a window around it that touches no marker.
struct ExpectedCorner {
  cv::Point2f at;
  double reach_px = 0;
};

/// Predicts the corner (column, row) from both markers beside it; nullopt if they disagree.
std::optional<ExpectedCorner> expected_corner(const MarkersBySquare& markers,
                                              const Board& board,
                                              int column,
                                              int row) {
  const cv::Vec3d on_board(column + 1, row + 1, 1);
  std::vector<cv::Point2f> guesses;
  double square_px = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const int k : {0, 1, 2, 3}) {
    const auto& marker = markers[(row + k / 2) * (board.columns + 1) + column + k % 2];
    if (!marker) continue;
    const cv::Vec3d p = marker->H * on_board;
    guesses.emplace_back(static_cast<float>(p[0] / p[2]), static_cast<float>(p[1] / p[2]));
    square_px = marker->square_px;
    for (const auto& corner : marker->corners)
      nearest = std::min(nearest, cv::norm(corner - guesses.back()));
  }
  if (guesses.size() != 2 || cv::norm(guesses[0] - guesses[1]) > kMostApart * square_px)
    return std::nullopt;
  return ExpectedCorner{(guesses[0] + guesses[1]) / 2, nearest / std::sqrt(2.0)};
}

Eigen::Vector2d refined(const cv::Mat& gray, const ExpectedCorner& expected) {
  Eigen::Vector2d none = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  const int half = std::clamp(static_cast<int>(0.9 * expected.reach_px), 2, 7);
  if (!cv::Rect2f(cv::Point2f(), gray.size()).contains(expected.at)) return none;
  std::vector<cv::Point2f> corner = {expected.at};
  if (!refine_corners(corner, gray, half, half)[0]) return none;
  return {corner[0].x, corner[0].y};
}

std::vector<Eigen::Vector2d> corners_between(const MarkersBySquare& markers,
                                             const cv::Mat& gray,
                                             const Board& board) {
  const Eigen::Vector2d none = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::vector<Eigen::Vector2d> corners;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const auto expected = expected_corner(markers, board, column, row);
      corners.push_back(expected ? refined(gray, *expected) : none);
    }
  }
  return corners;
}

std::size_t visible_count(const std::vector<Eigen::Vector2d>& corners) {
  return std::ranges::count_if(corners, [](const auto& corner) { return corner.allFinite(); });
}

}  // namespace

std::optional<std::string> dictionary_name(const std::string& name) {
  for (const std::string& known : dictionaries())
    for (const std::string& specs : {name, "DICT_" + name})
      if (lower_case(specs) == lower_case(known)) return known;
  return std::nullopt;
}

std::string dictionary_names() { return fmt::format("{}", fmt::join(dictionaries(), ", ")); }

int dictionary_size(const std::string& dictionary) {
  return marker_dictionary_size(dictionary_of(dictionary));
}

int marker_count(const Board& board) { return (board.columns + 1) * (board.rows + 1) / 2; }

std::vector<Eigen::Vector2d> find_charuco(const cv::Mat& gray, const Board& board) {
  const auto markers = detect_markers(gray, dictionary_of(board.markers->dictionary));
  auto corners = corners_between(place_markers(board, markers, false), gray, board);
  if (board.rows % 2 == 1) {  // even number of rows of squares
    // No two neighbors agree if the markers are assigned to the wrong squares.
    auto older = corners_between(place_markers(board, markers, true), gray, board);
    if (visible_count(older) > visible_count(corners)) corners = std::move(older);
  }
  if (visible_count(corners) == 0) return {};
  return corners;
}

}  // namespace gpo
