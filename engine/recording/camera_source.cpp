// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/camera_source.h"

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::string_view kGuess = "no calibration: the camera is a guess";
constexpr std::string_view kSelfCalibrated = "the camera is self-calibrated";
constexpr double kLeastView_deg = 10, kMostView_deg = 170;
constexpr double kLeastFocal_mm = 5, kMostFocal_mm = 500;

bool is_within(double value, double least, double most) { return value >= least && value <= most; }

}  // namespace

void set_camera(Recording& recording,
                const Camera& camera,
                CameraSource source,
                const std::string& detail) {
  recording.camera = camera;
  recording.camera_source = source;
  std::erase_if(recording.notes, [](const std::string& note) {
    return note.starts_with(kGuess) || note.starts_with(kSelfCalibrated);
  });
  if (source == CameraSource::file) return;
  const std::string_view what = source == CameraSource::guess ? kGuess : kSelfCalibrated;
  recording.notes.insert(recording.notes.begin(), std::string(what) + " (" + detail + ")");
}

std::optional<MetadataFieldOfView> view_of_focal(double focal_diagonals, const std::string& told) {
  const double view_deg = degrees(2 * std::atan2(0.5, focal_diagonals));
  if (!is_within(view_deg, kLeastView_deg, kMostView_deg)) return std::nullopt;
  return MetadataFieldOfView{focal_diagonals, false, told};
}

std::optional<MetadataFieldOfView> view_of_equivalent(double focal_mm, const std::string& told) {
  const double diagonal_mm = std::hypot(36, 24);
  if (!is_within(focal_mm, kLeastFocal_mm, kMostFocal_mm)) return std::nullopt;
  return view_of_focal(focal_mm / diagonal_mm, told);
}

std::optional<MetadataFieldOfView> view_of_angle(double diagonal_deg, bool fisheye, const std::string& told) {
  if (!is_within(diagonal_deg, kLeastView_deg, kMostView_deg)) return std::nullopt;
  const double half_rad = radians(diagonal_deg) / 2;
  return MetadataFieldOfView{0.5 / (fisheye ? half_rad : std::tan(half_rad)), fisheye, told};
}

void guess_camera(Recording& recording, const std::optional<MetadataFieldOfView>& view) {
  const int width = recording.camera.width, height = recording.camera.height;
  Camera camera =
      view ? camera_of_focal(width, height, view->focal_diagonals) : camera_of_view(width, height);
  if (view && view->fisheye) {
    camera.distortion = Distortion::equidistant;
    camera.coefficients.assign(4, 0.0);
  }
  const std::string told =
      view ? view->told
           : fmt::format("{:.0f} degrees along the picture's diagonal", kUsualView_deg);
  set_camera(recording, camera, CameraSource::guess, told + "; `calibrate` finds it");
}

}  // namespace gpo
