// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "engine/inspection/report/report.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::size_t kMostIgnored = 20;

void add_once(std::vector<FoundFile>& files, FoundFile one) {
  const bool known =
      std::ranges::any_of(files, [&](const FoundFile& other) { return other.file == one.file; });
  if (!known) files.push_back(std::move(one));
}

/// Optional files by their names in all layouts.
std::vector<FoundFile> companions(const Recording& recording, const fs::path& folder) {
  const bool truth = recording.truth && recording.truth->source == "groundtruth.txt";
  std::vector<FoundFile> files;
  const auto add = [&](const char* name, bool read, const char* use) {
    if (const auto file = if_file(folder / name))
      files.push_back({*file, read ? use : "", read ? "" : "another source is used"});
  };
  add("frame_timestamps.txt", recording.layout == "pictures", "times of the images");
  add("groundtruth.txt", truth, "ground truth");
  add("groundtruth.yaml", recording.truth.has_value(), "mounting of the ground truth");
  add("board.yaml", recording.board.has_value(), "board");
  add("plane.yaml", recording.plane.has_value(), "true plane");
  add("tracks.csv", !recording.tracks.empty(), "tracks");
  add("rgb.txt", recording.layout == "TUM RGB-D", "list of the images");
  add("metadata.yaml", recording.layout == "ROS bag", "list of the bags");
  const bool forces = recording.gyroscope && !recording.gyroscope->accelerations_m_s2.empty();
  for (const char* name : {"Accel.txt", "accelerometer.csv"}) add(name, forces, "accelerometer");
  add("imu.yaml", recording.layout == "ROS bag", "bias of the gyroscope");
  return files;
}

std::string images_use(const Recording& recording) {
  const std::size_t count = recording.image_files.size();
  if (recording.layout == "ROS bag") return count == 1 ? "bag" : counted(count, "bag");
  return count == 1 && recording.frame_count() > 1 ? "video" : counted(count, "image");
}

/// Returns whether two names differ in numbers of at least four digits, as a sequence's files do.
bool is_numbered_like(const fs::path& a, const fs::path& b) {
  constexpr std::ptrdiff_t kLeastDigits = 4;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::string one = a.filename().string(), other = b.filename().string();
  if (std::ranges::count_if(one, is_digit) < kLeastDigits) return false;
  for (std::string* name : {&one, &other}) std::erase_if(*name, is_digit);
  return a.parent_path() == b.parent_path() && one == other;
}

/// Adds the files of the folder that no reader reported.
void add_ignored(std::vector<FoundFile>& files,
                 const std::vector<fs::path>& images,
                 const fs::path& folder) {
  std::vector<FoundFile> ignored;
  std::set<fs::path> known(images.begin(), images.end());
  for (const FoundFile& one : files) known.insert(one.members.begin(), one.members.end());
  auto all = files_in(folder);
  std::ranges::sort(all);
  for (const fs::path& file : all) {
    const bool reported = known.contains(file) || std::ranges::any_of(files, [&](const auto& one) {
                            return one.file == file || is_numbered_like(one.file, file);
                          });
    if (!reported) ignored.push_back({file, "", "not a file that this layout reads"});
  }
  const std::size_t more = ignored.size() - std::min(ignored.size(), kMostIgnored);
  ignored.resize(ignored.size() - more);
  files.insert(files.end(), ignored.begin(), ignored.end());
  if (more > 0) files.push_back({folder, "", fmt::format("and {} more files", more)});
}

}  // namespace

std::vector<FoundFile> found_files(const Recording& recording) {
  const bool whole = is_folder(recording.path);
  const fs::path folder = whole ? recording.path : folder_of(recording.path);
  std::vector<FoundFile> files;
  if (!recording.image_files.empty())
    files.push_back({recording.image_files.front(), images_use(recording), ""});
  for (const FoundFile& one : recording.files) add_once(files, one);
  if (recording.gyroscope && !recording.gyroscope->file.empty())
    add_once(files, {recording.gyroscope->file, "gyroscope", ""});
  if (recording.truth)
    for (const fs::path& base : {folder, folder / "mav0"})
      if (const auto file = if_file(base / recording.truth->source))
        add_once(files, {*file, "ground truth", ""});
  for (FoundFile& one : companions(recording, folder)) add_once(files, std::move(one));
  if (whole) add_ignored(files, recording.image_files, folder);
  for (FoundFile& one : files) {
    const fs::path relative = one.file.lexically_relative(folder);
    if (!relative.empty()) one.file = relative;
  }
  return files;
}

std::string to_text(const FoundFile& one) {
  const std::string said = one.use.empty() ? "not read" : one.use;
  return fmt::format(
      "{}: {}{}{}", one.file.string(), said, one.reason.empty() ? "" : ", ", one.reason);
}

}  // namespace gpo
