// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/byte_cursor.h"
#include "engine/recording/bags/containers/bag.h"

#include <Eigen/Core>

namespace gpo {

/// ROS 1 is little-endian without padding; CDR (ROS 2) has four bytes with the byte order, aligns
/// numbers and ends texts with a zero. Values beyond the end are 0 or empty, and `ok` is false.
class MessageCursor {
 public:
  MessageCursor(std::string_view bytes, MessageEncoding encoding)
      : bytes_(bytes), encoding_(encoding), known_(encoding != MessageEncoding::unknown) {
    if (encoding != MessageEncoding::cdr) return;
    const std::string_view head = bytes_.take(kCdrHead);
    if (!bytes_.ok()) return;
    // Only plain CDR, as ROS 2 writes it; 0 is big-endian, 1 little-endian.
    known_ = head[0] == 0 && (head[1] == 0 || head[1] == 1);
    swapped_ = head[1] == 0;
  }

  template <class T>
  T number() {
    const bool cdr = encoding_ == MessageEncoding::cdr;
    const std::size_t beyond = cdr ? (bytes_.place() - kCdrHead) % sizeof(T) : 0;
    if (bytes_.ok() && beyond != 0) bytes_.take(sizeof(T) - beyond);
    if (!swapped_) return bytes_.number<T>();
    std::string stored(bytes_.take(sizeof(T)));
    stored = std::string(stored.rbegin(), stored.rend());
    return ByteCursor(stored).number<T>();
  }
  std::string_view bytes() { return bytes_.take(number<std::uint32_t>()); }
  std::string text() {
    std::string text(bytes());
    if (!ros1() && text.ends_with('\0')) text.pop_back();
    return text;
  }
  /// float64[], at most 1000 values.
  std::vector<double> doubles() {
    const auto count = number<std::uint32_t>();
    constexpr std::uint32_t kMost = 1000;
    if (count > kMost) known_ = false;
    return count == 0 || count > kMost ? std::vector<double>() : doubles(count);
  }
  std::vector<double> doubles(std::size_t count) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count && ok(); ++i) values.push_back(number<double>());
    values.resize(count);
    return values;
  }
  Eigen::Vector3d vector() { return Eigen::Map<const Eigen::Vector3d>(doubles(3).data()); }
  std::int64_t time_ns() {
    // Only ROS 2 has signed seconds.
    const std::int64_t seconds =
        ros1() ? std::int64_t{number<std::uint32_t>()} : number<std::int32_t>();
    return seconds * 1'000'000'000 + number<std::uint32_t>();
  }
  MessageHeader header() {
    if (ros1()) number<std::uint32_t>();  // seq
    const std::int64_t stamp_ns = time_ns();
    return {stamp_ns, text()};
  }
  bool ros1() const { return encoding_ == MessageEncoding::ros1; }
  bool ok() const { return known_ && bytes_.ok(); }

 private:
  static constexpr std::size_t kCdrHead = 4;

  ByteCursor bytes_;
  MessageEncoding encoding_;
  bool known_;
  bool swapped_ = false;
};

}  // namespace gpo
