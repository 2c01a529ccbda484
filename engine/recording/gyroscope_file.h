// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/csv_table.h"
#include "engine/recording/recording.h"

#include <filesystem>

namespace gpo {

/// The samples of imu0/data.csv or gyro.csv: time stamp, then rates [rad/s]; further columns
/// (accelerometer) are passed over. Axes and bias are left at their defaults. Throws InputError.
Gyroscope read_gyroscope(const std::filesystem::path& file, TimeUnit unit);

}  // namespace gpo
