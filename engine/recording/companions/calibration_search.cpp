// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/recording/companions/lens_formats.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

using Names = const char*;  ///< separated by blanks

std::vector<std::string> calibration_names() {
  std::vector<std::string> names;
  constexpr Names kStems =
      "camera sensor camchain-imucam camchain calibration camera_calibration calib intrinsics "
      "out_camera_data";
  for (const std::string& stem : split(kStems, ' '))
    for (const char* extension : {".yaml", ".yml", ".xml", ".json"})
      names.push_back(stem + extension);
  return names;
}

std::string plain_name(const fs::path& file) { return lower_case(file.filename().string()); }
std::string plain_ending(const fs::path& file) { return lower_case(file.extension().string()); }

/// Kalibr adds the bag's name: "camchain-imucam-desk.yaml", "desk-camchain.yaml".
bool is_camchain(const fs::path& file) {
  return plain_name(file).find("camchain") != std::string::npos && plain_ending(file) == ".yaml";
}

bool has_word(const std::string& text, Names words) {
  return std::ranges::any_of(
      split(words, ' '), [&](const auto& word) { return text.find(word) != std::string::npos; });
}

/// Files that have another meaning, and those that only name cameras.
constexpr Names kOthers =
    "board. plane. groundtruth. imu. tracks. timestamps times. traj pose path stamps transforms.t";
constexpr Names kCalibrationNames = "calib intrinsic camera cam_ cam0 cam1 lens camchain";
constexpr Names kCalibrationWords = "distort intrinsic focal fl_x camera_matrix projection_param";

constexpr const char* kColmapBinary = "cameras.bin";

bool is_text(const fs::path& file) {
  const auto endings = {".yaml", ".yml", ".xml", ".json", ".txt", ".ini"};
  return std::ranges::count(endings, plain_ending(file)) > 0;
}

/// Names that announce a calibration.
bool is_named_calibration(const fs::path& file) {
  const std::string name = plain_name(file);
  return has_word(name, kCalibrationNames) && !has_word(name, kOthers) && !is_image_name(file) &&
         !is_video_name(file) && !is_bag_name(file);
}

bool has_other_meaning(const fs::path& file) { return has_word(plain_name(file), kOthers); }

/// Texts without a telling name, such as ROS' ost.txt, are read only if their words announce a
/// calibration. Prose may contain such words, too.
bool is_unnamed_text(const fs::path& file) {
  constexpr Names kProse = "readme license notes changelog";
  constexpr std::uintmax_t kMostBytes = 1 << 16;
  std::error_code none;
  return plain_ending(file) == ".txt" && !is_named_calibration(file) && !has_other_meaning(file) &&
         !has_word(plain_name(file), kProse) && fs::file_size(file, none) <= kMostBytes;
}

std::string without_place(const std::string& message, const fs::path& file) {
  const std::string place = file.string();
  if (!message.starts_with(place)) return message;
  const std::string rest = message.substr(place.size());
  return rest.starts_with(": ") ? rest.substr(2) : "line " + rest.substr(rest.starts_with(':'));
}

bool is_worded_calibration(const std::string& bytes) {
  const std::string lower = lower_case(bytes);
  // Results of this program contain the camera, too.
  return has_word(lower, kCalibrationWords) && !has_word(lower, "\"verdict\"");
}

/// Returns the reason why a file that looks like a calibration cannot be read; empty if it can,
/// nullopt if it does not look like one.
std::optional<std::string> fault_of(const fs::path& file) {
  constexpr std::uintmax_t kMostBytes = 16 << 20;
  bool likely = is_named_calibration(file);
  const bool binary = file.filename() == kColmapBinary;
  std::error_code none;
  const bool readable = (binary || is_text(file)) && fs::file_size(file, none) <= kMostBytes;
  if (!readable)
    return likely ? std::optional<std::string>("not a format that is read") : std::nullopt;
  if (has_other_meaning(file)) return std::nullopt;
  const Examination examination;
  try {
    const std::string bytes = read_file(file);
    likely = likely || binary || is_worded_calibration(bytes);
    if (!likely && plain_ending(file) == ".txt") return std::nullopt;
    const bool known =
        lens_table_of(file, bytes) != nullptr || lens_format_of(load_lens_file(file)) != nullptr;
    likely = likely || known;
    if (!likely) return std::nullopt;
    read_calibration(file);
    return "";
  } catch (const InputError& error) {
    return likely ? std::optional(without_place(error.what(), file)) : std::nullopt;
  }
}

