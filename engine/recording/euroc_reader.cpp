// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/euroc_reader.h"

#include "engine/recording/calibration_file.h"
#include "engine/recording/gyroscope_file.h"
#include "engine/recording/picture_files.h"
#include "engine/recording/tracks_reader.h"
#include "engine/recording/truth_file.h"
#include "engine/recording/yaml_entry.h"

#include <algorithm>
#include <vector>

namespace gpo {

namespace {

namespace fs = std::filesystem;

CsvTable read_picture_list(const fs::path& folder) {
  return read_csv(folder / "cam0" / "data.csv", {"timestamp", ""}, CsvColumns::exactly);
}

fs::path picture_file(const fs::path& folder, const CsvRow& row) {
  return folder / "cam0" / "data" / std::string(row.cells[1]);
}

void add_pictures(Recording& recording,
                  const fs::path& folder,
                  const CsvTable& list,
                  bool may_be_missing,
                  std::size_t cache_bytes) {
  std::vector<fs::path> files;
  for (const auto& row : list.rows) {
    files.push_back(picture_file(folder, row));
    if (fs::is_regular_file(files.back())) continue;
    if (may_be_missing) return;
    csv_fail(list, row.line, "the name of a missing picture", "the file " + files.back().string());
  }
  recording.picture_files = files;
  recording.pictures = open_picture_files(std::move(files), recording.camera, cache_bytes);
}

/// The gyroscope's axes in the body, and its bias and how sure that is, where the sensor's file has
/// them.
struct ImuCalibration {
  Eigen::Matrix3d R_body_gyro = Eigen::Matrix3d::Identity();
  std::optional<Eigen::Vector3d> bias_rad_s;
  std::optional<double> bias_sigma_rad_s;
};

double positive_number(const YamlEntry& entry, const std::string& expected) {
  const double value = number(entry, expected);
  if (value <= 0) yaml_fail(entry, expected);
  return value;
}

ImuCalibration read_imu_calibration(const fs::path& file, std::vector<std::string>& notes) {
  ImuCalibration result;
  if (!fs::exists(file)) {
    notes.emplace_back("no imu0/sensor.yaml: the gyroscope's axes are taken as the body's");
    return result;
  }
  const auto root = load_yaml(file);
  if (const auto T_BS = find(root, "T_BS")) result.R_body_gyro = rigid_motion(*T_BS).R_wc;
  if (const auto bias = find(root, "gyroscope_bias")) {
    const auto b = numbers(*bias, 3, "3 (x, y, z) in rad/s");
    result.bias_rad_s = Eigen::Vector3d(b[0], b[1], b[2]);
  }
  if (const auto sigma = find(root, "gyroscope_bias_sigma"))
    result.bias_sigma_rad_s = positive_number(*sigma, "a positive number in rad/s");
  return result;
}

/// The first of EuRoC's and TUM-VI's names that is there.
std::optional<fs::path> truth_file(const fs::path& folder) {
  for (const char* name : {"state_groundtruth_estimate0", "mocap0"}) {
    const fs::path file = folder / name / "data.csv";
    if (fs::exists(file)) return file;
  }
  return std::nullopt;
}

GroundTruth camera_truth(const BodyPath& path,
                         const fs::path& file,
                         const Pose& T_body_camera,
                         const std::vector<std::int64_t>& times) {
  GroundTruth truth;
  truth.source = (file.parent_path().filename() / file.filename()).string();
  for (const std::int64_t time : times) {
    const auto body = pose_at(path, time);
    truth.poses.push_back(body ? std::optional(*body * T_body_camera) : std::nullopt);
  }
  return truth;
}

void add_gyroscope(Recording& recording,
                   const fs::path& folder,
                   const Calibration& calibration,
                   const std::optional<BodyPath>& path,
                   const Pose& T_body_camera) {
  const fs::path file = folder / "imu0" / "data.csv";
  if (!fs::exists(file)) return;
  Gyroscope gyroscope = read_gyroscope(file, TimeUnit::nanoseconds);
  const auto imu = read_imu_calibration(folder / "imu0" / "sensor.yaml", recording.notes);
  gyroscope.R_gyro_camera = imu.R_body_gyro.transpose() * T_body_camera.R_wc;
  gyroscope.time_offset_ns = calibration.time_offset_ns;
  if (imu.bias_rad_s) {
    gyroscope.bias_rad_s = *imu.bias_rad_s;
    gyroscope.bias_source = "imu0/sensor.yaml";
  } else if (path && path->mean_gyro_bias_rad_s) {
    gyroscope.bias_rad_s = *path->mean_gyro_bias_rad_s;
    gyroscope.bias_source = "mean of the ground truth's";
  }
  if (imu.bias_sigma_rad_s) gyroscope.bias_sigma_rad_s = *imu.bias_sigma_rad_s;
  recording.gyroscope = std::move(gyroscope);
}

fs::path calibration_of(const fs::path& folder) {
  fs::path own = folder / "cam0" / "sensor.yaml";
  fs::path beside = folder / "camera.yaml";
  return !fs::exists(own) && fs::exists(beside) ? beside : own;
}

}  // namespace

bool euroc_lacks_pictures(const fs::path& folder) {
  const CsvTable list = read_picture_list(folder);
  return std::none_of(list.rows.begin(), list.rows.end(), [&](const CsvRow& row) {
    return fs::is_regular_file(picture_file(folder, row));
  });
}

Recording read_euroc(const fs::path& folder,
                     const std::optional<fs::path>& tracks,
                     std::size_t cache_bytes) {
  Recording recording;
  const auto calibration = read_calibration(calibration_of(folder));
  recording.camera = calibration.camera;
  const CsvTable list = read_picture_list(folder);
  recording.timestamps_ns = csv_time_stamps(list, TimeUnit::nanoseconds);
  add_pictures(recording, folder, list, tracks.has_value(), cache_bytes);
  recording.layout = recording.pictures ? Layout::euroc : Layout::tracks;
  if (tracks) recording.tracks = read_tracks(*tracks, recording.frame_count());

  const Pose T_body_camera = calibration.T_body_camera.value_or(Pose{});
  std::optional<BodyPath> path;
  if (const auto file = truth_file(folder)) {
    path = read_body_path(*file);
    recording.truth = camera_truth(*path, *file, T_body_camera, recording.timestamps_ns);
  }
  add_gyroscope(recording, folder, calibration, path, T_body_camera);
  if (!calibration.T_body_camera && (recording.gyroscope || recording.truth)) {
    recording.notes.push_back("no T_BS in " + calibration_of(folder).filename().string() +
                              ": the camera's axes are taken as the body's");
  }
  return recording;
}

}  // namespace gpo
