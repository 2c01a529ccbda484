// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/csv_table.h"
#include "engine/recording/recording.h"

#include <filesystem>

namespace gpo {

/// The samples of imu0/data.csv, gyro.csv or gyro_accel.csv: time stamp, then rates [rad/s] (or
/// [deg/s], where the header says so), then accelerations if there are any; further columns are
/// passed over. Axes and bias are left at their defaults. Throws InputError.
Gyroscope read_gyroscope(const std::filesystem::path& file, TimeUnit unit);

}  // namespace gpo
