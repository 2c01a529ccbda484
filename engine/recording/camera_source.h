// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <optional>
#include <string>

namespace gpo {

/// What the file of a picture or of a video says of how much its camera sees.
struct MetadataFieldOfView {
  double focal_diagonals = 0;  ///< focal length [diagonals of the picture]
  bool fisheye = false;        ///< angles from the axis are as distances in the picture
  std::string told;            ///< by whom and what, for people: "EXIF: 26 mm equivalent"
};

/// By the focal length that sees as much on film of 36 x 24 mm, along the diagonal. Nothing where
/// no camera has it: it is not 5 to 500 mm, or sees less than 10 or more than 170 degrees.
std::optional<MetadataFieldOfView> view_of_equivalent(double focal_mm, const std::string& told);

/// By the angle along the diagonal; nothing where it is not 10 to 170 degrees.
std::optional<MetadataFieldOfView> view_of_angle(double diagonal_deg, bool fisheye, const std::string& told);

/// Nothing where it sees less than 10 or more than 170 degrees along the diagonal.
std::optional<MetadataFieldOfView> view_of_focal(double focal_diagonals, const std::string& told);

/// The recording with another camera, and a note on it where no file tells it; `detail` is how it
/// was come by, for people.
void set_camera(Recording& recording,
                const Camera& camera,
                CameraSource source,
                const std::string& detail);

/// A guess from the size of its pictures, which is known, and what their file tells; else it sees
/// the usual (kUsualView_deg).
void guess_camera(Recording& recording, const std::optional<MetadataFieldOfView>& view = {});

}  // namespace gpo
