// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace gpo {

/// A camera's field of view as stored in an image or a video.
struct FieldOfView {
  double focal_diagonals = 0;  ///< focal length [diagonals of the image]
  bool fisheye = false;        ///< equidistant: distances in the image are proportional to angles
  std::string source;          ///< for people: "EXIF: 26 mm equivalent"
};

/// Reads the field of view that a camera stored in a video or an image; nullopt if it is missing,
/// unreadable or implausible: outside of 10 to 170 deg along the diagonal, or of 5 to 500 mm.
std::optional<FieldOfView> stored_view(const std::filesystem::path& file);

/// From EXIF: the 35 mm equivalent focal length, or the real one and the sensor's pixel size.
std::optional<FieldOfView> view_of_exif(const std::filesystem::path& image);

/// From the 35 mm equivalent focal length in a phone's video. Approximate: it need not include the
/// crop of the stabilization.
std::optional<FieldOfView> view_of_metadata(const std::filesystem::path& video);

/// From a GoPro's settings (`gopro_settings`): the diagonal angle (ZFOV) of a fisheye, or of a
/// pinhole if the camera has linearized its images (VFOV).
std::optional<FieldOfView> view_of_gpmf(std::string_view settings);

/// Replaces a recording's camera, with a note unless it is from a file. `detail` is for people.
void set_camera(Recording& recording,
                const Camera& camera,
                CameraSource source,
                const std::string& detail);

/// Guesses a camera from the known size of the images and their stored field of view, or the usual
/// one (kUsualView_deg).
void guess_camera(Recording& recording, const std::optional<FieldOfView>& view = {});

}  // namespace gpo
