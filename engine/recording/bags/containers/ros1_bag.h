// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/containers/bag.h"

#include <memory>
#include <string_view>

namespace gpo {

class FileBytes;

inline constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";

/// The index of a ROS 1 bag: the one at its end, or, where there is none or it is of no use, what
/// going through the whole file finds, up to where it is cut or broken. Throws InputError.
Bag open_ros1_bag(const std::shared_ptr<const FileBytes>& file);

}  // namespace gpo
