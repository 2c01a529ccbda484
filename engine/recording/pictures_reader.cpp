// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/pictures_reader.h"

#include "engine/error.h"
#include "engine/recording/calibration_file.h"
#include "engine/recording/gyroscope_file.h"
#include "engine/recording/picture_files.h"
#include "engine/recording/tracks_reader.h"
#include "engine/recording/video_file.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gpo {

namespace {

namespace fs = std::filesystem;

constexpr double kAssumedRateHz = 30;

std::vector<fs::path> videos_in(const fs::path& folder) {
  std::vector<fs::path> videos;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && is_video_name(entry.path())) videos.push_back(entry.path());
  }
  std::sort(videos.begin(), videos.end());
  return videos;
}

/// The one video to open, or nothing.
std::optional<fs::path> video_at(const fs::path& path) {
  if (!fs::is_directory(path)) return path;
  const auto videos = videos_in(path);
  if (videos.size() > 1) {
    throw InputError(path.string() + ": found " + std::to_string(videos.size()) + " videos (" +
                     videos[0].filename().string() + ", " + videos[1].filename().string() +
                     "), expected one; name the file to open");
  }
  return videos.empty() ? std::nullopt : std::optional(videos[0]);
}

std::optional<std::vector<std::int64_t>> stored_times(const fs::path& file) {
  if (!fs::exists(file)) return std::nullopt;
  return csv_time_stamps(read_csv(file, {"timestamp"}, CsvColumns::exactly), TimeUnit::by_value);
}

std::vector<std::int64_t> regular_times(int count, double rate_hz) {
  std::vector<std::int64_t> times;
  times.reserve(count);
  for (int i = 0; i < count; ++i) times.push_back(std::llround(i * 1e9 / rate_hz));
  return times;
}

/// Times of the frames: the file's, else the video's, else regular ones.
void set_times(Recording& recording,
               const fs::path& folder,
               std::optional<int> count,
               const std::vector<std::int64_t>& video_times,
               const std::optional<double>& rate_hz) {
  const fs::path file = folder / "frame_timestamps.txt";
  if (auto stored = stored_times(file)) {
    if (count && static_cast<int>(stored->size()) != *count) {
      throw InputError(file.string() + ": found " + std::to_string(stored->size()) +
                       " time stamps, expected " + std::to_string(*count) + ", one a picture");
    }
    recording.timestamps_ns = *std::move(stored);
    return;
  }
  if (!video_times.empty()) {
    recording.timestamps_ns = video_times;
    return;
  }
  const int last = recording.tracks.empty() ? 0 : recording.tracks.back().frame + 1;
  recording.timestamps_ns = regular_times(count.value_or(last), rate_hz.value_or(kAssumedRateHz));
  if (!rate_hz) {
    recording.notes.emplace_back(
        "no frame_timestamps.txt and no rate_hz in camera.yaml: 30 frames a second are assumed");
  }
}

void add_gyroscope(Recording& recording, const fs::path& folder, const Calibration& calibration) {
  const fs::path file = folder / "gyro.csv";
  if (!fs::exists(file)) return;
  Gyroscope gyroscope = read_gyroscope(file, TimeUnit::by_value);
  gyroscope.R_gyro_camera = calibration.T_body_camera.value_or(Pose{}).R_wc;
  gyroscope.time_offset_ns = calibration.time_offset_ns;
  recording.gyroscope = std::move(gyroscope);
  if (!calibration.T_body_camera) {
    recording.notes.emplace_back(
        "no T_BS in camera.yaml: the gyroscope's axes are taken as the camera's");
  }
}

void add_numbered_pictures(Recording& recording, const fs::path& folder, std::size_t cache_bytes) {
  auto files = numbered_pictures(folder);
  if (!files.empty()) {
    recording.picture_files = files;
    recording.pictures = open_picture_files(std::move(files), recording.camera, cache_bytes);
  }
}

}  // namespace

bool holds_pictures(const fs::path& folder) {
  return !videos_in(folder).empty() || !numbered_pictures(folder).empty();
}

std::shared_ptr<const FrameCache> open_pictures(const fs::path& path, std::size_t cache_bytes) {
  const Camera uncalibrated;
  if (const auto video = video_at(path)) {
    if (is_video_name(*video)) return open_video(*video, uncalibrated, cache_bytes).pictures;
    throw InputError(path.string() +
                     ": found a file that is no video, expected a folder or mp4, avi, mov, mkv");
  }
  for (const char* below : {"", "cam0/data", "mav0/cam0/data", "rgb"}) {
    if (!fs::is_directory(path / below)) continue;
    auto files = numbered_pictures(path / below);
    if (!files.empty()) return open_picture_files(std::move(files), uncalibrated, cache_bytes);
  }
  throw InputError(path.string() + ": found no pictures, expected a video or numbered pictures");
}

Recording read_pictures(const fs::path& path,
                        const std::optional<fs::path>& tracks,
                        std::size_t cache_bytes) {
  const fs::path folder = fs::is_directory(path) ? path : path.parent_path();
  Recording recording;
  const auto calibration = read_calibration(folder / "camera.yaml");
  recording.camera = calibration.camera;
  std::vector<std::int64_t> video_times;
  if (const auto video = video_at(path)) {
    auto opened = open_video(*video, recording.camera, cache_bytes);
    recording.pictures = opened.pictures;
    recording.picture_files = {*video};
    video_times = std::move(opened.timestamps_ns);
  } else {
    add_numbered_pictures(recording, folder, cache_bytes);
  }
  recording.layout = recording.pictures ? Layout::pictures : Layout::tracks;
  const auto count = recording.pictures ? std::optional(recording.pictures->count()) : std::nullopt;
  if (tracks) recording.tracks = read_tracks(*tracks, count);
  set_times(recording, folder, count, video_times, calibration.rate_hz);
  if (!recording.tracks.empty() && recording.tracks.back().frame >= recording.frame_count()) {
    read_tracks(*tracks, recording.frame_count());  // names the line
  }
  add_gyroscope(recording, folder, calibration);
  return recording;
}

}  // namespace gpo
