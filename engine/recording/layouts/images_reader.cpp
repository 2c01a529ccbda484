// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/loggers/logs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gpo {
namespace {

constexpr double kAssumedRateHz = 30;

std::vector<fs::path> images_in(const fs::path& folder) {
  for (const char* name : {"", "images", "frames", "rgb", "data"}) {
    if (!is_folder(folder / name)) continue;
    if (auto files = numbered_images(folder / name); !files.empty()) return files;
  }
  return {};
}

std::optional<fs::path> video_at(const fs::path& path) {
  if (!is_folder(path)) return path;
  auto videos = files_of_kind(path, is_video_name);
  const auto is_other = [](const fs::path& file) { return file.stem() != "data"; };
  if (is_file(path / "data.jsonl") && !std::ranges::all_of(videos, is_other))
    std::erase_if(videos, is_other);  // the other camera's
  return only_file(videos, "videos", path);
}

struct OtherTimes {
  const std::optional<Log>& log;
  const std::vector<std::int64_t>& video_ns;
  const Calibration& calibration;
  const std::string& calibration_name;
};

void check_count(const fs::path& file,
                 std::size_t found,
                 const char* things,
                 std::optional<int> count) {
  if (!count || static_cast<int>(found) == *count) return;
  refuse(file, "found {} {}, expected {}, one for each image", found, things, *count);
}

std::vector<std::int64_t> frame_times(Recording& recording,
                                      const fs::path& folder,
                                      std::optional<int> count,
                                      const OtherTimes& other) {
  std::vector<std::int64_t> times;
  if (const auto file = if_file(folder / "frame_timestamps.txt")) {
    // A phone's logger may add other clocks in further columns.
    times = csv_time_stamps(read_csv(*file, {"timestamp"}, CsvColumns::at_least),
                            TimeUnit::by_frame_rate);
    check_count(*file, times.size(), "time stamps", count);
    return times;
  }
  if (other.log && !other.log->frame_times_ns.empty()) {
    check_count(other.log->frames_file, other.log->frame_times_ns.size(), "frames", count);
    return other.log->frame_times_ns;
  }
  if (!other.video_ns.empty()) return other.video_ns;
  const auto& rate_hz = other.calibration.rate_hz;
  if (!rate_hz)
    recording.notes.push_back(
        fmt::format("no frame_timestamps.txt and no rate_hz in {}: assuming 30 frames per second",
                    other.calibration_name));
  const int last = recording.tracks.empty() ? 0 : recording.tracks.back().frame + 1;
  for (int i = 0; i < count.value_or(last); ++i)
    times.push_back(std::llround(i * 1e9 / rate_hz.value_or(kAssumedRateHz)));
  return times;
}

std::optional<Gyroscope> plain_gyroscope(const fs::path& folder) {
  for (const char* name : {"gyro.csv", "gyro_accel.csv", "imu.csv"})
    if (const auto file = if_file(folder / name))
      return read_gyroscope(*file, TimeUnit::by_sample_rate);
  return std::nullopt;
}

void add_gyroscope(Recording& recording,
                   Gyroscope gyroscope,
                   std::int64_t time_offset_ns,
                   const std::string& calibration_name) {
  gyroscope.R_gyro_camera = recording.T_body_camera.value_or(Pose{}).R_wc;
  gyroscope.time_offset_ns = time_offset_ns;
  recording.gyroscope = std::move(gyroscope);
  if (recording.T_body_camera) return;
  recording.notes.push_back("no T_BS in " + calibration_name +
                            ": assuming that the gyroscope has the camera's axes");
}

/// `calibrated` is the user's camera.
void add_log(Recording& recording, const Log& log, int quarter_turns, const Camera& calibrated) {
  // The log's camera has the axes of the stored image, ours those of the shown one.
  const Eigen::Matrix3d R_shown_stored = so3_exp({0, 0, 0.5 * quarter_turns * std::numbers::pi});
  if (log.T_body_camera && !recording.T_body_camera)
    recording.T_body_camera =
        *log.T_body_camera * Pose{R_shown_stored.transpose(), Eigen::Vector3d::Zero()};
  if (log.readout_s && !recording.camera.readout)
    recording.camera.readout = readout_of(*log.readout_s);
  if (log.readout_direction && !calibrated.readout_direction)
    recording.camera.readout_direction = static_cast<ReadoutDirection>(
        (static_cast<int>(*log.readout_direction) + quarter_turns) % 4);
  recording.notes.insert(recording.notes.end(), log.notes.begin(), log.notes.end());
  if (log.true_poses.empty() || recording.truth) return;
  recording.truth = GroundTruth{log.frames_file.filename().string(), log.true_poses};
  recording.truth->jumps = jumps_of(recording.timestamps_ns, log.true_poses);
}

struct FoundCalibration {
  Calibration calibration;
  fs::path file;
  bool found = true;
};

/// The user's calibration, or else the log's camera. Throws InputError if one is required.
FoundCalibration calibration_of(const fs::path& folder,
                                const std::optional<Log>& log,
                                bool required) {
  const auto file = find_calibration(folder);
  if (log && log->camera && (!file || *file == log->camera_file)) {
    Calibration calibration;
    calibration.camera = *log->camera;
    return {calibration, log->camera_file};
  }
  if (!file && !required) return {{}, folder / "camera.yaml", false};
  return {read_calibration(calibration_in(folder)), calibration_in(folder)};
}

}  // namespace

