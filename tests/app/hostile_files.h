// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

namespace gpo::test {

/// Returns a text `count` times.
std::string many(const std::string& text, std::size_t count);

/// Returns little-endian bytes of a number.
template <class T>
std::string le(T number) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &number, sizeof(T));
  return bytes;
}

/// Returns an MCAP file without an index, whose chunks each have a million empty messages.
std::string mcap_bomb(const std::string& compression, int chunks);
/// The same as a ROS 1 bag of 600,000 messages in each chunk.
std::string ros1_bomb(int chunks);
/// Writes a database of ROS 2 whose messages are a view without end.
void write_endless_database(const std::filesystem::path& file);

// Images that claim 60,000 x 60,000 pixels.
std::string huge_png();
std::string huge_jpeg();
std::string huge_tiff();
std::string huge_webp();

}  // namespace gpo::test
