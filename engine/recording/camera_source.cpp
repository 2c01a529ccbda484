// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/camera_source.h"

#include "engine/geometry/camera_guess.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::string_view kGuess = "no calibration: the camera is a guess";
constexpr std::string_view kSelfCalibrated = "the camera is self-calibrated";

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

void guess_camera(Recording& recording) {
  set_camera(recording,
             camera_of_view(recording.camera.width, recording.camera.height),
             CameraSource::guess,
             fmt::format("{:.0f} degrees along the picture's diagonal; `calibrate` finds it",
                         kUsualView_deg));
}

}  // namespace gpo
