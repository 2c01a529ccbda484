// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/targets.h"

#include "engine/base/error.h"
#include "engine/experiment/row.h"
#include "engine/experiment/runner.h"
#include "engine/external_methods/own_method.h"
#include "engine/files/libav_functions.h"
#include "engine/files/text_file.h"
#include "engine/inspection/report/report.h"
#include "engine/recording/bags/messages.h"
#include "engine/recording/companions/colmap_model.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/loggers/logs.h"
#include "engine/results/result_method.h"
#include "engine/synthesis/recipe.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace gpo::fuzz {
namespace {

namespace fs = std::filesystem;
using Bytes = std::string_view;

constexpr std::size_t kLongestMessage = 2000;
constexpr std::string_view kMark = "=== ";

bool is_control(unsigned char c) { return c < 0x20 || c == 0x7F; }

/// Returns a file in memory that contains these bytes until the next call.
fs::path file_of(Bytes bytes) {
  static const int kDescriptor = memfd_create("fuzzed", MFD_CLOEXEC);
  const bool written =
      ftruncate(kDescriptor, 0) == 0 &&
      pwrite(kDescriptor, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
  if (!written) std::abort();
  return "/proc/self/fd/" + std::to_string(kDescriptor);
}

/// A folder of files in the temporary folder, one at a time in a process. The bytes are the files
/// one after the other, each after a line "=== NAME" with one of `names`.
class Folder {
 public:
  Folder(Bytes bytes, const std::vector<std::string>& names) {
    fs::create_directories(path_);
    std::ofstream file;
    while (!bytes.empty()) {
      const std::size_t end = std::min(bytes.find('\n'), bytes.size());
      const Bytes line = bytes.substr(0, end), whole = bytes.substr(0, end + 1);
      bytes.remove_prefix(whole.size());
      const bool begins = line.starts_with(kMark) &&
                          std::ranges::find(names, line.substr(kMark.size())) != names.end();
      if (!begins) {
        file << whole;
        continue;
      }
      const fs::path name = path_ / line.substr(kMark.size());
      fs::create_directories(name.parent_path());
      file = std::ofstream(name, std::ios::binary);
    }
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_ = fs::temp_directory_path() / ("gpo-fuzz-" + std::to_string(getpid()));
};

/// Calls `parser` with a file that contains the bytes.
void parse_file(Bytes bytes, const std::function<void(const fs::path& file)>& parser) {
  const auto file = file_of(bytes);
  parse([&] { parser(file); });
}

/// A target that reads a file by one parser.
template <auto parser>
void fuzz_file(Bytes bytes) {
  parse_file(bytes, parser);
}

using Readers = std::map<char, std::function<void(Bytes bytes)>>;
constexpr char kOther = '\0';

/// Calls the reader that the first byte selects with the other bytes.
void parse_kind(Bytes bytes, const Readers& readers) {
  if (bytes.empty()) return;
  const auto found = readers.find(bytes[0]);
  const auto& read = found == readers.end() ? readers.at(kOther) : found->second;
  parse([&] { read(bytes.substr(1)); });
}

void fuzz_answer(Bytes bytes) {
  parse([&] { read_answer(bytes, {.id = 1, .frames = 2, .tracks = 4, .planes = 2}); });
}

void fuzz_bag(Bytes bytes) {
  parse_file(bytes, [](const auto& file) {
    const auto recording = read_bag(file, {.tracks = {}, .cache_bytes = std::size_t{1} << 20});
    recording.images->bgr(recording.frame_count() - 1);
  });
}

void fuzz_experiment(Bytes bytes) {
  const Folder folder(bytes, {"experiment.json", "windows/desk-0-30.json"});
  parse([&] {
    Experiment experiment = read_experiment(folder.path());
    if (experiment.recordings.empty()) return;
    experiment.recordings[0].name = "desk";
    load_window(folder.path(), experiment, {.recording = 0, .start = 0, .lengths = {30}}, 30);
  });
}

void fuzz_foxglove(Bytes all) {
  constexpr std::array<const char*, 4> kSchemas = {"foxglove.CompressedImage",
                                                   "foxglove.RawImage",
                                                   "foxglove.CameraCalibration",
                                                   "foxglove.PoseInFrame"};
  if (all.empty()) return;
  const auto choice = static_cast<unsigned char>(all[0]);
  const auto encoding = static_cast<MessageEncoding>(choice / kSchemas.size() % 4);
  parse([&] { converted_foxglove(all.substr(1), kSchemas[choice % kSchemas.size()], encoding); });
}

/// Reads two payloads; the second begins in the middle of the first.
void read_gpmf(Bytes bytes) {
  GpmfCount counted;
  std::vector<GpmfPayload> payloads;
  for (const Bytes part : {bytes, bytes.substr(bytes.size() / 2)})
    payloads.push_back(parse_gpmf(part, "fuzzed", counted));
  gpmf_times_ns(payloads, {0, 1, 2});
}

void read_log_folder(Bytes bytes) {
  const Folder folder(
      bytes,
      split("odometry.csv camera_matrix.csv imu.csv data.jsonl calibration.json Frames.txt "
            "Gyro.txt ARposes.txt",
            ' '));
  parse([&] { read_stray_scanner(folder.path()); });
  parse([&] { read_spectacular(folder.path() / "data.jsonl"); });
  parse([&] { read_ios_logger(folder.path()); });
}

void read_movie(const fs::path& file) {
  gopro_settings(file);
  read_telemetry_track(file);
  view_of_metadata(file);
}

void fuzz_logs(Bytes all) {
  constexpr const char* kKey = "com.apple.quicktime.camera.focal_length.35mm_equivalent";
  parse_kind(all,
             {{'g', read_gpmf},
              {'c', [](Bytes bytes) { parse_camm(bytes, "fuzzed"); }},
              {'l', [](Bytes bytes) { read_gcsv(file_of(bytes)); }},
              {'s', [](Bytes bytes) { read_sensor_logger(file_of(bytes)); }},
              {'j', [](Bytes bytes) { read_spectacular(file_of(bytes)); }},
              {'m', [](Bytes bytes) { read_movie(file_of(bytes)); }},
              {'v', [](Bytes bytes) { view_of_gpmf(bytes); }},
              {'k', [](Bytes bytes) { metadata_value(bytes, kKey); }},
              {kOther, read_log_folder}});
}

void fuzz_message(Bytes all) {
  constexpr std::array<const char*, 10> kTypes = {"sensor_msgs/Image",
                                                  "sensor_msgs/CompressedImage",
                                                  kCameraInfoType,
                                                  kImuType,
                                                  kTransformsType,
                                                  "geometry_msgs/PoseStamped",
                                                  "geometry_msgs/PoseWithCovarianceStamped",
                                                  "geometry_msgs/TransformStamped",
                                                  "nav_msgs/Odometry",
                                                  "std_msgs/String"};
  if (all.empty()) return;
  parse([&] {
    const Bytes bytes = all.substr(1);
    const std::size_t choice = static_cast<unsigned char>(all[0]) % (2 * kTypes.size());
    const auto encoding = choice >= kTypes.size() ? MessageEncoding::cdr : MessageEncoding::ros1;
    const std::string type = kTypes[choice % kTypes.size()];
    read_header(bytes, encoding);
    read_imu(bytes, encoding);
    if (is_image_type(type)) bag_image(bytes, {"/camera", type, encoding}, "camera");
    if (const auto pose = read_pose(bytes, encoding, type)) pose->pose();
    if (type == kTransformsType) read_transforms(bytes, encoding);
    if (type != kCameraInfoType) return;
    const auto info = read_camera_info(bytes, encoding);
    if (info && is_calibrated(*info)) camera_of(*info, "camera");
  });
}

void fuzz_image(Bytes bytes) {
  parse_file(bytes, [](const auto& file) { read_image(file); });
  parse_file(bytes, view_of_exif);
}

void fuzz_poses(Bytes all) {
  parse_kind(all,
             {{'b', [](Bytes bytes) { read_colmap_images("images.bin", bytes); }},
              {'t', [](Bytes bytes) { read_colmap_images("images.txt", bytes); }},
              {'p', [](Bytes bytes) { read_colmap_points("points3D.bin", bytes); }},
              {'q', [](Bytes bytes) { read_colmap_points("points3D.txt", bytes); }},
              {'y', [](Bytes bytes) { read_ply_points("points.ply", bytes); }},
              {kOther, [](Bytes bytes) { read_result_poses(file_of(bytes)); }}});
}

void fuzz_recording(Bytes bytes) {
  const Folder folder(
      bytes,
      split(
          "cam0/data.csv cam0/sensor.yaml cam0/data/0.pgm cam0/data/1.pgm imu0/data.csv "
          "imu0/sensor.yaml state_groundtruth_estimate0/data.csv camera.yaml frame_timestamps.txt "
          "gyro.csv odometry.csv camera_matrix.csv imu.csv data.jsonl Gyroscope.csv 0.pgm 1.pgm "
          "groundtruth.yaml rgb.txt groundtruth.txt rgb/0.pgm tracks.csv board.yaml plane.yaml "
          "lens.yaml calib.txt times.txt poses.txt traj.txt transforms.json sparse/0/cameras.bin "
          "sparse/0/images.txt frame-0.color.pgm frame-0.depth.pgm frame-0.pose.txt "
          "frame-1.color.pgm frame-1.pose.txt metadata.yaml rec_0.mcap rec_0.mcap.zstd",
          ' '));
  parse([&] { to_text(describe(*open_recording(folder.path(), {}))); });
}

void fuzz_results(Bytes bytes) {
  parse_file(bytes, [](const auto& file) { read_results(file); });
}

void fuzz_session(Bytes bytes) {
  parse_file(bytes, [](const auto& file) { read_session(file); });
}

void fuzz_sidecars(Bytes bytes) {
  parse_file(bytes, read_board);
  parse_file(bytes, read_plane);
}

void fuzz_tables(Bytes all) {
  constexpr std::int64_t kTime_ns = 1'403'636'579'763'555'584;
  const auto read_times = [](Bytes bytes) {
    csv_time_stamps(read_csv(file_of(bytes), {"timestamp"}, CsvColumns::at_least),
                    TimeUnit::by_frame_rate);
  };
  parse_kind(all,
             {{'g', [](Bytes bytes) { read_gyroscope(file_of(bytes), TimeUnit::by_sample_rate); }},
              {'i', [](Bytes bytes) { read_gyroscope(file_of(bytes), TimeUnit::nanoseconds); }},
              {'t', [](Bytes bytes) { read_tracks(file_of(bytes), std::nullopt); }},
              {'f', [](Bytes bytes) { read_tracks(file_of(bytes), 30); }},
              {'p', [](Bytes bytes) { pose_at(read_euroc_path(file_of(bytes)), kTime_ns); }},
              {'m', [](Bytes bytes) { pose_at(read_tum_path(file_of(bytes)), kTime_ns); }},
              {kOther, read_times}});
}

void fuzz_video(Bytes bytes) {
  parse_file(bytes, kind_of);
  parse_file(bytes, ends_early);
  parse_file(bytes, [](const auto& file) {
    VideoDecoder decoder(file);
    const int count = static_cast<int>(decoder.index().times.size());
    if (count > 0) decoder.decode(count - 1);
    if (count > 0) decoder.decode(0);
  });
}

}  // namespace

void parse(const std::function<void()>& parser) {
  try {
    parser();
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    if (message.size() <= kLongestMessage && std::ranges::none_of(message, is_control)) return;
    throw std::runtime_error(std::string("message is not one printable line: ") + error.what());
  }
}

const std::vector<Target>& targets() {
  static const std::vector<Target> kTargets = {{"answer", fuzz_answer},
                                               {"bag", fuzz_bag},
                                               {"calibration", fuzz_file<read_calibration>},
                                               {"experiment", fuzz_experiment},
                                               {"foxglove", fuzz_foxglove},
                                               {"library", call_library},
                                               {"logs", fuzz_logs},
                                               {"message", fuzz_message},
                                               {"picture", fuzz_image},
                                               {"poses", fuzz_poses},
                                               {"recipe", fuzz_file<read_recipe>},
                                               {"recording", fuzz_recording},
                                               {"results", fuzz_results},
                                               {"script", fuzz_file<read_script>},
                                               {"session", fuzz_session},
                                               {"sidecars", fuzz_sidecars},
                                               {"tables", fuzz_tables},
                                               {"video", fuzz_video}};
  return kTargets;
}

void quiet_libraries() {
  libav::before_loading([] {
    const libav::Function<decltype(av_log_set_level)> set_level("av_log_set_level");
    set_level(AV_LOG_QUIET);
  });
  std::cerr.setstate(std::ios::failbit);  // OpenCV prints every failure there
}

}  // namespace gpo::fuzz
