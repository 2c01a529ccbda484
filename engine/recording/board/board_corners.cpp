// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/board.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

constexpr int kSearchSize = 420;      // [px] long side of the reduced image for the first search
constexpr double kMostAstray = 0.12;  // fraction of the corner distance, before refinement
constexpr double kSubPixReach = 0.3;  // fraction of the corner distance

/// Finds a chessboard's corners with OpenCV in a reduced image. Returns them in full pixels, row by
/// row but in an unspecified order.
std::vector<cv::Point2f> search(const cv::Mat& gray, const Board& board) {
  cv::Mat reduced = gray;
  const double scale =
      std::min(1.0, static_cast<double>(kSearchSize) / std::max(gray.cols, gray.rows));
  if (scale < 1) cv::resize(gray, reduced, {}, scale, scale, cv::INTER_AREA);
  std::vector<cv::Point2f> corners;
  const cv::Size size(board.columns, board.rows);
  const int flags =
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  // The first finder is faster and finds tilted boards, the second finds small ones among clutter.
  // In an image this small both give up within some tens of milliseconds.
  if (!cv::findChessboardCorners(reduced, size, corners, flags) &&
      !cv::findChessboardCornersSB(reduced, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE))
    return {};
  const auto sx = static_cast<float>(gray.cols) / static_cast<float>(reduced.cols);
  const auto sy = static_cast<float>(gray.rows) / static_cast<float>(reduced.rows);
  for (auto& corner : corners)
    corner = {(corner.x + 0.5F) * sx - 0.5F, (corner.y + 0.5F) * sy - 0.5F};
  return corners;
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

/// Moves corners that contradict a homography of the whole board onto it: the search in the reduced
/// image leaves single corners far off, e.g. on a gap in the floor beside the board.
void mend(std::vector<cv::Point2f>& corners, const Board& board, double spacing) {
  std::vector<cv::Point2f> grid;
  grid.reserve(corners.size());
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      grid.emplace_back(static_cast<float>(column), static_cast<float>(row));
  const cv::Mat H = cv::findHomography(grid, corners, cv::RANSAC, kMostAstray * spacing);
  if (H.empty()) return;
  std::vector<cv::Point2f> expected;
  cv::perspectiveTransform(grid, expected, H);
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (cv::norm(corners[i] - expected[i]) > kMostAstray * spacing) corners[i] = expected[i];
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

/// Reverses each row if the corners are in left-handed order.
Corners right_handed(Corners corners, const Board& board) {
  const Eigen::Vector2d along_row = corners[board.columns - 1] - corners.front();
  const Eigen::Vector2d along_column = corners[corners.size() - board.columns] - corners.front();
  if (along_row.x() * along_column.y() - along_row.y() * along_column.x() > 0) return corners;
  for (auto row = corners.begin(); row != corners.end(); row += board.columns)
    std::reverse(row, row + board.columns);
  return corners;
}

/// Returns how much darker the inner squares with even row + column are than the others.
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

/// Orders the corners consistently (OpenCV's order jumps between frames and differs between its
/// finders): the first inner square is dark if that distinguishes the board's rotations; among
/// equals the rows run to the right.
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
  mend(found, board, spacing);
  const double reach = kSubPixReach * spacing;
  refine_corners(found, gray, std::clamp(static_cast<int>(std::lround(reach)), 2, 7), reach);
  Corners corners;
  for (const auto& corner : found) corners.emplace_back(corner.x, corner.y);
  return ordered(std::move(corners), gray, board);
}

}  // namespace

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

}  // namespace gpo
