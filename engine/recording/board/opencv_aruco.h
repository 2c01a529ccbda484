// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/version.hpp>

// OpenCV's ArUco markers: the module `aruco` up to 4.6, a part of `objdetect` with another
// interface since 4.7. This header and opencv_aruco.cpp hide the difference; CMakeLists.txt at the
// top chooses the library.
#define GPO_ARUCO_IN_OBJDETECT (CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407)
#if GPO_ARUCO_IN_OBJDETECT
#include <opencv2/objdetect/aruco_dictionary.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

namespace gpo {

/// Numbers of markers in an image, and their corners, clockwise from the first one [px].
struct OpencvMarkers {
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
};

/// `dictionary` is one of OpenCV's cv::aruco::DICT_..., here and below.
OpencvMarkers detect_markers(const cv::Mat& gray, int dictionary);

/// Returns dark quadrilaterals, the candidates for tags, with AprilTag's algorithm. Clockwise [px].
std::vector<std::vector<cv::Point2f>> dark_quads(const cv::Mat& gray);

/// A marker's number, and the quarter turns by which it is rotated.
struct MarkerCode {
  int id = 0;
  int quarters = 0;
};
/// Decodes the bits inside a marker's border, a square of 0 and 1. nullopt if it is no marker.
std::optional<MarkerCode> identify_marker(const cv::Mat& bits, int dictionary);

int marker_dictionary_size(int dictionary);

}  // namespace gpo
