// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/image_files.h"

#include "engine/base/error.h"
#include "engine/files/folder.h"
#include "engine/recording/file_kinds.h"
#include "engine/recording/images/image_file.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

namespace gpo {

namespace {

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

void check_size(const std::filesystem::path& file, cv::Size size, const Camera& camera) {
  if (camera.width == 0 || size == cv::Size(camera.width, camera.height)) return;
  const auto shown = [](int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
  };
  throw InputError(file.string() + ": found a picture of " + shown(size.width, size.height) +
                   ", expected the calibrated resolution " + shown(camera.width, camera.height));
}

void add_image_files(Recording& recording,
                       std::vector<std::filesystem::path> files,
                       std::size_t cache_bytes) {
  const int count = static_cast<int>(files.size());
  const cv::Mat first = read_image(files.front());
  Camera& camera = recording.camera;
  check_size(files.front(), first.size(), camera);
  camera.width = first.cols;
  camera.height = first.rows;
  recording.image_files = files;
  const auto decode = [files = std::move(files), camera, bits = significant_bits(first)](int i) {
    const cv::Mat image = read_image(files[i]);
    check_size(files[i], image.size(), camera);
    return to_8_bits(image, bits);
  };
  recording.images = std::make_shared<const FrameCache>(count, decode, cache_bytes);
}

std::vector<std::filesystem::path> numbered_images(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& file : files_in(folder)) {
    const bool numbered = file.stem().string().find_first_of("0123456789") != std::string::npos;
    if (numbered && is_image_name(file)) files.push_back(file);
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

}  // namespace gpo
