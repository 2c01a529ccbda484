// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/file_kinds.h"

#include "engine/files/text_file.h"
#include "engine/recording/refuse.h"

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using Ending = std::string_view;

constexpr std::array<Ending, 10> kImages = {
    "png", "jpg", "jpeg", "bmp", "pgm", "ppm", "tif", "tiff", "webp", "pnm"};
constexpr std::array<Ending, 4> kVideos = {"mp4", "avi", "mov", "mkv"};
constexpr std::array<Ending, 3> kBags = {"bag", "db3", "mcap"};

bool ends_in(const std::filesystem::path& file, std::span<const Ending> endings) {
  const std::string ending = lower_case(file.extension().string());
  return !ending.empty() && std::ranges::find(endings, Ending(ending).substr(1)) != endings.end();
}

}  // namespace

bool is_image_name(const std::filesystem::path& file) { return ends_in(file, kImages); }
bool is_video_name(const std::filesystem::path& file) { return ends_in(file, kVideos); }
bool is_bag_name(const std::filesystem::path& file) { return ends_in(file, kBags); }

std::string recording_endings() {
  return fmt::format("{}, {}", fmt::join(kVideos, ", "), fmt::join(kBags, ", "));
}

bool is_yaml_name(const std::filesystem::path& file) {
  return file.extension() == ".yaml" || file.extension() == ".yml";
}

bool is_recipe(const std::filesystem::path& path) { return is_yaml_name(path) && is_file(path); }

std::vector<std::filesystem::path> files_of_kind(
    const std::filesystem::path& folder, bool (*is_kind)(const std::filesystem::path& file)) {
  std::vector<std::filesystem::path> files = files_in(folder);
  std::erase_if(files, std::not_fn(is_kind));
  std::ranges::sort(files);
  return files;
}

std::optional<std::filesystem::path> only_file(const std::vector<std::filesystem::path>& files,
                                               const char* things,
                                               const std::filesystem::path& folder) {
  if (files.size() > 1)
    refuse(folder,
           "found {} {} ({}, {}{}), expected one; name the file to open",
           files.size(),
           things,
           files[0].filename().string(),
           files[1].filename().string(),
           files.size() > 2 ? ", ..." : "");
  return files.empty() ? std::nullopt : std::optional(files[0]);
}
}  // namespace gpo
