// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

namespace gpo {

/// What a camera's or an app's own log says of a video. Axes of the camera are those of the picture
/// as it lies in the file, before a player turns it.
struct Log {
  std::filesystem::path file;                   ///< for messages
  std::filesystem::path camera_file;            ///< where `camera` stands
  std::optional<Camera> camera;                 ///< of size 0: that of the pictures
  std::optional<Pose> T_body_camera;            ///< body: the gyroscope's axes; where they are told
  std::optional<Gyroscope> gyroscope;           ///< time offset and rotation to the camera not set
  std::filesystem::path frames_file;            ///< where what is told of each picture stands
  std::vector<std::int64_t> frame_times_ns;     ///< one a picture, ascending; empty: not told
  std::vector<std::optional<Pose>> true_poses;  ///< of the camera, one a picture; empty: not told
  std::optional<double> readout_s;              ///< as `Recording::readout_s`
  std::vector<std::string> notes;               ///< each said once to the user
};

/// A phone's own axes (x right, y up, z out of the screen, as it is held upright), seen from its
/// rear camera: camera -> phone. The sensor's x runs from the top of the phone to its bottom.
inline Eigen::Matrix3d rear_camera_in_phone() {
  return (Eigen::Matrix3d() << 0, -1, 0, -1, 0, 0, 0, 0, -1).finished();
}

/// The rotation that three axes by name stand for, an upper-case letter for an axis, a lower-case
/// one for its opposite: row i of "YxZ" is e_y, -e_x, e_z. Nothing where the text is none, or
/// mirrors.
inline std::optional<Eigen::Matrix3d> signed_axes(std::string_view text) {
  constexpr std::string_view kAxes = "XYZxyz";
  if (text.size() != 3) return std::nullopt;
  Eigen::Matrix3d rows = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const std::size_t axis = kAxes.find(text[i]);
    if (axis == std::string_view::npos) return std::nullopt;
    rows(i, static_cast<int>(axis % 3)) = axis < 3 ? 1 : -1;
  }
  return rows.determinant() > 0.5 ? std::optional(rows) : std::nullopt;
}

}  // namespace gpo
