// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/opencv_aruco.h"

#if GPO_ARUCO_IN_OBJDETECT
#include <memory>

#include <opencv2/objdetect/aruco_detector.hpp>
#endif

namespace gpo {
namespace {

using Quads = std::vector<std::vector<cv::Point2f>>;
constexpr int kAnyFamily = cv::aruco::DICT_APRILTAG_36h11;  // quads do not depend on it
constexpr double kMostCorrected = 0.4;  // fraction of the bits that the family can correct

/// A pointer-like object; OpenCV's own type depends on its version.
auto dictionary_at(int number) {
#if GPO_ARUCO_IN_OBJDETECT
  return std::make_unique<cv::aruco::Dictionary>(cv::aruco::getPredefinedDictionary(number));
#else
  return cv::aruco::getPredefinedDictionary(number);
#endif
}

struct Detections {
  OpencvMarkers markers;
  Quads others;
};

Detections detect(const cv::Mat& gray, int dictionary, int refinement) {
  Detections found;
  auto& [markers, others] = found;
#if GPO_ARUCO_IN_OBJDETECT
  cv::aruco::DetectorParameters parameters;
  parameters.cornerRefinementMethod = refinement;
  cv::aruco::ArucoDetector(*dictionary_at(dictionary), parameters)
      .detectMarkers(gray, markers.corners, markers.ids, others);
#else
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = refinement;
  cv::aruco::detectMarkers(
      gray, dictionary_at(dictionary), markers.corners, markers.ids, parameters, others);
#endif
  return found;
}

}  // namespace

OpencvMarkers detect_markers(const cv::Mat& gray, int dictionary) {
  return detect(gray, dictionary, cv::aruco::CORNER_REFINE_NONE).markers;
}

Quads dark_quads(const cv::Mat& gray) {
  auto [markers, others] = detect(gray, kAnyFamily, cv::aruco::CORNER_REFINE_APRILTAG);
  Quads quads = std::move(markers.corners);
  quads.insert(quads.end(), others.begin(), others.end());
  return quads;
}

std::optional<MarkerCode> identify_marker(const cv::Mat& bits, int dictionary) {
  MarkerCode code;
  const bool known =
      dictionary_at(dictionary)->identify(bits, code.id, code.quarters, kMostCorrected);
  return known ? std::optional(code) : std::nullopt;
}

int marker_dictionary_size(int dictionary) { return dictionary_at(dictionary)->bytesList.rows; }

}  // namespace gpo
