// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/board_corners.h"
#include "engine/recording/board/opencv_aruco.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/imgproc.hpp>

namespace gpo {

namespace {

constexpr double kMostApart = 0.2;  // what two markers say of one corner, of a square's side

struct NamedDictionary {
  const char* name;
  int dictionary;
};

constexpr std::array kDictionaries = {
    NamedDictionary{"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    NamedDictionary{"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    NamedDictionary{"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    NamedDictionary{"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    NamedDictionary{"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    NamedDictionary{"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    NamedDictionary{"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    NamedDictionary{"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    NamedDictionary{"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    NamedDictionary{"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    NamedDictionary{"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    NamedDictionary{"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
    NamedDictionary{"DICT_7X7_50", cv::aruco::DICT_7X7_50},
    NamedDictionary{"DICT_7X7_100", cv::aruco::DICT_7X7_100},
    NamedDictionary{"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    NamedDictionary{"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
    NamedDictionary{"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
    NamedDictionary{"DICT_APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5},
    NamedDictionary{"DICT_APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9},
    NamedDictionary{"DICT_APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10},
    NamedDictionary{"DICT_APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11},
};

int dictionary_of(const std::string& name) {
  const auto found = std::find_if(kDictionaries.begin(),
                                  kDictionaries.end(),
                                  [&](const NamedDictionary& one) { return one.name == name; });
  CV_Assert(found != kDictionaries.end());
  return found->dictionary;
}

/// A marker that is seen: the homography that takes its place on the board [squares, from the
/// board's outer corner] into the picture, the side of a square there, and its corners.
struct SeenMarker {
  cv::Matx33d H;
  double square_px = 0;
  std::vector<cv::Point2f> corners;
};

/// The square (column, row) of each marker, in the order of their numbers.
std::vector<cv::Point> marker_squares(const Board& board, bool light_first) {
  std::vector<cv::Point> squares;
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = 0; column <= board.columns; ++column)
      if (((column + row) % 2 == 0) == light_first) squares.emplace_back(column, row);
  }
  return squares;
}

/// By square: row * (columns + 1) + column.
using MarkersBySquare = std::vector<std::optional<SeenMarker>>;

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
        SeenMarker{cv::Matx33d(H), side_px / side, corners[i]};
  }
  return markers;
}

/// Where a corner is about, and how far a window about it may reach without touching a marker.
struct ExpectedCorner {
  cv::Point2f at;
  double reach_px = 0;
};

/// From both markers beside the corner (column, row), where they agree.
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

std::size_t seen_count(const std::vector<Eigen::Vector2d>& corners) {
  return std::count_if(
      corners.begin(), corners.end(), [](const auto& corner) { return corner.allFinite(); });
}

}  // namespace

std::optional<std::string> dictionary_name(const std::string& name) {
  for (const NamedDictionary& one : kDictionaries) {
    for (const std::string& spelled : {name, fmt::format("DICT_{}", name)})
      if (std::equal(spelled.begin(),
                     spelled.end(),
                     one.name,
                     one.name + std::char_traits<char>::length(one.name),
                     [](char a, char b) { return std::tolower(a) == std::tolower(b); }))
        return one.name;
  }
  return std::nullopt;
}

std::string dictionary_names() {
  std::vector<std::string> names;
  names.reserve(kDictionaries.size());
  for (const NamedDictionary& one : kDictionaries) names.emplace_back(one.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

int dictionary_size(const std::string& dictionary) {
  return marker_dictionary_size(dictionary_of(dictionary));
}

int marker_count(const Board& board) { return (board.columns + 1) * (board.rows + 1) / 2; }

std::vector<Eigen::Vector2d> find_charuco(const cv::Mat& gray, const Board& board) {
  const auto markers = detect_markers(gray, dictionary_of(board.markers->dictionary));
  auto corners = corners_between(place_markers(board, markers, false), gray, board);
  if (board.rows % 2 == 1) {  // an even number of rows of squares
    // With the markers in the wrong squares no two neighbors agree.
    auto older = corners_between(place_markers(board, markers, true), gray, board);
    if (seen_count(older) > seen_count(corners)) corners = std::move(older);
  }
  if (seen_count(corners) == 0) return {};
  return corners;
}

}  // namespace gpo
