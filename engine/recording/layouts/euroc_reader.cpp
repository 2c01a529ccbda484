// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/window/timestamps.h"

#include <algorithm>

namespace gpo {
namespace {

struct ImageList {
  std::vector<std::int64_t> timestamps_ns;
  std::vector<fs::path> files;
  std::vector<FoundFile> unreadable;
  std::optional<CsvTable> table;
};

constexpr double kHighestFrameRate_hz = 2000;
constexpr double kHighestSampleRate_hz = 20'000;

/// Throws InputError if nanoseconds would mean a higher rate than that of any sensor. Nanoseconds
/// since 1970 are right in any case: a stream may deliver its images in bursts.
void check_unit(const fs::path& file, const std::vector<std::int64_t>& times_ns, double most_hz) {
  constexpr std::int64_t kYear2000_ns = 946'684'800'000'000'000;
  const std::int64_t step_ns = median_period_ns(times_ns);
  if (rate_hz(times_ns) <= most_hz || times_ns.front() > kYear2000_ns) return;
  constexpr std::int64_t kShortestInMicroseconds = 200;  // 5 kHz; 5 Hz in milliseconds
  refuse(file,
         "found time stamps {} apart, which in nanoseconds are {:.4g} Hz. Expected nanoseconds; "
         "are its time stamps in {}?",
         step_ns,
         rate_hz(times_ns),
         step_ns <= kShortestInMicroseconds ? "milliseconds" : "microseconds");
}

ImageList listed_images(const CsvTable& table, TimeUnit unit, const fs::path& folder) {
  ImageList list;
  list.timestamps_ns = csv_time_stamps(table, unit);
  list.files.reserve(table.rows.size());
  for (const auto& row : table.rows) list.files.push_back(folder / csv_cell(table, row, 1));
  list.table = std::move(table);
  return list;
}

ImageList named_images(const fs::path& cam) {
  ImageList list;
  list.files = numbered_images(cam / "data");
  list.unreadable = unreadable_images(cam / "data");
  for (const auto& file : list.files) {
    const auto time = parse_integer(file.stem().string());
    if (!time || (!list.timestamps_ns.empty() && *time <= list.timestamps_ns.back()))
      refuse(file,
             "cam0/data.csv is missing, so that the name must be a time stamp in "
             "nanoseconds, later than the one before");
    list.timestamps_ns.push_back(*time);
  }
  return list;
}

ImageList read_image_list(const fs::path& folder) {
  const fs::path cam = folder / "cam0";
  if (!is_file(cam / "data.csv") && is_folder(cam / "data"))
    if (auto named = named_images(cam); !named.files.empty()) return named;
  return listed_images(read_csv(cam / "data.csv", {"timestamp", ""}, CsvColumns::at_least),
                       TimeUnit::nanoseconds,
                       cam / "data");
}

void add_images(Recording& recording, ImageList list, const OpenOptions& options) {
  recording.timestamps_ns = std::move(list.timestamps_ns);
  report_left_out(recording, list.unreadable);
  const auto missing = std::ranges::find_if_not(list.files, is_file);
  if (missing == list.files.end()) {
    add_image_files(recording, list.files, options.cache_bytes);
  } else if (!options.tracks) {
    csv_fail(*list.table,
             list.table->rows[missing - list.files.begin()].line,
             "a missing image",
             "the file " + missing->string());
  }
  if (options.tracks) recording.tracks = read_tracks(*options.tracks, recording.frame_count());
}

std::optional<fs::path> truth_folder(const fs::path& folder) {
  for (const char* name : {"state_groundtruth_estimate0", "mocap0", "vicon0"})
    if (is_file(folder / name / "data.csv")) return folder / name;
  return std::nullopt;
}

std::optional<Eigen::Vector3d> add_truth(Recording& recording, const fs::path& folder) {
  const auto source = truth_folder(folder);
  if (!source) {
    recording.truth = truth_beside(folder, recording.timestamps_ns);
    return std::nullopt;
  }
  PosePath path = read_euroc_path(*source / "data.csv");
  TruthMounting mounting{recording.T_body_camera.value_or(Pose{})};
  if (const auto sensor = if_file(*source / "sensor.yaml")) {
    read_truth_clock(*sensor, path, mounting);
    if (const auto T_BS = find(load_yaml(*sensor), "T_BS"))
      mounting.T_measured_camera = inverse(rigid_motion(*T_BS)) * mounting.T_measured_camera;
  }
  recording.truth = camera_truth(
      path, mounting, (source->filename() / "data.csv").string(), recording.timestamps_ns);
  recording.truth->upright = mounting.upright.value_or(true);  // convention of motion capture
  return path.mean_gyro_bias_rad_s;
}

void add_gyroscope(Recording& recording,
                   const fs::path& folder,
                   std::int64_t time_offset_ns,
                   const std::optional<Eigen::Vector3d>& true_mean_bias_rad_s) {
  const auto file = if_file(folder / "imu0" / "data.csv");
  if (!file) return;
  Gyroscope gyroscope = read_gyroscope(*file, TimeUnit::nanoseconds);
  check_unit(*file, gyroscope.timestamps_ns, kHighestSampleRate_hz);
  ImuCalibration imu;
  if (const auto sensor = if_file(folder / "imu0" / "sensor.yaml")) {
    imu = read_imu_calibration(*sensor);
  } else {
    recording.notes.emplace_back(
        "no imu0/sensor.yaml: assuming that the gyroscope has the body's axes");
  }
  const Eigen::Matrix3d R_body_gyro = imu.R_body_gyro.value_or(Eigen::Matrix3d::Identity());
  gyroscope.R_gyro_camera = R_body_gyro.transpose() * recording.T_body_camera.value_or(Pose{}).R_wc;
  gyroscope.time_offset_ns = time_offset_ns;
  set_bias(gyroscope, imu, "imu0/sensor.yaml");
  if (!imu.bias_rad_s && true_mean_bias_rad_s) {
    gyroscope.bias_rad_s = *true_mean_bias_rad_s;
    gyroscope.bias_known = true;
    gyroscope.bias_source = "mean of the ground truth";
  }
  recording.gyroscope = std::move(gyroscope);
}

/// Searches the calibration; TUM-VI has Kalibr's in `dso`, beside mav0.
CalibrationSearch calibration_of(const fs::path& folder) {
  const fs::path outer = folder.filename() == "mav0" ? folder.parent_path() : folder;
  CalibrationSearch search = search_calibration({folder / "cam0", folder, outer, outer / "dso"});
  const fs::path cam = folder / "cam0" / "sensor.yaml";
  if (const auto usual = first_file(
          {cam, folder / "camera.yaml", outer / "camera.yaml", outer / "dso" / "camchain.yaml"}))
    search.file = usual;
  if (!search.file) search.file = cam;  // reading it reports that it is missing
  std::erase_if(search.unused, [&](const FoundFile& one) { return one.file == *search.file; });
  return search;
}

}  // namespace

std::optional<fs::path> find_euroc(const fs::path& folder) {
  for (const fs::path& base : {folder, folder / "mav0"})
    if (is_folder(base / "cam0")) return base;
  return std::nullopt;
}

bool euroc_lacks_images(const fs::path& folder) {
  const ImageList list = read_image_list(folder);
  return std::ranges::none_of(list.files, is_file);
}

Recording read_euroc(const fs::path& folder, const OpenOptions& options) {
  Recording recording;
  const CalibrationSearch search = calibration_of(folder);
  const fs::path calibration_file = *search.file;
  const auto calibration = read_calibration(calibration_file);
  report_calibration(recording, search, calibration);
  recording.camera = calibration.camera;
  recording.T_body_camera = calibration.T_body_camera;
  add_images(recording, read_image_list(folder), options);
  const fs::path list = folder / "cam0" / "data.csv";
  check_unit(is_file(list) ? list : folder / "cam0" / "data",
             recording.timestamps_ns,
             kHighestFrameRate_hz);
  take_source(recording, calibration);
  check_image_size(recording, calibration_file);
  const auto mean_bias = add_truth(recording, folder);
  add_gyroscope(recording, folder, calibration.time_offset_ns, mean_bias);
  if (!calibration.T_body_camera && (recording.gyroscope || recording.truth))
    recording.notes.push_back("no T_BS in " + calibration_file.filename().string() +
                              ": assuming that the camera has the body's axes");
  return recording;
}

std::optional<fs::path> find_tum(const fs::path& folder) {
  return is_file(folder / "rgb.txt") ? std::optional(folder) : std::nullopt;
}

Recording read_tum(const fs::path& folder, const OpenOptions& options) {
  Recording recording;
  ImageList list = listed_images(
      read_csv(folder / "rgb.txt", {"timestamp", ""}, CsvColumns::exactly, Separator::blanks),
      TimeUnit::seconds,
      folder);
  const CalibrationSearch search = search_calibration({folder});
  const Calibration calibration = search.file ? read_calibration(*search.file) : Calibration{};
  report_calibration(recording, search, calibration);
  recording.camera = calibration.camera;
  add_images(recording, std::move(list), options);
  if (!search.file) {
    const auto& files = recording.image_files;
    guess_camera(recording, files.empty() ? std::nullopt : stored_view(files.front()));
  }
  take_source(recording, calibration);
  check_image_size(recording, search.file.value_or(folder / "camera.yaml"));
  recording.truth = truth_beside(folder, recording.timestamps_ns);
  return recording;
}

}  // namespace gpo
