// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/pictures/picture_bytes.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include <zlib.h>

namespace gpo {

namespace {

using Bytes = std::string_view;

constexpr Bytes kPngSignature = "\x89PNG\r\n\x1A\n";

unsigned byte_at(Bytes bytes, std::size_t i) { return static_cast<unsigned char>(bytes[i]); }

std::size_t big_endian(Bytes bytes, std::size_t i, int count) {
  std::size_t value = 0;
  for (int k = 0; k < count; ++k) value = value << 8 | byte_at(bytes, i + k);
  return value;
}

/// Walks the segments of a JPEG up to its end marker. The marker is not merely searched for: the
/// thumbnail that a camera stores inside has one too.
bool is_whole_jpeg(Bytes bytes) {
  std::size_t i = 2;
  while (i + 1 < bytes.size()) {
    if (byte_at(bytes, i) != 0xFF) {  // entropy-coded data
      i = bytes.find('\xFF', i);
      if (i == Bytes::npos) return false;
      continue;
    }
    const unsigned marker = byte_at(bytes, i + 1);
    if (marker == 0xD9) return true;
    if (marker == 0xFF) {
      i += 1;
    } else if (marker <= 0x01 || (marker >= 0xD0 && marker <= 0xD8)) {  // stuffing, restart
      i += 2;
    } else {
      if (i + 3 >= bytes.size()) return false;
      i += 2 + big_endian(bytes, i + 2, 2);
    }
  }
  return false;
}

struct PngChunk {
  Bytes kind;
  Bytes all;  ///< with its length and its sum
  bool sum_agrees = false;
};

/// The one that begins at `place`, unless it is cut.
std::optional<PngChunk> png_chunk(Bytes bytes, std::size_t place) {
  constexpr std::size_t kAround = 12;  // length, kind, sum
  if (place + kAround > bytes.size()) return std::nullopt;
  const std::size_t length = big_endian(bytes, place, 4);
  if (length > bytes.size() - place - kAround) return std::nullopt;
  const Bytes summed = bytes.substr(place + 4, length + 4);
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(summed.data()), static_cast<uInt>(summed.size()));
  return PngChunk{bytes.substr(place + 4, 4),
                  bytes.substr(place, length + kAround),
                  sum == big_endian(bytes, place + 8 + length, 4)};
}

/// Up to IEND; libpng would complain of a wrong sum on stderr.
bool is_whole_png(Bytes bytes) {
  std::size_t i = kPngSignature.size();
  while (const auto chunk = png_chunk(bytes, i)) {
    if (!chunk->sum_agrees) return false;
    if (chunk->kind == "IEND") return true;
    i += chunk->all.size();
  }
  return false;
}

/// Whether the pixels that the header of a binary PGM or PPM announces are all there.
bool is_whole_pnm(Bytes bytes) {
  std::array<std::size_t, 3> header{};  // width, height, largest value
  std::size_t i = 2;
  for (auto& number : header) {
    while (i < bytes.size() && std::isdigit(byte_at(bytes, i)) == 0) {
      i = bytes[i] == '#' ? std::min(bytes.find('\n', i), bytes.size()) : i + 1;
    }
    for (; i < bytes.size() && std::isdigit(byte_at(bytes, i)) != 0 && number < 1'000'000; ++i) {
      number = number * 10 + (byte_at(bytes, i) - '0');
    }
  }
  const std::size_t channels = bytes[1] == '6' ? 3 : 1;
  const std::size_t bytes_a_pixel = header[2] > 255 ? 2 * channels : channels;
  return bytes.size() >= i + 1 + header[0] * header[1] * bytes_a_pixel;
}

}  // namespace

bool is_whole_picture(Bytes bytes) {
  const auto little_endian_4 = [&](std::size_t i) {
    return byte_at(bytes, i) | byte_at(bytes, i + 1) << 8 | byte_at(bytes, i + 2) << 16 |
           byte_at(bytes, i + 3) << 24;
  };
  constexpr std::size_t kShortest = 12;
  if (bytes.size() < kShortest) return false;
  if (bytes.starts_with("\xFF\xD8")) return is_whole_jpeg(bytes);
  if (bytes.starts_with(kPngSignature)) return is_whole_png(bytes);
  if (bytes.starts_with("P5") || bytes.starts_with("P6")) return is_whole_pnm(bytes);
  if (bytes.starts_with("BM")) return bytes.size() >= little_endian_4(2);
  if (bytes.starts_with("RIFF")) return bytes.size() >= little_endian_4(4);
  return true;
}

std::string without_remarks(Bytes bytes) {
  if (!bytes.starts_with(kPngSignature)) return std::string(bytes);
  std::string needed(kPngSignature);
  std::size_t i = needed.size();
  while (const auto chunk = png_chunk(bytes, i)) {
    const bool critical = std::isupper(byte_at(chunk->kind, 0)) != 0;
    if (critical || chunk->kind == "tRNS" || chunk->kind == "eXIf") needed += chunk->all;
    i += chunk->all.size();
  }
  return needed;
}

}  // namespace gpo
