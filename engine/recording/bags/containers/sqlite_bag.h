// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/containers/bag.h"

#include <filesystem>
#include <string_view>

namespace gpo {

inline constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};

/// The index of a ROS 2 bag in a database, `topics` and `messages`; where the file is cut, of what
/// can be read of it. Throws InputError.
Bag open_sqlite_bag(const std::filesystem::path& file);

}  // namespace gpo
