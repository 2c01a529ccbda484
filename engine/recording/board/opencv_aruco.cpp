// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/opencv_aruco.h"

#if GPO_ARUCO_IN_OBJDETECT
#include <opencv2/objdetect/aruco_detector.hpp>
#endif

namespace gpo {

#if !GPO_ARUCO_IN_OBJDETECT

OpencvMarkers detect_markers(const cv::Mat& gray, int dictionary) {
  OpencvMarkers seen;
  cv::aruco::detectMarkers(
      gray, cv::aruco::getPredefinedDictionary(dictionary), seen.corners, seen.ids);
  return seen;
}

int marker_dictionary_size(int dictionary) {
  return cv::aruco::getPredefinedDictionary(dictionary)->bytesList.rows;
}

#else

OpencvMarkers detect_markers(const cv::Mat& gray, int dictionary) {
  OpencvMarkers seen;
  cv::aruco::ArucoDetector(cv::aruco::getPredefinedDictionary(dictionary))
      .detectMarkers(gray, seen.corners, seen.ids);
  return seen;
}

int marker_dictionary_size(int dictionary) {
  return cv::aruco::getPredefinedDictionary(dictionary).bytesList.rows;
}

#endif

}  // namespace gpo
