// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/opencv_aruco.h"

#if GPO_ARUCO_IN_OBJDETECT
#include <opencv2/objdetect/aruco_detector.hpp>
#endif

namespace gpo {
namespace {

using Quads = std::vector<std::vector<cv::Point2f>>;
constexpr int kAnyFamily = cv::aruco::DICT_APRILTAG_36h11;  // any will do to look for quads
constexpr double kMostCorrected = 0.4;  // of the bits that the family can correct

}  // namespace

#if !GPO_ARUCO_IN_OBJDETECT

OpencvMarkers detect_markers(const cv::Mat& gray, int dictionary) {
  OpencvMarkers seen;
  cv::aruco::detectMarkers(
      gray, cv::aruco::getPredefinedDictionary(dictionary), seen.corners, seen.ids);
  return seen;
}

Quads dark_quads(const cv::Mat& gray) {
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_APRILTAG;
  Quads quads, others;
  std::vector<int> ids;
  cv::aruco::detectMarkers(
      gray, cv::aruco::getPredefinedDictionary(kAnyFamily), quads, ids, parameters, others);
  quads.insert(quads.end(), others.begin(), others.end());
  return quads;
}

std::optional<MarkerCode> identify_marker(const cv::Mat& bits, int dictionary) {
  MarkerCode code;
  const bool known = cv::aruco::getPredefinedDictionary(dictionary)
                         ->identify(bits, code.id, code.quarters, kMostCorrected);
  return known ? std::optional(code) : std::nullopt;
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

Quads dark_quads(const cv::Mat& gray) {
  cv::aruco::DetectorParameters parameters;
  parameters.cornerRefinementMethod = cv::aruco::CORNER_REFINE_APRILTAG;
  Quads quads, others;
  std::vector<int> ids;
  cv::aruco::ArucoDetector(cv::aruco::getPredefinedDictionary(kAnyFamily), parameters)
      .detectMarkers(gray, quads, ids, others);
  quads.insert(quads.end(), others.begin(), others.end());
  return quads;
}

std::optional<MarkerCode> identify_marker(const cv::Mat& bits, int dictionary) {
  MarkerCode code;
  const bool known = cv::aruco::getPredefinedDictionary(dictionary)
                         .identify(bits, code.id, code.quarters, kMostCorrected);
  return known ? std::optional(code) : std::nullopt;
}

int marker_dictionary_size(int dictionary) {
  return cv::aruco::getPredefinedDictionary(dictionary).bytesList.rows;
}

#endif

}  // namespace gpo
