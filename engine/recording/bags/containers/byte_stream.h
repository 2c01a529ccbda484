// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/error.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace gpo {

/// A number as bags have it, little-endian.
template <class T>
std::string stored(T value) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  return {bytes.data(), bytes.size()};
}

/// A text with its length before it.
template <class Length = std::uint32_t>
std::string stored_text(std::string_view text) {
  return stored(static_cast<Length>(text.size())).append(text);
}

/// A file that is written from its beginning to its end, and knows where it is.
class ByteStream {
 public:
  explicit ByteStream(const std::filesystem::path& file)
      : file_(file), stream_(file, std::ios::binary) {}

  std::uint64_t place() const { return place_; }
  void write(std::string_view bytes) {
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    place_ += bytes.size();
  }
  /// Writes over what is there already.
  void write_at(std::uint64_t place, std::string_view bytes) {
    stream_.seekp(static_cast<std::streamoff>(place));
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream_.seekp(static_cast<std::streamoff>(place_));
  }
  /// Throws InputError where anything could not be written.
  void finish() {
    stream_.close();
    if (!stream_) throw InputError(file_.string() + ": cannot be written");
  }

 private:
  std::filesystem::path file_;
  std::ofstream stream_;
  std::uint64_t place_ = 0;
};

}  // namespace gpo
