// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/containers/bag.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gpo {

/// What is written: a name and a type that message_bytes.h knows.
struct WrittenTopic {
  std::string name;
  std::string type;
};

/// A bag while it is written: a message after the other, in the order of their times, then the end.
struct BagWriter {
  MessageEncoding encoding;  ///< that the messages are to have
  std::function<void(int topic, std::int64_t time_ns, const std::string& bytes)> write;
  /// Throws InputError where not all of it could be written.
  std::function<void()> finish;
};

/// ROS 1, chunks of 768 KiB, not compressed.
BagWriter ros1_writer(const std::filesystem::path& file, const std::vector<WrittenTopic>& topics);

/// ROS 2 in MCAP, chunks of 4 MiB, compressed by zstd.
BagWriter mcap_writer(const std::filesystem::path& file, const std::vector<WrittenTopic>& topics);

}  // namespace gpo
