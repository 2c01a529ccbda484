// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <filesystem>

namespace gpo {

/// The folder that holds cam0: this one, or mav0 in it.
std::optional<std::filesystem::path> find_euroc(const std::filesystem::path& folder);

/// Reads the EuRoC / ASL layout from the folder that holds cam0. With `tracks` pictures may be
/// missing; where any is, there are none. Throws InputError.
Recording read_euroc(const std::filesystem::path& folder,
                     const std::optional<std::filesystem::path>& tracks,
                     std::size_t cache_bytes);

/// Whether none of the pictures that cam0/data.csv lists exists.
bool euroc_lacks_pictures(const std::filesystem::path& folder);

}  // namespace gpo
