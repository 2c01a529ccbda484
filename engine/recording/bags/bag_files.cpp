// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/refuse.h"
#include "engine/files/yaml_entry.h"
#include "engine/recording/bags/messages.h"
#include "engine/recording/images/images.h"

#include <algorithm>
#include <regex>

namespace gpo {
namespace {

constexpr const char* kMetadata = "metadata.yaml";
constexpr const char* kInformation = "rosbag2_bagfile_information";

/// The list of files in rosbag2's metadata.yaml; without their folders, which may be others now.
std::optional<std::vector<fs::path>> listed_files(const fs::path& folder) {
  const auto file = if_file(folder / kMetadata);
  if (!file) return std::nullopt;
  const YamlEntry root = load_yaml(*file);
  const auto information = root.node.IsMap() ? find(root, kInformation) : std::nullopt;
  if (!information || !information->node.IsMap()) return std::nullopt;
  std::vector<fs::path> files;
  const auto paths = find(*information, "relative_file_paths");
  if (!paths || !paths->node.IsSequence()) return files;
  for (const YAML::Node& path : paths->node)
    if (path.IsScalar()) files.push_back(folder / fs::path(path.Scalar()).filename());
  return files;
}

/// A part's name: rosbag's may have a time of recording before the number.
struct PartName {
  std::string recording;
  int number = 0;
};

std::optional<PartName> part_name(const fs::path& file) {
  static const std::regex kName(
      R"((.*?)(?:_\d{4}-\d\d-\d\d-\d\d-\d\d-\d\d)?_(\d{1,6})(\.(?:bag|db3|mcap)(?:\.zstd)?))");
  std::smatch parts;
  const std::string name = file.filename().string();
  if (!std::regex_match(name, parts, kName)) return std::nullopt;
  return PartName{parts[1].str() + parts[3].str(), std::stoi(parts[2].str())};
}

/// Sorts the parts of one recording, numbered from 0 on. Returns false if they are not.
bool sort_parts(std::vector<fs::path>& files) {
  std::map<int, fs::path> parts;
  std::string recording;
  for (const fs::path& file : files) {
    const auto name = part_name(file);
    if (!name || (!parts.empty() && name->recording != recording)) return false;
    recording = name->recording;
    if (!parts.emplace(name->number, file).second) return false;
  }
  if (parts.begin()->first != 0 || parts.rbegin()->first != static_cast<int>(files.size()) - 1)
    return false;
  files.clear();
  for (const auto& [number, file] : parts) files.push_back(file);
  return true;
}

BagFiles files_in_folder(const fs::path& folder) {
  BagFiles found;
  for (const fs::path& listed : listed_files(folder).value_or(std::vector<fs::path>())) {
    if (const auto file = first_file({listed, listed.string() + ".zstd"}))
      found.files.push_back(*file);
    else
      found.notes.push_back(listed.filename().string() + " is missing, metadata.yaml lists it");
  }
  if (!found.files.empty()) return found;
  std::vector<fs::path> bags = files_of_kind(folder, FileKind::bag);
  if (bags.size() > 1 && sort_parts(bags)) {
    found.notes.push_back(fmt::format("no metadata.yaml: reading {} to {} as one recording",
                                      bags.front().filename().string(),
                                      bags.back().filename().string()));
    found.files = bags;
    return found;
  }
  if (const auto file = only_file(bags, "bags", folder)) found.files = {*file};
  if (found.files.empty())
    refuse(folder, "found none of the files that metadata.yaml lists, expected bags");
  return found;
}

}  // namespace

bool has_bag_metadata(const fs::path& folder) {
  try {
    return listed_files(folder).has_value();
  } catch (const InputError&) {
    return false;
  }
}

BagFiles find_bag_files(const fs::path& path) {
  if (is_folder(path)) return files_in_folder(path);
  BagFiles found{{path}, {}};
  if (!has_bag_metadata(folder_of(path))) return found;
  const auto parts = listed_files(folder_of(path));
  const auto is_this = [&](const fs::path& file) { return file.filename() == path.filename(); };
  if (parts->size() > 1 && std::ranges::any_of(*parts, is_this))
    found.notes.push_back(fmt::format(
        "one of the {} files of a recording: open its folder to read all", parts->size()));
  return found;
}

}  // namespace gpo
