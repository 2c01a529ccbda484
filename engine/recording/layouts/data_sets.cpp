// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/geometry/decompositions.h"
#include "engine/recording/companions/colmap_model.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/layouts/open_recording.h"

#include <algorithm>
#include <limits>

#include <Eigen/LU>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

using Poses = std::vector<std::optional<Pose>>;
using Files = std::vector<fs::path>;
using Json = nlohmann::ordered_json;

/// Poses of images in the files of one data set.
struct DataSet {
  const char* name;
  /// Returns the file of poses; nullopt if the folder is of no such data set.
  std::optional<fs::path> (*find)(const fs::path& folder, const Files& images);
  /// Returns one pose for each image. Throws InputError.
  Poses (*read)(const fs::path& file, const Files& images);
};

/// Returns the first 12 of row-major numbers as a rigid transformation; nullopt if they are none,
/// as those of frames that were not tracked.
std::optional<Pose> pose_of(std::span<const double> T) {
  constexpr double kTolerance = 1e-2;  // for files with few digits
  Pose pose;
  for (int row = 0; row < 3; ++row) {
    pose.R_wc.row(row) << T[4 * row], T[4 * row + 1], T[4 * row + 2];
    pose.p_wc[row] = T[4 * row + 3];
  }
  const Eigen::Matrix3d& R = pose.R_wc;
  const Eigen::Array33d skew = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs();
  if (!pose.p_wc.allFinite() || !(skew < kTolerance).all() || R.determinant() < 0)
    return std::nullopt;
  pose.R_wc = nearest_rotation(R);
  return pose;
}

