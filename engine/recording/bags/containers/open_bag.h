// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/containers/bag.h"

#include <filesystem>

namespace gpo {

/// Opens a bag of any container, told apart by its first bytes. Throws InputError.
Bag open_bag(const std::filesystem::path& file);

/// Whether the file's name ends in bag, db3 or mcap.
bool is_bag_name(const std::filesystem::path& file);

}  // namespace gpo
