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

/// Opens a folder or a file; finds out which layout it is. Pictures are not decoded yet, but each
/// is known to exist. Throws InputError.
std::shared_ptr<const Recording> open_recording(const std::filesystem::path& path,
                                                const OpenOptions& options = {});

/// A stretch of time in which neither the gyroscope's rates vary nor the pictures move: what the
/// gyroscope says there is its bias.
struct StationaryInterval {
  std::int64_t first_ns = 0;  ///< camera's clock
  std::int64_t last_ns = 0;
  Eigen::Vector3d mean_rad_s = Eigen::Vector3d::Zero();  ///< the gyroscope's axes
  double sigma_rad_s = 0;  ///< each axis: by its noise, and by what the pictures may hide
};

/// The longest one of at least 0.75 s. Looks at pictures (or tracks) only where the gyroscope seems
/// to rest. Throws InputError where a picture cannot be read.
std::optional<StationaryInterval> find_stationary_interval(const Recording& recording);

}  // namespace gpo
