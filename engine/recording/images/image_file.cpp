// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/byte_cursor.h"
#include "engine/files/image_codec.h"
#include "engine/files/late_function.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/images/images.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <span>

#include <opencv2/imgcodecs.hpp>
#include <zlib.h>

namespace gpo {
namespace {

using Bytes = std::string_view;
using Header = std::optional<ImageHeader>;

constexpr const char* kUnknownFormat = "cannot decode: not an image of a supported format";
constexpr Bytes kPngSignature = "\x89PNG\r\n\x1A\n";
constexpr Bytes kJpegSignature = "\xFF\xD8\xFF";
constexpr Bytes kDigits = "0123456789";

/// cv::imdecode(InputArray bytes, int flags)
const LateFunction<cv::Mat(cv::InputArray, int), find_in_imgcodecs> opencv_imdecode(
    "_ZN2cv8imdecodeERKNS_11_InputArrayEi");

unsigned byte_at(Bytes bytes, std::size_t i) { return static_cast<unsigned char>(bytes[i]); }
bool is_digit(Bytes bytes, std::size_t i) { return std::isdigit(byte_at(bytes, i)) != 0; }

struct PngChunk {
  Bytes kind;
  Bytes all;  ///< with its length and checksum
  bool sum_agrees = false;
};

std::optional<PngChunk> png_chunk(Bytes bytes, std::size_t place) {
  constexpr std::size_t kAround = 12;  // length, kind, checksum
  if (place + kAround > bytes.size()) return std::nullopt;
  const std::size_t length = big_endian(bytes, place, 4);
  if (length > bytes.size() - place - kAround) return std::nullopt;
  const Bytes summed = bytes.substr(place + 4, length + 4);
  const auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(summed.data()), summed.size());
  return PngChunk{bytes.substr(place + 4, 4),
                  bytes.substr(place, length + kAround),
                  sum == big_endian(bytes, place + 8 + length, 4)};
}

/// Checks all chunks up to IEND; libpng would report a wrong checksum on stderr.
bool is_whole_png(Bytes bytes) {
  std::size_t i = kPngSignature.size();
  while (const auto chunk = png_chunk(bytes, i)) {
    if (!chunk->sum_agrees) return false;
    if (chunk->kind == "IEND") return true;
    i += chunk->all.size();
  }
  return false;
}

/// Reads decimal numbers up to about `most` in a PNM's header; returns the place behind them.
std::size_t read_pnm_numbers(Bytes bytes, std::span<std::uint64_t> numbers, std::uint64_t most) {
  std::size_t i = 2;
  for (std::uint64_t& number : numbers) {
    while (i < bytes.size() && !is_digit(bytes, i))
      i = bytes[i] == '#' ? std::min(bytes.find('\n', i), bytes.size()) : i + 1;
    for (; i < bytes.size() && is_digit(bytes, i) && number < most; ++i)
      number = number * 10 + (byte_at(bytes, i) - '0');
  }
  return i;
}

bool is_whole_pnm(Bytes bytes) {
  std::array<std::uint64_t, 3> header{};  // width, height, largest value
  const std::size_t pixels = read_pnm_numbers(bytes, header, 1'000'000) + 1;
  const std::uint64_t channels = bytes[1] == '6' ? 3 : 1;
  const std::uint64_t bytes_a_pixel = header[2] > 255 ? 2 * channels : channels;
  return bytes.size() >= pixels + header[0] * header[1] * bytes_a_pixel;
}

/// Checks that a file is complete and its checksums agree, but for TIFF and unknown formats.
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

/// Strips a PNG's color profiles and the like, as libpng reports those it dislikes on stderr.
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

/// Decodes all supported formats. A calibration describes the sensor, so the orientation of Exif
/// metadata is not applied.
cv::Mat decode_by_opencv(Bytes bytes) try {
  std::string needed = without_remarks(bytes);
  const cv::Mat buffer(1, static_cast<int>(needed.size()), CV_8U, needed.data());
  return opencv_imdecode(buffer,
                         cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
} catch (const cv::Exception&) {
  return {};
}

void check_header(const std::string& name, std::string_view bytes) {
  const auto header = read_image_header(bytes);
  if (!header) refuse(name, kUnknownFormat);
  check_image_size(name, header->width, header->height);
  if (header->bits > 16) refuse(name, "found {} bits per channel, expected 8 or 16", header->bits);
}

/// The first segment SOF0 to SOF15; C4, C8 and CC are others.
Header jpeg_header(Bytes bytes) {
  for (std::uint64_t i = 2; big_endian(bytes, i, 1) == 0xFF;) {
    const std::uint64_t marker = big_endian(bytes, i + 1, 1);
    if (marker == 0xFF) {
      ++i;
      continue;
    }
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker % 4 != 0;
    if (frame || marker == 0xC0)
      return ImageHeader{big_endian(bytes, i + 7, 2), big_endian(bytes, i + 5, 2)};
    i += 2 + big_endian(bytes, i + 2, 2);
  }
  return std::nullopt;
}

Header bmp_header(Bytes bytes) {
  if (little_endian(bytes, 14, 4) == 12)
    return ImageHeader{little_endian(bytes, 18, 2), little_endian(bytes, 20, 2)};
  const std::int64_t height = static_cast<std::int32_t>(little_endian(bytes, 22, 4));
  return ImageHeader{little_endian(bytes, 18, 4),
                     static_cast<std::uint64_t>(std::abs(height))};  // negative: top down
}

Header pnm_header(Bytes bytes) {
  std::array<std::uint64_t, 2> size{};
  read_pnm_numbers(bytes, size, 1'000'000'000);
  return ImageHeader{size[0], size[1]};
}

Header tiff_header(Bytes bytes, ByteOrder order) {
  const auto at = [&](std::uint64_t place, std::size_t count) {
    return number_at(bytes, place, count, order);
  };
  ImageHeader header;
  const std::uint64_t directory = at(4, 4);
  for (std::uint64_t k = 0; k < at(directory, 2); ++k) {
    const std::uint64_t entry = directory + 2 + 12 * k;
    const bool two_bytes = at(entry + 2, 2) == 3;
    const bool elsewhere = at(entry + 4, 4) > (two_bytes ? 2 : 1);
    const std::uint64_t value = at(elsewhere ? at(entry + 8, 4) : entry + 8, two_bytes ? 2 : 4);
    const std::uint64_t tag = at(entry, 2);
    if (tag == 256 || tag == 322) header.width = std::max(header.width, value);  // image, tile
    if (tag == 257 || tag == 323) header.height = std::max(header.height, value);
    if (tag == 258) header.bits = static_cast<int>(std::min<std::uint64_t>(value, 1000));
  }
  return header;
}

Header webp_header(Bytes bytes) {
  const Bytes kind = bytes.substr(12, 4);
  if (kind == "VP8X")
    return ImageHeader{little_endian(bytes, 24, 3) + 1, little_endian(bytes, 27, 3) + 1};
  if (kind == "VP8L" && little_endian(bytes, 20, 1) == 0x2F) {
    const std::uint64_t packed = little_endian(bytes, 21, 4);
    return ImageHeader{(packed & 0x3FFF) + 1, (packed >> 14 & 0x3FFF) + 1};
  }
  if (kind != "VP8 " || big_endian(bytes, 23, 3) != 0x9D012A) return std::nullopt;
  return ImageHeader{little_endian(bytes, 26, 2) & 0x3FFF, little_endian(bytes, 28, 2) & 0x3FFF};
}

Header any_header(Bytes bytes) {
  if (bytes.starts_with(kPngSignature))
    return ImageHeader{big_endian(bytes, 16, 4), big_endian(bytes, 20, 4)};
  if (bytes.starts_with(kJpegSignature)) return jpeg_header(bytes);
  if (bytes.starts_with("BM")) return bmp_header(bytes);
  if (bytes.starts_with(Bytes("II*\0", 4))) return tiff_header(bytes, ByteOrder::little);
  if (bytes.starts_with(Bytes("MM\0*", 4))) return tiff_header(bytes, ByteOrder::big);
  if (bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP") return webp_header(bytes);
  const bool pnm = bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' &&
                   std::isspace(static_cast<int>(byte_at(bytes, 2))) != 0;
  return pnm ? pnm_header(bytes) : std::nullopt;
}

/// Estimates the bits from the brightest pixel; cameras with 10 or 12 bits store 16.
int significant_bits(const cv::Mat& image) {
  if (image.depth() == CV_8U) return 8;
  double largest = 0;
  cv::minMaxLoc(image.reshape(1), nullptr, &largest);
  for (const int bits : {10, 12, 14})
    if (largest < std::exp2(bits)) return bits;
  return 16;
}

/// Returns the bits of a recording whose first image has 16: the first one may be dark.
int significant_bits(const ReadImage& read, const cv::Mat& first, int count) {
  constexpr int kSamples = 5;
  int bits = significant_bits(first);
  for (int i = 1; i < kSamples && first.depth() != CV_8U; ++i) {
    try {
      bits = std::max(bits, significant_bits(read(i * (count - 1) / (kSamples - 1)).image));
    } catch (const InputError&) {  // a window that contains the image reports it
    }
  }
  return bits;
}

/// An image that needs more bits than those sampled is scaled by its own, which is better than
/// white.
cv::Mat to_8_bits(const cv::Mat& image, int sampled_bits) {
  if (image.depth() == CV_8U) return image;
  const int bits = std::max(sampled_bits, significant_bits(image));
  cv::Mat reduced;
  image.convertTo(reduced, CV_8U, 255 / (std::exp2(bits) - 1));
  return reduced;
}

bool has_number(const fs::path& file) {
  return file.stem().string().find_first_of(kDigits) != std::string::npos;
}

/// Returns a key that sorts files by the numbers in their names, 2.png before 10.png, then by their
/// names.
std::pair<std::vector<int>, std::string> natural_key(const fs::path& file) {
  std::string name = file.filename().string();
  std::vector<int> key;
  key.reserve(name.size() + 2);
  for (std::size_t i = 0; i < name.size();) {
    const std::size_t end = std::min(name.find_first_not_of(kDigits, i), name.size());
    if (end == i) {
      key.push_back(name[i++]);
      continue;
    }
    const Bytes digits = Bytes(name).substr(i, end - i);
    const Bytes number = digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
    key.insert(key.end(), {'0', static_cast<int>(number.size())});  // longer numbers are larger
    key.insert(key.end(), number.begin(), number.end());
    i = end;
  }
  return {std::move(key), std::move(name)};
}

}  // namespace

void* find_in_imgcodecs(const char* name) {
  static void* const library = load_library(GPO_IMGCODECS);
  void* const address = find_symbol(library, name);
  if (address == nullptr) refuse_symbol(GPO_IMGCODECS, name);
  return address;
}

void check_image_size(const std::string& name, std::uint64_t width, std::uint64_t height) {
  constexpr std::uint64_t kLongestSide = 65'535;
  const std::uint64_t most = limits().image_pixels;
  if (width <= kLongestSide && height <= kLongestSide && width * height <= most) return;
  refuse_size(name,
              fmt::format("an image of {}x{}", width, height),
              fmt::format("at most {} million pixels", most / 1'000'000));
}

cv::Mat read_image(const fs::path& file) { return decode_image(read_file(file), file.string()); }

cv::Mat decode_image(std::string_view bytes, const std::string& name) {
  if (!is_whole_image(bytes)) refuse(name, "the image is truncated or broken");
  check_header(name, bytes);
  cv::Mat image;
  if (bytes.starts_with(kPngSignature)) image = decode_png(bytes);
  if (bytes.starts_with(kJpegSignature)) image = decode_jpeg(bytes);
  if (image.empty()) image = decode_by_opencv(bytes);
  if (image.empty() || image.depth() > CV_16U || image.depth() == CV_8S)
    refuse(name, kUnknownFormat);
  return image;
}

/// Walks through the segments of a JPEG, whose thumbnail has an end marker, too.
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

std::optional<ImageHeader> read_image_header(std::string_view bytes) {
  const Header header = bytes.size() < 12 ? std::nullopt : any_header(bytes);
  return header && header->width > 0 && header->height > 0 ? header : std::nullopt;
}

void check_size(const fs::path& file, cv::Size size, const Camera& camera, const char* expected) {
  if (camera.width == 0 || size == cv::Size(camera.width, camera.height)) return;
  refuse(file,
         "found an image of {}x{}, expected {} {}x{}",
         size.width,
         size.height,
         expected,
         camera.width,
         camera.height);
}

std::shared_ptr<const FrameCache> cache_images(int count,
                                               const ReadImage& read,
                                               Camera& camera,
                                               std::size_t cache_bytes) {
  const auto [first, first_name] = read(0);
  const char* expected = camera.width == 0 ? "the first image's resolution" : kCalibratedResolution;
  check_size(first_name, first.size(), camera, expected);
  camera.width = first.cols;
  camera.height = first.rows;
  const auto decode =
      [read, camera, expected, bits = significant_bits(read, first, count)](int index) {
        const auto [image, name] = read(index);
        check_size(name, image.size(), camera, expected);
        return to_8_bits(image, bits);
      };
  return std::make_shared<const FrameCache>(count, decode, cache_bytes);
}

void add_image_files(Recording& recording,
                     const std::vector<fs::path>& files,
                     std::size_t cache_bytes) {
  const auto read = [files](int index) {
    return NamedImage{read_image(files[index]), files[index].string()};
  };
  recording.image_files = files;
  recording.images =
      cache_images(static_cast<int>(files.size()), read, recording.camera, cache_bytes);
}

std::vector<fs::path> numbered_images(const fs::path& folder) {
  std::vector<fs::path> files = files_of_kind(folder, FileKind::image);
  std::erase_if(files, std::not_fn(has_number));
  std::ranges::sort(files, {}, natural_key);
  return files;
}

std::vector<FoundFile> unreadable_images(const fs::path& folder) {
  std::vector<FoundFile> found;
  std::error_code error, none;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const fs::path& file = entry->path();
    if (!is_image_name(file) || !has_number(file) || entry->is_regular_file(none)) continue;
    const char* reason = entry->is_directory(none)                         ? "a folder"
                         : entry->is_symlink(none) && !entry->exists(none) ? "a broken link"
                                                                           : "not a file";
    found.push_back({file, "", reason});
  }
  std::ranges::sort(found, {}, [](const FoundFile& one) { return natural_key(one.file); });
  return found;
}

cv::Mat gray_if_gray(const cv::Mat& bgr) {
  cv::Mat channels[3];
  cv::split(bgr, channels);
  const bool gray = cv::norm(channels[0], channels[1], cv::NORM_INF) == 0 &&
                    cv::norm(channels[1], channels[2], cv::NORM_INF) == 0;
  return gray ? channels[0] : bgr;
}

}  // namespace gpo
