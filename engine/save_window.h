// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initialize.h"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace gpo {

/// The data of a window that `initialize` does not need, or takes as options.
struct WindowExtras {
  std::vector<cv::Mat> images = {};  ///< one per frame, 8 bits, gray or BGR; empty: none
  /// Camera center from the IMU, as `InitializeOptions::p_gyro_camera_m` [m].
  std::optional<Eigen::Vector3d> p_gyro_camera_m = std::nullopt;
};

/// Writes a window as a recording that the program opens: an EuRoC folder with the camera and its
/// uncertainty and readout, the samples of the gyroscope and the accelerometer, the tracks
/// (`tracks.csv`) and the images. `gpo-inspector run FOLDER --frames N --error latent` gives the
/// result of `initialize`. Frames' own rotations are not written; the program estimates them.
/// Throws InputError for bad input, as `initialize` does, if the folder is not empty, or the disk
/// is full; on failure no partial output remains.
void save_window(const std::filesystem::path& folder,
                 const Camera& camera,
                 std::span<const Frame> frames,
                 const Gyroscope* gyroscope = nullptr,
                 const WindowExtras& extras = {});

}  // namespace gpo
