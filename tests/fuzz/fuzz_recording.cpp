// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Folders in all layouts that `info` describes, without videos, which FFmpeg reads.
#include "engine/inspection/report/recording_info.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/fuzz/fuzzed_folder.h"
#include "tests/fuzz/targets.h"

void gpo::fuzz::fuzz_recording(std::string_view bytes) {
  const gpo::fuzz::Folder folder(bytes,
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
  gpo::fuzz::parse([&] {
    const auto recording = gpo::open_recording(folder.path(), {});
    gpo::to_text(gpo::describe(*recording));
  });
}
