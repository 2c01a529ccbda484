// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <filesystem>
#include <optional>

namespace gpo {

/// The folder, where it holds rgb.txt.
std::optional<std::filesystem::path> find_tum(const std::filesystem::path& folder);

/// Reads the layout of the TUM RGB-D benchmark: rgb.txt, the pictures that it lists,
/// groundtruth.txt (the camera's poses) and a calibration beside them; depth is passed over. With
/// `tracks` pictures may be missing. Throws InputError.
Recording read_tum(const std::filesystem::path& folder,
                   const std::optional<std::filesystem::path>& tracks,
                   std::size_t cache_bytes);

}  // namespace gpo
