// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace gpo {

/// Walks through bytes as bags and other binary files have them, little-endian. Once something lies
/// beyond the end all that is read is 0 or empty, and `ok` is false: who reads many fields asks
/// once.
class ByteCursor {
 public:
  explicit ByteCursor(std::string_view bytes) : bytes_(bytes) {}

  std::string_view take(std::uint64_t count) {
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
  /// As many bytes as the length before them says.
  template <class Length = std::uint32_t>
  std::string_view text() {
    return take(number<Length>());
  }

  bool ok() const { return ok_; }
  /// Whether there is more to read.
  bool more() const { return ok_ && place_ < bytes_.size(); }
  std::size_t place() const { return place_; }

 private:
  std::string_view bytes_;
  std::size_t place_ = 0;
  bool ok_ = true;
};

}  // namespace gpo
