// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/version.hpp>

// OpenCV's ArUco markers: the module `aruco` until 4.6, a part of `objdetect` with another
// interface since 4.7. Where the two differ stands here and in opencv_aruco.cpp; which library is
// linked, in the CMakeLists.txt at the top.
#define GPO_ARUCO_IN_OBJDETECT (CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407)
#if GPO_ARUCO_IN_OBJDETECT
#include <opencv2/objdetect/aruco_dictionary.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

namespace gpo {

/// Markers that were seen in a picture: their numbers, and the four corners of each, clockwise from
/// its own first one [px].
struct OpencvMarkers {
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
};

/// `dictionary` is one of OpenCV's cv::aruco::DICT_..., here and below.
OpencvMarkers detect_markers(const cv::Mat& gray, int dictionary);

/// Dark quadrilaterals, by the way in which AprilTag finds them: what may be a tag. Clockwise [px].
std::vector<std::vector<cv::Point2f>> dark_quads(const cv::Mat& gray);

/// A marker's number, and by how many quarters what was read of it is turned.
struct MarkerCode {
  int id = 0;
  int quarters = 0;
};
/// Of the bits inside of a marker's border, a square of 0 and 1; nothing where it is none.
std::optional<MarkerCode> identify_marker(const cv::Mat& bits, int dictionary);

/// How many markers it has.
int marker_dictionary_size(int dictionary);

}  // namespace gpo