std::optional<fs::path> by_name(const fs::path& folder) {
  const auto files = files_of_kind(folder, is_text);
  for (const std::string& name : calibration_names()) {
    if (is_file(folder / name)) return folder / name;
    const auto other = std::ranges::find(files, name, plain_name);
    if (other != files.end()) return *other;
  }
  const auto chains = files_of_kind(folder, is_camchain);
  return chains.empty() ? std::nullopt : std::optional(chains.front());
}

/// Returns the file that has the camera of this one; nullopt if it has the camera itself.
std::optional<fs::path> camera_file_of(const fs::path& file) {
  try {
    return named_camera_file(load_lens_file(file));
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Reports the file that the calibration itself reads.
void mark_camera_file(CalibrationSearch& search) {
  const auto camera = search.file ? camera_file_of(*search.file) : std::nullopt;
  for (FoundFile& one : search.unused)
    if (camera && one.file == *camera)
      one = {one.file, fmt::format("camera of {}", search.file->filename().string()), ""};
}

void search_folder(const fs::path& folder, CalibrationSearch& search) {
  constexpr std::size_t kMostFiles = 200;
  if (!is_folder(folder)) return;
  const auto named = by_name(folder);
  if (!search.file) search.file = named;
  auto files = files_of_kind(folder, [](const fs::path& file) {
    const bool structured = is_text(file) && plain_ending(file) != ".txt";
    return structured || is_named_calibration(file) || is_unnamed_text(file) ||
           file.filename() == kColmapBinary;
  });
  std::stable_partition(files.begin(), files.end(), std::not_fn(is_unnamed_text));
  files.resize(std::min(files.size(), kMostFiles));
  for (const fs::path& file : files) {
    if (search.file && *search.file == file) continue;
    const auto fault = fault_of(file);
    if (!fault) continue;
    if (fault->empty() && !search.file) {
      search.file = file;
      search.by_content = true;
    } else if (fault->empty() && camera_file_of(file) == search.file) {
      // It has what the camera's file lacks: extrinsics and the time offset.
      search.unused.push_back({*search.file, "", "another file is used"});
      search.file = file;
    } else {
      search.unused.push_back({file, "", fault->empty() ? "another file is used" : *fault});
    }
  }
  mark_camera_file(search);
}

}  // namespace

CalibrationSearch search_calibration(const std::vector<fs::path>& folders) {
  CalibrationSearch search;
  std::set<fs::path> visited;
  for (const fs::path& folder : folders) {
    if (!visited.insert(folder).second) continue;
    search_folder(folder, search);
    for (const char* model : {"sparse/0", "sparse", "colmap/sparse/0"})
      if (!search.file) search_folder(folder / model, search);
  }
  return search;
}

void report_calibration(Recording& recording,
                        const CalibrationSearch& search,
                        const Calibration& calibration) {
  if (search.file)
    recording.files.push_back(
        {*search.file, fmt::format("calibration ({})", calibration.format), ""});
  for (const FoundFile& one : search.unused) {
    recording.files.push_back(one);
    if (!one.use.empty()) continue;
    if (search.file && !search.by_content) continue;  // `info` lists it
    recording.notes.push_back(fmt::format("{} looks like a calibration and is not read: {}",
                                          one.file.filename().string(),
                                          one.reason));
  }
}

}  // namespace gpo
