// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/pictures/picture_header.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace gpo {

namespace {

using Bytes = std::string_view;
using Header = std::optional<PictureHeader>;

enum class Order { little_endian, big_endian };

/// An unsigned number of some bytes; 0 beyond the end.
std::int64_t number_at(Bytes bytes, std::int64_t place, int count, Order order) {
  if (place < 0 || place + count > std::ssize(bytes)) return 0;
  std::int64_t value = 0;
  for (int k = 0; k < count; ++k) {
    const int from = order == Order::big_endian ? k : count - 1 - k;
    value = value << 8 | static_cast<unsigned char>(bytes[static_cast<std::size_t>(place + from)]);
  }
  return value;
}
std::int64_t little(Bytes bytes, std::int64_t place, int count) {
  return number_at(bytes, place, count, Order::little_endian);
}
std::int64_t big(Bytes bytes, std::int64_t place, int count) {
  return number_at(bytes, place, count, Order::big_endian);
}

Header png_header(Bytes bytes) { return PictureHeader{big(bytes, 16, 4), big(bytes, 20, 4)}; }

/// The first segment SOF0 to SOF15; C4, C8 and CC are others.
Header jpeg_header(Bytes bytes) {
  for (std::int64_t i = 2; big(bytes, i, 1) == 0xFF;) {
    const std::int64_t marker = big(bytes, i + 1, 1);
    if (marker == 0xFF) {
      ++i;
      continue;
    }
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker % 4 != 0;
    if (frame || marker == 0xC0) return PictureHeader{big(bytes, i + 7, 2), big(bytes, i + 5, 2)};
    i += 2 + big(bytes, i + 2, 2);
  }
  return std::nullopt;
}

Header bmp_header(Bytes bytes) {
  if (little(bytes, 14, 4) == 12) return PictureHeader{little(bytes, 18, 2), little(bytes, 20, 2)};
  const auto height = static_cast<std::int32_t>(little(bytes, 22, 4));  // negative: from the top
  return PictureHeader{little(bytes, 18, 4), std::abs(std::int64_t{height})};
}

Header pnm_header(Bytes bytes) {
  PictureHeader header;
  std::size_t i = 2;
  const auto at_digit = [&] { return std::isdigit(static_cast<unsigned char>(bytes[i])) != 0; };
  for (std::int64_t* number : {&header.width, &header.height}) {
    while (i < bytes.size() && !at_digit()) {
      i = bytes[i] == '#' ? std::min(bytes.find('\n', i), bytes.size()) : i + 1;
    }
    for (; i < bytes.size() && at_digit() && *number < 1'000'000'000; ++i) {
      *number = *number * 10 + (bytes[i] - '0');
    }
  }
  return header;
}

/// The tags of the first directory that say how large a part of the picture may be.
Header tiff_header(Bytes bytes, Order order) {
  const auto at = [&](std::int64_t place, int count) {
    return number_at(bytes, place, count, order);
  };
  PictureHeader header;
  const std::int64_t directory = at(4, 4);
  for (std::int64_t k = 0; k < at(directory, 2); ++k) {
    const std::int64_t entry = directory + 2 + 12 * k;
    const bool two_bytes = at(entry + 2, 2) == 3;
    const bool elsewhere = at(entry + 4, 4) > (two_bytes ? 2 : 1);
    const std::int64_t value = at(elsewhere ? at(entry + 8, 4) : entry + 8, two_bytes ? 2 : 4);
    switch (at(entry, 2)) {
      case 256:  // the picture's
      case 322:  // a tile's
        header.width = std::max(header.width, value);
        break;
      case 257:
      case 323:
        header.height = std::max(header.height, value);
        break;
      case 258:
        header.bits = static_cast<int>(std::min<std::int64_t>(value, 1000));
        break;
      default:
        break;
    }
  }
  return header;
}

/// Its three kinds write the size in three ways.
Header webp_header(Bytes bytes) {
  const Bytes kind = bytes.substr(12, 4);
  if (kind == "VP8X") return PictureHeader{little(bytes, 24, 3) + 1, little(bytes, 27, 3) + 1};
  if (kind == "VP8L" && little(bytes, 20, 1) == 0x2F) {
    const std::int64_t packed = little(bytes, 21, 4);
    return PictureHeader{(packed & 0x3FFF) + 1, (packed >> 14 & 0x3FFF) + 1};
  }
  if (kind != "VP8 " || big(bytes, 23, 3) != 0x9D012A) return std::nullopt;
  return PictureHeader{little(bytes, 26, 2) & 0x3FFF, little(bytes, 28, 2) & 0x3FFF};
}

Header any_header(Bytes bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1A\n")) return png_header(bytes);
  if (bytes.starts_with("\xFF\xD8\xFF")) return jpeg_header(bytes);
  if (bytes.starts_with("BM")) return bmp_header(bytes);
  if (bytes.starts_with(Bytes("II*\0", 4))) return tiff_header(bytes, Order::little_endian);
  if (bytes.starts_with(Bytes("MM\0*", 4))) return tiff_header(bytes, Order::big_endian);
  if (bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP") return webp_header(bytes);
  const bool pnm = bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' &&
                   std::isspace(static_cast<unsigned char>(bytes[2])) != 0;
  return pnm ? pnm_header(bytes) : std::nullopt;
}

}  // namespace

std::optional<PictureHeader> read_picture_header(std::string_view bytes) {
  const Header header = bytes.size() < 12 ? std::nullopt : any_header(bytes);
  return header && header->width > 0 && header->height > 0 ? header : std::nullopt;
}

}  // namespace gpo
