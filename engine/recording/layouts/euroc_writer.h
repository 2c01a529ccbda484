// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace gpo {

/// Writes a recording as an EuRoC folder that opens as the same recording: pictures as PNG (without
/// loss, but of 8 bits), calibration, gyroscope, tracks, board, plane, and `truth` as the poses of
/// the body at the frames' times, not interpolated where a frame has none. Written whole or not at
/// all. Throws InputError: pictures that cannot be decoded, a folder that is not empty, a full
/// disk.
void write_euroc(const Recording& recording,
                 const std::optional<GroundTruth>& truth,
                 const std::filesystem::path& folder,
                 const std::function<void(int done, int of)>& progress = {});

}  // namespace gpo