std::optional<fs::path> find_images(const fs::path& path) {
  const bool found = is_folder(path)
                         ? !files_of_kind(path, is_video_name).empty() || !images_in(path).empty()
                         : is_video_name(path);
  return found ? std::optional(path) : std::nullopt;
}

std::shared_ptr<const FrameCache> open_images(const fs::path& path,
                                              std::size_t cache_bytes,
                                              const TopicChoices& topics) {
  if (!find_images(path) && find_bag(path)) return open_bag_images(path, cache_bytes, topics);
  Recording recording;  // not calibrated: accepts any size
  if (const auto video = video_at(path)) {
    if (is_video_name(*video)) return open_video(*video, recording.camera, cache_bytes).images;
    refuse(path, "unsupported file, expected a folder or a file of type {}", recording_endings());
  }
  for (const fs::path& folder : {path, path / "cam0", path / "mav0" / "cam0"}) {
    if (!is_folder(folder)) continue;
    auto files = images_in(folder);
    if (files.empty()) continue;
    add_image_files(recording, files, cache_bytes);
    return recording.images;
  }
  refuse(path, "found no images, expected a video or numbered images");
}

Recording read_images(const fs::path& path, const OpenOptions& options) {
  const auto& tracks = options.tracks;
  const fs::path folder = is_folder(path) ? path : folder_of(path);
  const auto video = video_at(path);
  std::optional<Log> log = log_beside(folder, video);
  Recording recording;
  const auto [calibration, calibration_file, found] =
      calibration_of(folder, log, tracks.has_value());
  const std::string name = calibration_file.filename().string();
  recording.camera = calibration.camera;
  recording.T_body_camera = calibration.T_body_camera;
  VideoFile opened;
  if (video) {
    opened = open_video(*video, recording.camera, options.cache_bytes, options.progress);
    recording.images = opened.images;
    recording.image_files = {*video};
  } else if (auto files = images_in(folder); !files.empty()) {
    add_image_files(recording, files, options.cache_bytes);
  }
  if (!found) {
    const auto& files = recording.image_files;
    guess_camera(recording, files.empty() ? std::nullopt : stored_view(files.front()));
  }
  take_source(recording, calibration);
  if (recording.camera.width == 0)
    refuse(calibration_file,
           "key `image_width`: found no value, expected a number of pixels, since there are no "
           "images");
  const auto count = recording.images ? std::optional(recording.images->count()) : std::nullopt;
  if (tracks) recording.tracks = read_tracks(*tracks, count);
  recording.timestamps_ns =
      frame_times(recording, folder, count, {log, opened.timestamps_ns, calibration, name});
  if (!recording.tracks.empty() && recording.tracks.back().frame >= recording.frame_count())
    read_tracks(*tracks, recording.frame_count());  // throws with the line
  recording.truth = truth_beside(folder, recording.timestamps_ns);
  auto gyroscope = log && log->gyroscope ? log->gyroscope : plain_gyroscope(folder);
  if (!gyroscope && !log && video) {
    log = log_inside(*video, opened.first_frame_s);
    if (log) gyroscope = log->gyroscope;
  }
  if (log) add_log(recording, *log, opened.quarter_turns, calibration.camera);
  if (gyroscope) add_gyroscope(recording, std::move(*gyroscope), calibration.time_offset_ns, name);
  return recording;
}

}  // namespace gpo
