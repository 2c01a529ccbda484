// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/byte_cursor.h"
#include "engine/recording/bags/containers/bag.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Walks through a message, whichever way it is encoded: ROS 1 puts everything side by side,
/// little-endian; CDR of ROS 2 begins with four bytes that tell the order of bytes, puts numbers at
/// multiples of their size after those, and ends texts with a zero. As in a ByteCursor, what lies
/// beyond the end is 0 or empty, and `ok` is false.
class MessageCursor {
 public:
  /// Not `ok` where the encoding is neither of the two.
  MessageCursor(std::string_view bytes, MessageEncoding encoding);

  template <class T>
  T number() {
    align(sizeof(T));
    if (!swapped_) return bytes_.number<T>();
    std::string stored(bytes_.take(sizeof(T)));
    stored = std::string(stored.rbegin(), stored.rend());
    return ByteCursor(stored).number<T>();
  }
  std::string text();
  /// uint8[]: as many as the number before them says.
  std::string_view bytes();
  /// float64[], at most 1000 of them.
  std::vector<double> doubles();
  std::vector<double> doubles(std::size_t count);
  Eigen::Vector3d vector();
  bool ros1() const { return encoding_ == MessageEncoding::ros1; }
  bool ok() const { return known_ && bytes_.ok(); }

 private:
  void align(std::size_t size);

  ByteCursor bytes_;
  MessageEncoding encoding_;
  bool known_ = true;
  bool swapped_ = false;
};

}  // namespace gpo
