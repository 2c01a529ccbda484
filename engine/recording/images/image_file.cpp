// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/image_file.h"

#include "engine/base/error.h"
#include "engine/files/byte_cursor.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <zlib.h>

namespace gpo {
namespace {

using Bytes = std::string_view;
using Header = std::optional<ImageHeader>;

constexpr Bytes kPngSignature = "\x89PNG\r\n\x1A\n";

unsigned byte_at(Bytes bytes, std::size_t i) { return static_cast<unsigned char>(bytes[i]); }

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
    while (i < bytes.size() && std::isdigit(byte_at(bytes, i)) == 0)
      i = bytes[i] == '#' ? std::min(bytes.find('\n', i), bytes.size()) : i + 1;
    for (; i < bytes.size() && std::isdigit(byte_at(bytes, i)) != 0 && number < 1'000'000; ++i)
      number = number * 10 + (byte_at(bytes, i) - '0');
  }
  const std::size_t channels = bytes[1] == '6' ? 3 : 1;
  const std::size_t bytes_a_pixel = header[2] > 255 ? 2 * channels : channels;
  return bytes.size() >= i + 1 + header[0] * header[1] * bytes_a_pixel;
}

/// Whether a picture's file is there to its end and a PNG's sums agree, before a library decodes
/// half of it or complains on stderr. TIFF and unknown formats pass.
/// A PNG's bytes with nothing but its pixels, transparency and orientation: libpng prints a line on
/// stderr for a color profile that it does not like, and programs write many of those. Other
/// formats stay as they are.
bool is_whole_image(Bytes bytes) {
  constexpr std::size_t kShortest = 12;
  if (bytes.size() < kShortest) return false;
  if (bytes.starts_with("\xFF\xD8")) return is_whole_jpeg(bytes);
  if (bytes.starts_with(kPngSignature)) return is_whole_png(bytes);
  if (bytes.starts_with("P5") || bytes.starts_with("P6")) return is_whole_pnm(bytes);
  if (bytes.starts_with("BM")) return bytes.size() >= little_endian(bytes, 2, 4);
  if (bytes.starts_with("RIFF")) return bytes.size() >= little_endian(bytes, 4, 4);
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

[[noreturn]] void refuse_format(const std::string& name) {
  throw InputError(name + ": found something that cannot be decoded, expected a picture");
}

/// Refuses what would not fit into memory, and formats whose decoders nobody asked for.
void check_header(const std::string& name, std::string_view bytes) {
  const auto header = read_image_header(bytes);
  if (!header) refuse_format(name);
  check_image_size(name, header->width, header->height);
  if (header->bits > 16) {
    throw InputError(
        fmt::format("{}: found {} bits a channel, expected 8 or 16", name, header->bits));
  }
}

std::int64_t little(Bytes bytes, std::int64_t place, int count) {
  return static_cast<std::int64_t>(little_endian(bytes, place, count));
}
std::int64_t big(Bytes bytes, std::int64_t place, int count) {
  return static_cast<std::int64_t>(big_endian(bytes, place, count));
}

Header png_header(Bytes bytes) { return ImageHeader{big(bytes, 16, 4), big(bytes, 20, 4)}; }

/// The first segment SOF0 to SOF15; C4, C8 and CC are others.
Header jpeg_header(Bytes bytes) {
  for (std::int64_t i = 2; big(bytes, i, 1) == 0xFF;) {
    const std::int64_t marker = big(bytes, i + 1, 1);
    if (marker == 0xFF) {
      ++i;
      continue;
    }
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker % 4 != 0;
    if (frame || marker == 0xC0) return ImageHeader{big(bytes, i + 7, 2), big(bytes, i + 5, 2)};
    i += 2 + big(bytes, i + 2, 2);
  }
  return std::nullopt;
}

Header bmp_header(Bytes bytes) {
  if (little(bytes, 14, 4) == 12) return ImageHeader{little(bytes, 18, 2), little(bytes, 20, 2)};
  const auto height = static_cast<std::int32_t>(little(bytes, 22, 4));  // negative: from the top
  return ImageHeader{little(bytes, 18, 4), std::abs(std::int64_t{height})};
}

Header pnm_header(Bytes bytes) {
  ImageHeader header;
  std::size_t i = 2;
  const auto at_digit = [&] { return std::isdigit(static_cast<unsigned char>(bytes[i])) != 0; };
  for (std::int64_t* number : {&header.width, &header.height}) {
    while (i < bytes.size() && !at_digit())
      i = bytes[i] == '#' ? std::min(bytes.find('\n', i), bytes.size()) : i + 1;
    for (; i < bytes.size() && at_digit() && *number < 1'000'000'000; ++i)
      *number = *number * 10 + (bytes[i] - '0');
  }
  return header;
}

/// The tags of the first directory that say how large a part of the picture may be.
Header tiff_header(Bytes bytes, ByteOrder order) {
  const auto at = [&](std::int64_t place, int count) {
    return static_cast<std::int64_t>(number_at(bytes, place, count, order));
  };
  ImageHeader header;
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
  if (kind == "VP8X") return ImageHeader{little(bytes, 24, 3) + 1, little(bytes, 27, 3) + 1};
  if (kind == "VP8L" && little(bytes, 20, 1) == 0x2F) {
    const std::int64_t packed = little(bytes, 21, 4);
    return ImageHeader{(packed & 0x3FFF) + 1, (packed >> 14 & 0x3FFF) + 1};
  }
  if (kind != "VP8 " || big(bytes, 23, 3) != 0x9D012A) return std::nullopt;
  return ImageHeader{little(bytes, 26, 2) & 0x3FFF, little(bytes, 28, 2) & 0x3FFF};
}

Header any_header(Bytes bytes) {
  if (bytes.starts_with(kPngSignature)) return png_header(bytes);
  if (bytes.starts_with("\xFF\xD8\xFF")) return jpeg_header(bytes);
  if (bytes.starts_with("BM")) return bmp_header(bytes);
  if (bytes.starts_with(Bytes("II*\0", 4))) return tiff_header(bytes, ByteOrder::little);
  if (bytes.starts_with(Bytes("MM\0*", 4))) return tiff_header(bytes, ByteOrder::big);
  if (bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP") return webp_header(bytes);
  const bool pnm = bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' &&
                   std::isspace(static_cast<unsigned char>(bytes[2])) != 0;
  return pnm ? pnm_header(bytes) : std::nullopt;
}

}  // namespace

void check_image_size(const std::string& name, std::int64_t width, std::int64_t height) {
  constexpr std::int64_t kMostPixels = 64'000'000;
  constexpr std::int64_t kLongestSide = 65'535;
  if (width <= kLongestSide && height <= kLongestSide && width * height <= kMostPixels) return;
  throw InputError(fmt::format("{}: found a picture of {}x{}, expected at most {} million pixels",
                               name,
                               width,
                               height,
                               kMostPixels / 1'000'000));
}

cv::Mat read_image(const std::filesystem::path& file) {
  return decode_image(read_file(file), file.string());
}

cv::Mat decode_image(std::string_view bytes, const std::string& name) {
  if (!is_whole_image(bytes))
    throw InputError(name + ": found a cut or broken picture, expected a whole one");
  check_header(name, bytes);
  cv::Mat image;
  try {
    std::string needed = without_remarks(bytes);
    const cv::Mat buffer(1, static_cast<int>(needed.size()), CV_8U, needed.data());
    image = cv::imdecode(buffer, cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty() || image.depth() > CV_16U || image.depth() == CV_8S) refuse_format(name);
  return image;
}

int significant_bits(const cv::Mat& image) {
  if (image.depth() == CV_8U) return 8;
  double largest = 0;
  cv::minMaxLoc(image.reshape(1), nullptr, &largest);
  for (const int bits : {10, 12, 14})
    if (largest < std::exp2(bits)) return bits;
  return 16;
}

cv::Mat gray_if_gray(const cv::Mat& bgr) {
  cv::Mat channels[3];
  cv::split(bgr, channels);
  const bool gray = cv::norm(channels[0], channels[1], cv::NORM_INF) == 0 &&
                    cv::norm(channels[1], channels[2], cv::NORM_INF) == 0;
  return gray ? channels[0] : bgr;
}

cv::Mat to_8_bits(const cv::Mat& image, int bits) {
  if (image.depth() == CV_8U) return image;
  cv::Mat reduced;
  image.convertTo(reduced, CV_8U, 255 / (std::exp2(bits) - 1));
  return reduced;
}

std::optional<ImageHeader> read_image_header(std::string_view bytes) {
  const Header header = bytes.size() < 12 ? std::nullopt : any_header(bytes);
  return header && header->width > 0 && header->height > 0 ? header : std::nullopt;
}

}  // namespace gpo
