// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/stop.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace gpo {

enum class ByteOrder { little, big };

/// Returns an unsigned number of up to 8 bytes; 0 if it exceeds the bytes.
inline std::uint64_t number_at(std::string_view bytes,
                               std::uint64_t place,
                               std::size_t count,
                               ByteOrder order) {
  if (count > bytes.size() || place > bytes.size() - count) return 0;
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t from = order == ByteOrder::big ? k : count - 1 - k;
    value = value << 8 | static_cast<unsigned char>(bytes[place + from]);
  }
  return value;
}
inline std::uint64_t big_endian(std::string_view bytes, std::uint64_t place, std::size_t count) {
  return number_at(bytes, place, count, ByteOrder::big);
}
inline std::uint64_t little_endian(std::string_view bytes, std::uint64_t place, std::size_t count) {
  return number_at(bytes, place, count, ByteOrder::little);
}

/// Returns a number as it is in memory, which is little-endian on all of our machines.
template <class T>
std::string stored(const T& number) {
  return {reinterpret_cast<const char*>(&number), sizeof(number)};
}

/// Reads little-endian fields of bags and other binary files. Beyond the end, all fields are 0 or
/// empty and `ok` is false, so that one check after many fields is enough.
class ByteCursor {
 public:
  explicit ByteCursor(std::string_view bytes) : bytes_(bytes) {}

  std::string_view take(std::uint64_t count) {
    if (++taken_ % kTakenPerCheck == 0) check_stop();
    if (!ok_ || count > bytes_.size() - place_) {
      ok_ = false;
      return {};
    }
    place_ += count;
    return bytes_.substr(place_ - count, count);
  }
  template <class T>
  T number() {
    T value{};
    const std::string_view stored = take(sizeof(T));
    if (ok_) std::memcpy(&value, stored.data(), sizeof(T));
    return value;
  }
  /// Returns a length-prefixed string.
  template <class Length = std::uint32_t>
  std::string_view text() {
    return take(number<Length>());
  }

  bool ok() const { return ok_; }
  bool more() const { return ok_ && place_ < bytes_.size(); }
  std::size_t place() const { return place_; }

 private:
  /// A check costs more than a field. A bag's records are fields of one cursor over their chunk.
  static constexpr unsigned kTakenPerCheck = 64;

  std::string_view bytes_;
  std::size_t place_ = 0;
  unsigned taken_ = 0;
  bool ok_ = true;
};

}  // namespace gpo
