// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/pictures_reader.h"

#include "engine/base/error.h"
#include "engine/files/folder.h"
#include "engine/geometry/camera_guess.h"
#include "engine/recording/camera_source.h"
#include "engine/recording/layouts/calibration_file.h"
#include "engine/recording/layouts/gyroscope_file.h"
#include "engine/recording/layouts/tracks_reader.h"
#include "engine/recording/layouts/truth_file.h"
#include "engine/recording/pictures/picture_files.h"
#include "engine/recording/pictures/video_file.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace gpo {

namespace {

namespace fs = std::filesystem;

constexpr double kAssumedRateHz = 30;

std::vector<fs::path> videos_in(const fs::path& folder) {
  std::vector<fs::path> videos = files_in(folder);
  std::erase_if(videos, [](const fs::path& file) { return !is_video_name(file); });
  std::ranges::sort(videos);
  return videos;
}

/// Numbered pictures of the folder itself, or of the folder in it where people keep them.
std::vector<fs::path> pictures_in(const fs::path& folder) {
  for (const char* name : {"", "images", "frames", "rgb", "data"}) {
    if (!is_folder(folder / name)) continue;
    if (auto files = numbered_pictures(folder / name); !files.empty()) return files;
  }
  return {};
}

/// The one video to open, or nothing.
std::optional<fs::path> video_at(const fs::path& path) {
  if (!is_folder(path)) return path;
  const auto videos = videos_in(path);
  if (videos.size() > 1) {
    throw InputError(path.string() + ": found " + std::to_string(videos.size()) + " videos (" +
                     videos[0].filename().string() + ", " + videos[1].filename().string() +
                     "), expected one; name the file to open");
  }
  return videos.empty() ? std::nullopt : std::optional(videos[0]);
}

/// A phone's logger may add further clocks in further columns.
std::optional<std::vector<std::int64_t>> stored_times(const fs::path& file) {
  if (!is_file(file)) return std::nullopt;
  return csv_time_stamps(read_csv(file, {"timestamp"}, CsvColumns::at_least),
                         TimeUnit::by_frame_rate);
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
               const std::optional<double>& rate_hz,
               const std::string& calibration_name) {
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
    recording.notes.push_back("no frame_timestamps.txt and no rate_hz in " + calibration_name +
                              ": 30 frames a second are assumed");
  }
}

void add_gyroscope(Recording& recording,
                   const fs::path& folder,
                   std::int64_t time_offset_ns,
                   const std::string& calibration_name) {
  for (const char* name : {"gyro.csv", "gyro_accel.csv", "imu.csv"}) {
    const auto file = if_file(folder / name);
    if (!file) continue;
    Gyroscope gyroscope = read_gyroscope(*file, TimeUnit::by_sample_rate);
    gyroscope.R_gyro_camera = recording.T_body_camera.value_or(Pose{}).R_wc;
    gyroscope.time_offset_ns = time_offset_ns;
    recording.gyroscope = std::move(gyroscope);
    if (!recording.T_body_camera) {
      recording.notes.push_back("no T_BS in " + calibration_name +
                                ": the gyroscope's axes are taken as the camera's");
    }
    return;
  }
}

/// The calibration may leave the size to the pictures; without pictures it may not.
void check_size_is_known(const Camera& camera, const fs::path& calibration) {
  if (camera.width > 0) return;
  throw InputError(calibration.string() +
                   ": key `image_width`: found nothing, expected a number of pixels, since there "
                   "are no pictures to take it from");
}

}  // namespace

std::optional<fs::path> find_pictures(const fs::path& path) {
  const bool found = is_folder(path) ? !videos_in(path).empty() || !pictures_in(path).empty()
                                     : is_video_name(path);
  return found ? std::optional(path) : std::nullopt;
}

std::shared_ptr<const FrameCache> open_pictures(const fs::path& path, std::size_t cache_bytes) {
  Recording recording;  // not calibrated: of any size
  if (const auto video = video_at(path)) {
    if (is_video_name(*video)) return open_video(*video, recording.camera, cache_bytes).pictures;
    throw InputError(path.string() +
                     ": found a file that is no video, expected a folder or mp4, avi, mov, mkv");
  }
  for (const fs::path& folder : {path, path / "cam0", path / "mav0" / "cam0"}) {
    if (!is_folder(folder)) continue;
    auto files = pictures_in(folder);
    if (files.empty()) continue;
    add_picture_files(recording, std::move(files), cache_bytes);
    return recording.pictures;
  }
  throw InputError(path.string() + ": found no pictures, expected a video or numbered pictures");
}

Recording read_pictures(const fs::path& path,
                        const std::optional<fs::path>& tracks,
                        std::size_t cache_bytes) {
  const fs::path folder = is_folder(path) ? path : folder_of(path);
  Recording recording;
  // Of pictures the size is known, and so, roughly, what camera it may be.
  const auto found = tracks ? std::optional(calibration_in(folder)) : find_calibration(folder);
  const fs::path calibration_file = found.value_or(folder / "camera.yaml");
  const std::string name = calibration_file.filename().string();
  const auto calibration = found ? read_calibration(*found) : Calibration{};
  recording.camera = calibration.camera;
  recording.T_body_camera = calibration.T_body_camera;
  std::vector<std::int64_t> video_times;
  if (const auto video = video_at(path)) {
    auto opened = open_video(*video, recording.camera, cache_bytes);
    recording.pictures = opened.pictures;
    recording.picture_files = {*video};
    video_times = std::move(opened.timestamps_ns);
  } else if (auto files = pictures_in(folder); !files.empty()) {
    add_picture_files(recording, std::move(files), cache_bytes);
  }
  if (!found) {
    set_camera(recording,
               camera_of_view(recording.camera.width, recording.camera.height),
               CameraSource::guess,
               fmt::format("{:.0f} degrees along the picture's diagonal; `calibrate` finds it",
                           kUsualView_deg));
  } else if (calibration.self_calibrated) {
    set_camera(recording, recording.camera, CameraSource::self_calibrated, name);
  }
  check_size_is_known(recording.camera, calibration_file);
  const auto count = recording.pictures ? std::optional(recording.pictures->count()) : std::nullopt;
  if (tracks) recording.tracks = read_tracks(*tracks, count);
  set_times(recording, folder, count, video_times, calibration.rate_hz, name);
  if (!recording.tracks.empty() && recording.tracks.back().frame >= recording.frame_count()) {
    read_tracks(*tracks, recording.frame_count());  // names the line
  }
  add_gyroscope(recording, folder, calibration.time_offset_ns, name);
  recording.truth = truth_beside(folder, recording.timestamps_ns);
  return recording;
}

}  // namespace gpo
