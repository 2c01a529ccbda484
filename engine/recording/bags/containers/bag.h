// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gpo {

/// How the bytes of a message are to be read: as ROS 1 writes them, or as ROS 2 does.
enum class MessageEncoding { ros1, cdr, unknown };

struct BagTopic {
  std::string name;  ///< "/cam0/image_raw"
  std::string type;  ///< "sensor_msgs/Image", of ROS 2 too
  MessageEncoding encoding = MessageEncoding::unknown;
  std::int64_t messages = 0;
};

/// Where one message lies.
struct BagMessage {
  int topic = 0;                 ///< of `Bag::topics`
  std::int64_t recorded_ns = 0;  ///< when it was written, by the recorder's clock
  std::uint32_t chunk = 0;       ///< what these two mean is the container's secret
  std::uint64_t place = 0;
};

/// The index of a bag, whichever container it is. Nothing but it is in memory.
struct Bag {
  std::filesystem::path file;
  std::vector<BagTopic> topics;      ///< by name
  std::vector<BagMessage> messages;  ///< as they lie in the file, so that going along is fast
  std::vector<std::string> notes;    ///< "cut at byte 1000: ..."
  /// The bytes of a message, or the first `most_bytes` of them. From several threads at once.
  /// Throws InputError where they are broken.
  std::function<std::string(const BagMessage& message, std::uint64_t most_bytes)> read;
};

inline constexpr std::uint64_t kWholeMessage = UINT64_MAX;

/// Of a picture of 64 million pixels, and then some.
inline constexpr std::uint64_t kMostMessageBytes = std::uint64_t{256} << 20;

}  // namespace gpo
