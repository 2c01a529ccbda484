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

std::optional<fs::path> video_at(const fs::path& path) {
  if (!is_folder(path)) return path;
  auto videos = files_of_kind(path, FileKind::video);
  const auto is_other = [](const fs::path& file) { return file.stem() != "data"; };
  if (is_file(path / "data.jsonl") && !std::ranges::all_of(videos, is_other))
    std::erase_if(videos, is_other);  // the other camera's
  return only_file(videos, "videos", path);
}

struct OtherTimes {
  const std::optional<Log>& log;
  const std::vector<std::int64_t>& video_ns;
  const std::optional<TimesInNames>& names;
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

/// Reads the times of KITTI's times.txt; nullopt, with a report, if they are not those of the
/// images.
std::optional<std::vector<std::int64_t>> listed_times(Recording& recording,
                                                      const fs::path& folder,
                                                      std::optional<int> count) {
  const auto file = if_file(folder / "times.txt");
  if (!file) return std::nullopt;
  try {
    auto times =
        csv_time_stamps(read_csv(*file, {"timestamp"}, CsvColumns::exactly), TimeUnit::seconds);
    check_count(*file, times.size(), "time stamps", count);
    recording.files.push_back({*file, "times of the images", ""});
    return times;
  } catch (const InputError& error) {
    recording.files.push_back({*file, "", error.what()});
    recording.notes.push_back(fmt::format("not read: {}", error.what()));
    return std::nullopt;
  }
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
  if (auto listed = listed_times(recording, folder, count)) return *listed;
  if (other.names) {
    recording.notes.push_back(
        fmt::format("times from the names of the images ({})", other.names->unit));
    return other.names->times_ns;
  }
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
  const auto file =
      first_file({folder / "gyro.csv", folder / "gyro_accel.csv", folder / "imu.csv"});
  if (!file) return std::nullopt;
  return read_gyroscope(*file, TimeUnit::by_sample_rate);
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
  const fs::path& file = log.truth_file.empty() ? log.frames_file : log.truth_file;
  recording.truth = GroundTruth{file.filename().string(), log.true_poses};
  for (auto& pose : recording.truth->poses)
    if (pose) pose->R_wc = pose->R_wc * R_shown_stored.transpose();
  recording.truth->jumps = jumps_of(recording.timestamps_ns, recording.truth->poses);
}

/// Folders that may have the calibration of images: theirs, and Replica's one above the scene.
std::vector<fs::path> calibration_folders(const fs::path& folder, const ImageSequence& sequence) {
  std::vector<fs::path> folders = {folder};
  if (!sequence.files.empty() && sequence.files.front().parent_path() != folder)
    folders.push_back(sequence.files.front().parent_path());
  return folders;
}

/// Finds the user's calibration, or else the log's camera. Throws InputError if one is required.
Calibration calibration_of(const fs::path& folder,
                           const ImageSequence& sequence,
                           const std::optional<Log>& log,
                           bool required,
                           CalibrationSearch& search) {
  search = search_calibration(calibration_folders(folder, sequence));
  const fs::path above = fs::absolute(folder) / ".." / "cam_params.json";
  if (!search.file && is_file(folder / "traj.txt")) search.file = if_file(above.lexically_normal());
  if (log)
    std::erase_if(search.unused,
                  [&](const FoundFile& one) { return one.file == log->camera_file; });
  if (log && log->camera && (!search.file || *search.file == log->camera_file)) {
    Calibration calibration;
    calibration.camera = *log->camera;
    calibration.format = "log";
    search.file = log->camera_file;
    return calibration;
  }
  if (!search.file && !required) return {};
  if (!search.file)
    refuse(folder,
           "found no calibration, expected camera.yaml or another file of EuRoC, OpenCV or "
           "Kalibr; `gpo-inspector calibrate` makes one");
  return read_calibration(*search.file);
}

/// The size of a calibration does not tell whether it is of the turned images.
void note_turn(Recording& recording, int quarter_turns, const std::string& calibration_name) {
  const bool same_size = recording.camera.width == recording.camera.height;
  if (quarter_turns == 0 || (quarter_turns != 2 && !same_size)) return;
  recording.notes.push_back(
      fmt::format("the video asks to be turned by {} deg: {} must be the calibration of the turned "
                  "images",
                  90 * quarter_turns,
                  calibration_name));
}

}  // namespace

