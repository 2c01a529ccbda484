// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/picture_files.h"

#include "engine/error.h"
#include "engine/recording/text_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include <opencv2/imgcodecs.hpp>

namespace gpo {

namespace {

using Bytes = std::string_view;

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

std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xEDB88320U ^ (c >> 1) : c >> 1;
    table[n] = c;
  }
  return table;
}

std::uint32_t crc32(Bytes bytes) {
  static const auto kTable = crc_table();
  std::uint32_t c = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    c = kTable[(c ^ static_cast<unsigned char>(byte)) & 0xFF] ^ (c >> 8);
  }
  return ~c;
}

/// Walks the chunks of a PNG up to IEND and checks their sums; libpng would complain on stderr.
bool is_whole_png(Bytes bytes) {
  std::size_t i = 8;
  while (i + 12 <= bytes.size()) {
    const std::size_t length = big_endian(bytes, i, 4);
    if (length > bytes.size() - i - 12) return false;
    if (crc32(bytes.substr(i + 4, length + 4)) != big_endian(bytes, i + 8 + length, 4)) {
      return false;
    }
    if (bytes.substr(i + 4, 4) == "IEND") return true;
    i += length + 12;
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

/// Cut files are told here, before a library decodes half of them or complains on stderr.
bool is_whole(Bytes bytes) {
  const auto little_endian_4 = [&](std::size_t i) {
    return byte_at(bytes, i) | byte_at(bytes, i + 1) << 8 | byte_at(bytes, i + 2) << 16 |
           byte_at(bytes, i + 3) << 24;
  };
  constexpr std::size_t kShortest = 12;
  if (bytes.size() < kShortest) return false;
  if (bytes.starts_with("\xFF\xD8")) return is_whole_jpeg(bytes);
  if (bytes.starts_with("\x89PNG\r\n\x1A\n")) return is_whole_png(bytes);
  if (bytes.starts_with("P5") || bytes.starts_with("P6")) return is_whole_pnm(bytes);
  if (bytes.starts_with("BM")) return bytes.size() >= little_endian_4(2);
  if (bytes.starts_with("RIFF")) return bytes.size() >= little_endian_4(4);
  return true;
}

/// Numbers in a name are compared as numbers, whatever their count of digits.
bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  const auto digits_at = [](const std::string& text, std::size_t from) {
    std::size_t end = from;
    while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) ++end;
    return text.substr(from, end - from);
  };
  while (i < a.size() && j < b.size()) {
    std::string number_a = digits_at(a, i);
    std::string number_b = digits_at(b, j);
    if (number_a.empty() || number_b.empty()) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    i += number_a.size();
    j += number_b.size();
    number_a.erase(0, std::min(number_a.find_first_not_of('0'), number_a.size()));
    number_b.erase(0, std::min(number_b.find_first_not_of('0'), number_b.size()));
    if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
    if (number_a != number_b) return number_a < number_b;
  }
  if (i < a.size() || j < b.size()) return i == a.size();
  return a < b;
}

}  // namespace

cv::Mat read_picture(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  if (!is_whole(bytes)) {
    throw InputError(file.string() + ": found a cut or broken picture, expected a whole one");
  }
  cv::Mat picture;
  try {
    const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    picture = cv::imdecode(buffer, cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {
    picture.release();
  }
  if (picture.empty()) {
    throw InputError(file.string() +
                     ": found something that cannot be decoded, expected a picture");
  }
  return picture;
}

void check_size(const std::filesystem::path& file, const cv::Mat& picture, const Camera& camera) {
  if (camera.width == 0) return;
  if (picture.cols == camera.width && picture.rows == camera.height) return;
  const auto shown = [](int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
  };
  throw InputError(file.string() + ": found a picture of " + shown(picture.cols, picture.rows) +
                   ", expected the calibrated resolution " + shown(camera.width, camera.height));
}

std::shared_ptr<const FrameCache> open_picture_files(std::vector<std::filesystem::path> files,
                                                     const Camera& camera,
                                                     std::size_t cache_bytes) {
  const int count = static_cast<int>(files.size());
  const auto decode = [files = std::move(files), camera](int index) {
    cv::Mat picture = read_picture(files[index]);
    check_size(files[index], picture, camera);
    return picture;
  };
  return std::make_shared<const FrameCache>(count, decode, cache_bytes);
}

bool is_picture_name(const std::filesystem::path& file) {
  const std::string ending = lower_case(file.extension().string());
  constexpr std::array<const char*, 10> kEndings = {
      ".png", ".jpg", ".jpeg", ".bmp", ".pgm", ".ppm", ".tif", ".tiff", ".webp", ".pnm"};
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

std::vector<std::filesystem::path> numbered_pictures(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    const bool numbered = stem.find_first_of("0123456789") != std::string::npos;
    if (numbered && is_picture_name(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

}  // namespace gpo
