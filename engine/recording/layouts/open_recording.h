// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/layouts/layouts.h"
#include "engine/recording/recording.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include <Eigen/Core>

namespace gpo {

/// Opens a folder or a file of any layout. Checks that all images exist and decodes only the first.
/// Throws InputError.
std::shared_ptr<const Recording> open_recording(const std::filesystem::path& path,
                                                const OpenOptions& options = {});

/// A stationary interval: neither the gyroscope's rates vary nor do the images move, so that the
/// mean rate is the bias.
struct StationaryInterval {
  std::int64_t first_ns = 0;  ///< camera's clock
  std::int64_t last_ns = 0;
  Eigen::Vector3d mean_rad_s = Eigen::Vector3d::Zero();  ///< the gyroscope's axes
  double sigma_rad_s = 0;  ///< of each axis: gyroscope noise and undetected image motion
};

/// Finds the longest stationary interval of at least 0.75 s; nullopt if there is none. Uses images
/// (or tracks) only if the gyroscope seems stationary. Throws InputError if an image is unreadable.
std::optional<StationaryInterval> find_stationary_interval(const Recording& recording);

}  // namespace gpo