std::optional<fs::path> find_images(const fs::path& path) {
  const bool found = is_folder(path) ? !files_of_kind(path, FileKind::video).empty() ||
                                           !find_image_sequence(path).files.empty()
                                     : kind_of(path) == FileKind::video;
  return found ? std::optional(path) : std::nullopt;
}

std::shared_ptr<const FrameCache> open_images(const fs::path& path,
                                              std::size_t cache_bytes,
                                              const TopicChoices& topics) {
  if (!find_images(path) && find_bag(path)) return open_bag_images(path, cache_bytes, topics);
  Recording recording;  // not calibrated: accepts any size
  if (const auto video = video_at(path)) {
    if (kind_of(*video) == FileKind::video)
      return open_video(*video, recording.camera, cache_bytes).images;
    refuse(path, "unsupported file, expected a folder or a file of type {}", recording_endings());
  }
  for (const fs::path& folder : {path, path / "cam0", path / "mav0" / "cam0"}) {
    if (!is_folder(folder)) continue;
    const auto files = find_image_sequence(folder).files;
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
  ImageSequence sequence = video ? ImageSequence{} : find_image_sequence(folder);
  const auto names = times_in_names(sequence.files);
  Recording recording;
  CalibrationSearch search;
  const Calibration calibration = calibration_of(folder, sequence, log, tracks.has_value(), search);
  report_calibration(recording, search, calibration);
  recording.files.insert(recording.files.end(), sequence.others.begin(), sequence.others.end());
  report_left_out(recording, sequence.left_out);
  const fs::path calibration_file = search.file.value_or(folder / "camera.yaml");
  const std::string name = calibration_file.filename().string();
  recording.camera = calibration.camera;
  recording.T_body_camera = calibration.T_body_camera;
  VideoFile opened;
  if (video) {
    const bool alone = !log && !tracks && !is_file(folder / "frame_timestamps.txt");
    opened = open_video(*video,
                        recording.camera,
                        options.cache_bytes,
                        options.progress,
                        alone ? options.first_frames : 0);
    recording.complete = opened.complete;
    recording.pixel_aspect = opened.pixel_aspect;
    recording.first_field = opened.first_field;
    recording.images = opened.images;
    recording.image_files = {*video};
    recording.notes.insert(recording.notes.end(), opened.notes.begin(), opened.notes.end());
    if (search.file) note_turn(recording, opened.quarter_turns, name);
  } else if (!sequence.files.empty()) {
    add_image_files(recording, sequence.files, options.cache_bytes);
  }
  if (!search.file) {
    const auto& files = recording.image_files;
    guess_camera(
        recording, files.empty() ? std::nullopt : stored_view(files.front()), opened.pixel_aspect);
  }
  take_source(recording, calibration);
  check_image_size(recording, calibration_file);
  const auto count = recording.images ? std::optional(recording.images->count()) : std::nullopt;
  if (tracks) recording.tracks = read_tracks(*tracks, count);
  recording.timestamps_ns =
      frame_times(recording, folder, count, {log, opened.timestamps_ns, names, calibration, name});
  if (!recording.tracks.empty() && recording.tracks.back().frame >= recording.frame_count())
    read_tracks(*tracks, recording.frame_count());  // throws with the line
  recording.truth = truth_beside(folder, recording.timestamps_ns);
  if (!video) add_data_set_truth(recording, folder);
  auto gyroscope = log && log->gyroscope ? log->gyroscope : plain_gyroscope(folder);
  if (!gyroscope && !log && video && opened.complete) {
    log = log_inside(*video, opened.first_frame_s);
    if (log) gyroscope = log->gyroscope;
  }
  if (log) add_log(recording, *log, opened.quarter_turns, calibration.camera);
  if (gyroscope) add_gyroscope(recording, std::move(*gyroscope), calibration.time_offset_ns, name);
  return recording;
}

}  // namespace gpo
