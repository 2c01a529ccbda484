// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/output_file.h"

#include "engine/error.h"

#include <fstream>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {

namespace fs = std::filesystem;

void check_writable(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder)) {
    throw InputError(fmt::format(
        "{}: cannot be written, there is no folder {}", file.string(), folder.string()));
  }
  if (fs::is_directory(file)) {
    throw InputError(fmt::format("{}: is a folder, expected a file to write", file.string()));
  }
}

void write_file(const fs::path& file, const std::string& content) {
  check_writable(file);
  // A name of its own, because shards on several machines may write the same file at once.
  const fs::path partial = fmt::format("{}.{:08x}.partial", file.string(), std::random_device()());
  std::ofstream stream(partial, std::ios::binary);
  stream << content;
  stream.close();
  std::error_code error;
  if (stream) fs::rename(partial, file, error);
  if (stream && !error) return;
  fs::remove(partial, error);
  throw InputError(fmt::format("{}: cannot be written", file.string()));
}

void write_picture(const fs::path& file, const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", picture, bytes);
  write_file(file, std::string(bytes.begin(), bytes.end()));
}

}  // namespace gpo
