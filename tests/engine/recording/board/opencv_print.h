// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/board/opencv_aruco.h"
#include "engine/recording/recording.h"

#if !GPO_ARUCO_IN_OBJDETECT
#include <opencv2/aruco/charuco.hpp>
#else
#include <opencv2/objdetect/aruco_board.hpp>
#endif

namespace gpo::test {

/// Draws a marker with any version of OpenCV.
inline cv::Mat opencv_marker(int dictionary, int id, int side_px) {
  cv::Mat marker;
#if !GPO_ARUCO_IN_OBJDETECT
  cv::aruco::getPredefinedDictionary(dictionary)->drawMarker(id, side_px, marker, 1);
#else
  cv::aruco::getPredefinedDictionary(dictionary).generateImageMarker(id, side_px, marker, 1);
#endif
  return marker;
}

/// Draws a ChArUco board without a margin with any version of OpenCV.
inline cv::Mat opencv_charuco(const Board& board, int dictionary) {
  constexpr int kTexels = 60;
  const cv::Size squares(board.columns + 1, board.rows + 1);
  const cv::Size size = squares * kTexels;
  const auto square = static_cast<float>(board.square_m);
  const auto marker = static_cast<float>(board.markers->side_m);
  const auto markers = cv::aruco::getPredefinedDictionary(dictionary);
  cv::Mat print;
#if !GPO_ARUCO_IN_OBJDETECT
  cv::aruco::CharucoBoard::create(squares.width, squares.height, square, marker, markers)
      ->draw(size, print, 0, 1);
#else
  cv::aruco::CharucoBoard(squares, square, marker, markers).generateImage(size, print, 0, 1);
#endif
  return print;
}

}  // namespace gpo::test