std::vector<double> numbers_of(std::string_view line, const std::string& place) {
  std::vector<double> values;
  while (!line.empty()) {
    const std::string_view word = take_word(line);
    const auto value = parse_number(word);
    if (!value && !is_not_finite(word)) fail_at(place, "no number", "numbers separated by blanks");
    values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return values;
}

/// Returns the poses. Throws InputError if there are matrices and none of them is a pose.
Poses with_a_pose(Poses poses, const std::string& first_place) {
  const auto has_pose = [](const auto& pose) { return pose.has_value(); };
  if (!poses.empty() && std::ranges::none_of(poses, has_pose))
    fail_at(first_place, "a matrix that is no pose", "a rotation and a translation");
  return poses;
}

/// Reads one matrix of `count` numbers in each row, one for each image.
Poses rows_of(const fs::path& file, std::size_t count, const Files& images) {
  Poses poses;
  std::string first_place;
  const std::string text = read_file(file);
  TextLines lines(text);
  while (const auto line = lines.next()) {
    if (line->empty()) continue;
    const std::string place = place_in(file, lines.number());
    if (poses.empty()) first_place = place;
    const auto values = numbers_of(*line, place);
    if (values.size() != count)
      fail_at(place, counted(values.size(), "number"), fmt::format("{} of a pose", count));
    poses.push_back(pose_of(values));
  }
  if (poses.size() != images.size())
    fail_at(
        file, counted(poses.size(), "pose"), fmt::format("{}, one for each image", images.size()));
  return with_a_pose(std::move(poses), first_place);
}

std::optional<fs::path> find_kitti(const fs::path& folder, const Files& /*images*/) {
  if (!is_file(folder / "calib.txt") && !is_file(folder / "times.txt")) return std::nullopt;
  if (auto file = if_file(folder / "poses.txt")) return file;
  const fs::path sequence = fs::absolute(folder).lexically_normal();
  const fs::path clean = sequence.has_filename() ? sequence : sequence.parent_path();
  return if_file(clean.parent_path().parent_path() / "poses" /
                 (clean.filename().string() + ".txt"));
}

Poses read_kitti_poses(const fs::path& file, const Files& images) {
  return rows_of(file, 12, images);
}

std::optional<fs::path> find_replica(const fs::path& folder, const Files& /*images*/) {
  return if_file(folder / "traj.txt");
}

Poses read_replica(const fs::path& file, const Files& images) { return rows_of(file, 16, images); }

/// "frame-000000.pose.txt" of "frame-000000.color.png".
fs::path seven_scenes_pose(const fs::path& image) {
  const fs::path frame = image.stem().stem();
  return image.parent_path() / (frame.string() + ".pose.txt");
}

std::optional<fs::path> find_seven_scenes(const fs::path& /*folder*/, const Files& images) {
  return if_file(seven_scenes_pose(images.front()));
}

Poses read_seven_scenes(const fs::path& first, const Files& images) {
  Poses poses;
  for (const fs::path& image : images) {
    const fs::path file = seven_scenes_pose(image);
    if (!is_file(file)) {
      poses.emplace_back();
      continue;
    }
    std::string text = read_file(file, limits().hand_bytes);
    std::ranges::replace_if(
        text, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
    const auto values = numbers_of(trimmed(text), file.string());
    if (values.size() != 16) fail_at(file, counted(values.size(), "number"), "16 (a 4x4 matrix)");
    poses.push_back(pose_of(values));
  }
  return with_a_pose(std::move(poses), first.string());
}

/// Returns the poses of the images with the same name, or with the same end of it.
Poses by_name(const NamedPoses& named, const Files& images, const fs::path& file) {
  std::map<std::string, Pose> pose_of_name;
  for (std::size_t i = 0; i < named.names.size(); ++i)
    pose_of_name[fs::path(named.names[i]).filename().string()] = named.poses[i];
  Poses poses;
  bool any = false;
  for (const fs::path& image : images) {
    const auto found = pose_of_name.find(image.filename().string());
    poses.push_back(found == pose_of_name.end() ? std::nullopt : std::optional(found->second));
    any = any || poses.back();
  }
  if (!any) fail_at(file, "no pose of these images", "their names");
  return poses;
}

std::optional<fs::path> find_colmap(const fs::path& folder, const Files& /*images*/) {
  for (const char* model : {"sparse/0", "sparse", "colmap/sparse/0", "."})
    for (const char* name : {"images.bin", "images.txt"})
      if (auto file = if_file(folder / model / name)) return file;
  return std::nullopt;
}

Poses read_colmap(const fs::path& file, const Files& images) {
  return by_name(read_colmap_poses(file, read_file(file)), images, file);
}

std::optional<fs::path> find_nerfstudio(const fs::path& folder, const Files& /*images*/) {
  return if_file(folder / "transforms.json");
}

/// Poses have OpenGL's axes: y up, z backward.
Poses read_nerfstudio_poses(const fs::path& file, const Files& images) {
  const Json json = read_json(file);
  if (!json.is_object() || !json.contains("frames") || !json["frames"].is_array())
    fail_at(file, "no list `frames`", "images and their poses");
  NamedPoses named;
  int number = 1;
  for (const Json& frame : json["frames"]) {
    const std::string place = fmt::format("{}: frame {}", file.string(), number);
    const bool whole = frame.is_object() && frame.contains("file_path") &&
                       frame["file_path"].is_string() && frame.contains("transform_matrix");
    if (!whole) fail_at(place, "no `file_path` or `transform_matrix`", "both");
    std::vector<double> T;
    for (const Json& value : frame["transform_matrix"].flatten()) {
      if (!value.is_number()) fail_at(place, "no number", "a 4x4 matrix");
      T.push_back(value.get<double>());
    }
    if (T.size() != 16) fail_at(place, counted(T.size(), "number"), "16 (a 4x4 matrix)");
    auto pose = pose_of(T);
    ++number;
    if (!pose) continue;
    pose->R_wc = pose->R_wc * Eigen::Vector3d(1, -1, -1).asDiagonal();
    named.names.push_back(frame["file_path"].get<std::string>());
    named.poses.push_back(*pose);
  }
  return by_name(named, images, file);
}

constexpr auto kDataSets =
    std::to_array<DataSet>({{"7-Scenes", find_seven_scenes, read_seven_scenes},
                            {"KITTI", find_kitti, read_kitti_poses},
                            {"Replica", find_replica, read_replica},
                            {"nerfstudio", find_nerfstudio, read_nerfstudio_poses},
                            {"COLMAP", find_colmap, read_colmap}});

}  // namespace

void add_data_set_truth(Recording& recording, const fs::path& folder) {
  if (recording.truth || recording.image_files.size() < 2) return;
  for (const DataSet& set : kDataSets) {
    const auto file = set.find(folder, recording.image_files);
    if (!file) continue;
    try {
      recording.truth = GroundTruth{fmt::format("{} ({})", file->filename().string(), set.name),
                                    set.read(*file, recording.image_files)};
      const auto& poses = recording.truth->poses;
      if (const auto without = std::ranges::count_if(poses, [](const auto& pose) { return !pose; });
          without > 0)
        recording.notes.push_back(
            fmt::format("{} of {} images have no pose in the ground truth", without, poses.size()));
      recording.truth->jumps = jumps_of(recording.timestamps_ns, poses);
      recording.files.push_back({*file, fmt::format("ground truth ({})", set.name), ""});
      return;
    } catch (const InputError& error) {
      recording.files.push_back({*file, "", error.what()});
      recording.notes.push_back(fmt::format("no ground truth from {}: {}", set.name, error.what()));
    }
  }
}

}  // namespace gpo
