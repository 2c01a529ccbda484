// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/containers/open_bag.h"

#include "engine/base/error.h"
#include "engine/recording/bags/containers/file_bytes.h"

#include <memory>
#include <string>

namespace gpo {

Bag open_bag(const std::filesystem::path& file) {
  const auto bytes = std::make_shared<const FileBytes>(file);
  const std::string begin = bytes->read(0, 16);
  if (begin.starts_with(kRos1Magic)) return open_ros1_bag(bytes);
  if (begin.starts_with(kMcapMagic)) return open_mcap(bytes);
  if (begin == std::string("SQLite format 3\0", 16)) return open_sqlite_bag(file);
  if (begin.starts_with("#ROSRECORD") || begin.starts_with("#ROSLOG")) {
    throw InputError(file.string() +
                     ": found a bag of an old format, expected version 2.0 (rosbag fix makes one)");
  }
  throw InputError(
      file.string() +
      ": found no bag, expected one of ROS 1 (version 2.0), MCAP or SQLite's database");
}

}  // namespace gpo
