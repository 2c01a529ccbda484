// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/containers/bag.h"

#include <filesystem>
#include <memory>
#include <string_view>

namespace gpo {

class FileBytes;

/// Opens a bag of any container, told apart by its first bytes. Throws InputError.
Bag open_bag(const std::filesystem::path& file);

inline constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

/// The index of a ROS 1 bag or of an MCAP file: its own, or, where there is none or it is of no
/// use, what going through the whole file finds, up to where it is cut or broken. Throws
/// InputError.
Bag open_ros1_bag(const std::shared_ptr<const FileBytes>& file);
Bag open_mcap(const std::shared_ptr<const FileBytes>& file);

/// The index of a ROS 2 bag in a database, `topics` and `messages`; where the file is cut, of what
/// can be read of it. Throws InputError.
Bag open_sqlite_bag(const std::filesystem::path& file);

}  // namespace gpo
