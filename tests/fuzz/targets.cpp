// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/targets.h"

#include "engine/experiment/row.h"
#include "engine/experiment/runner.h"
#include "engine/external_methods/answer.h"
#include "engine/inspection/report/recording_info.h"
#include "engine/recording/bags/messages.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/decoders.h"
#include "engine/recording/layouts/camera_source.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/loggers/logs.h"
#include "engine/results/result_method.h"
#include "engine/synthesis/recipe.h"
#include "tests/fuzz/fuzzed_input.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/session/session_file.h"

#include <array>
#include <iostream>
#include <string>

extern "C" {
#include <libavutil/log.h>
}

namespace gpo::fuzz {
namespace {

using Bytes = std::string_view;

/// Calls `parser` with a file that contains the bytes.
void parse_file(Bytes bytes, const std::function<void(const std::filesystem::path& file)>& parser) {
  const auto file = file_of(bytes);
  parse([&] { parser(file); });
}

/// Calls `parser` with the first byte, which selects a format, and the others.
void parse_kind(Bytes bytes, const std::function<void(char kind, Bytes bytes)>& parser) {
  if (!bytes.empty()) parse([&] { parser(bytes[0], bytes.substr(1)); });
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

void fuzz_calibration(Bytes bytes) {
  parse_file(bytes, [](const auto& file) { read_calibration(file); });
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
      bytes, {"odometry.csv", "camera_matrix.csv", "imu.csv", "data.jsonl", "calibration.json"});
  parse([&] { read_stray_scanner(folder.path()); });
  parse([&] { read_spectacular(folder.path() / "data.jsonl"); });
}

void read_movie(const std::filesystem::path& file) {
  gopro_settings(file);
  read_telemetry_track(file);
  view_of_metadata(file);
}

void fuzz_logs(Bytes all) {
  parse_kind(all, [](char kind, Bytes bytes) {
    switch (kind) {
      case 'g':
        return read_gpmf(bytes);
      case 'c':
        return void(parse_camm(bytes, "fuzzed"));
      case 'l':
        return void(read_gcsv(file_of(bytes)));
      case 's':
        return void(read_sensor_logger(file_of(bytes)));
      case 'j':
        return void(read_spectacular(file_of(bytes)));
      case 'm':
        return read_movie(file_of(bytes));
      case 'v':
        return void(view_of_gpmf(bytes));
      case 'k':
        return void(
            metadata_value(bytes, "com.apple.quicktime.camera.focal_length.35mm_equivalent"));
      default:
        return read_log_folder(bytes);
    }
  });
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
  parse_kind(all, [&](char kind, Bytes bytes) {
    const std::size_t choice = static_cast<unsigned char>(kind) % (2 * kTypes.size());
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
  parse_file(bytes, [](const auto& file) { view_of_exif(file); });
}

void fuzz_poses(Bytes all) {
  parse_kind(all, [](char kind, Bytes bytes) {
    switch (kind) {
      case 'b':
        return void(read_colmap_images("images.bin", bytes));
      case 't':
        return void(read_colmap_images("images.txt", bytes));
      case 'p':
        return void(read_colmap_points("points3D.bin", bytes));
      case 'q':
        return void(read_colmap_points("points3D.txt", bytes));
      case 'y':
        return void(read_ply_points("points.ply", bytes));
      default:
        return void(read_result_poses(file_of(bytes)));
    }
  });
}

void fuzz_recipe(Bytes bytes) {
  parse_file(bytes, [](const auto& file) { read_recipe(file); });
}

void fuzz_recording(Bytes bytes) {
  const Folder folder(bytes,
                      {"cam0/data.csv",
                       "cam0/sensor.yaml",
                       "cam0/data/0.pgm",
                       "cam0/data/1.pgm",
                       "imu0/data.csv",
                       "imu0/sensor.yaml",
                       "state_groundtruth_estimate0/data.csv",
                       "camera.yaml",
                       "frame_timestamps.txt",
                       "gyro.csv",
                       "odometry.csv",
                       "camera_matrix.csv",
                       "imu.csv",
                       "data.jsonl",
                       "Gyroscope.csv",
                       "0.pgm",
                       "1.pgm",
                       "groundtruth.yaml",
                       "rgb.txt",
                       "groundtruth.txt",
                       "rgb/0.pgm",
                       "tracks.csv",
                       "board.yaml",
                       "plane.yaml"});
  parse([&] { to_text(describe(*open_recording(folder.path(), {}))); });
}

void fuzz_results(Bytes bytes) {
  parse_file(bytes, [](const auto& file) { read_results(file); });
}

void fuzz_script(Bytes bytes) {
  parse_file(bytes, [](const auto& file) { read_script(file); });
}

void fuzz_session(Bytes bytes) {
  parse_file(bytes, [](const auto& file) { read_session(file); });
}

void fuzz_sidecars(Bytes bytes) {
  parse_file(bytes, [](const auto& file) { read_board(file); });
  parse_file(bytes, [](const auto& file) { read_plane(file); });
}

void fuzz_tables(Bytes all) {
  constexpr std::int64_t kTime_ns = 1'403'636'579'763'555'584;
  parse_kind(all, [](char kind, Bytes bytes) {
    const auto file = file_of(bytes);
    switch (kind) {
      case 'g':
        return void(read_gyroscope(file, TimeUnit::by_sample_rate));
      case 'i':
        return void(read_gyroscope(file, TimeUnit::nanoseconds));
      case 't':
        return void(read_tracks(file, std::nullopt));
      case 'f':
        return void(read_tracks(file, 30));
      case 'p':
        return void(pose_at(read_euroc_path(file), kTime_ns));
      case 'm':
        return void(pose_at(read_tum_path(file), kTime_ns));
      default:
        csv_time_stamps(read_csv(file, {"timestamp"}, CsvColumns::at_least),
                        TimeUnit::by_frame_rate);
    }
  });
}

void fuzz_video(Bytes bytes) {
  parse_file(bytes, [](const auto& file) {
    VideoDecoder decoder(file);
    const int count = static_cast<int>(decoder.index().times.size());
    if (count > 0) decoder.decode(count - 1);
    if (count > 0) decoder.decode(0);
  });
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> kTargets = {{"answer", fuzz_answer},
                                               {"bag", fuzz_bag},
                                               {"calibration", fuzz_calibration},
                                               {"experiment", fuzz_experiment},
                                               {"logs", fuzz_logs},
                                               {"message", fuzz_message},
                                               {"picture", fuzz_image},
                                               {"poses", fuzz_poses},
                                               {"recipe", fuzz_recipe},
                                               {"recording", fuzz_recording},
                                               {"results", fuzz_results},
                                               {"script", fuzz_script},
                                               {"session", fuzz_session},
                                               {"sidecars", fuzz_sidecars},
                                               {"tables", fuzz_tables},
                                               {"video", fuzz_video}};
  return kTargets;
}

void quiet_libraries() {
  av_log_set_level(AV_LOG_QUIET);
  std::cerr.setstate(std::ios::failbit);  // OpenCV prints every failure there
}

}  // namespace gpo::fuzz
