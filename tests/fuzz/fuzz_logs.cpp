// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// What cameras and apps log beside and inside of videos. The first byte chooses what the rest is
// read as.
#include "engine/recording/layouts/camera_source.h"
#include "engine/recording/loggers/gpmf.h"
#include "engine/recording/loggers/logs.h"
#include "engine/recording/loggers/telemetry_track.h"
#include "tests/fuzz/fuzzed_file.h"
#include "tests/fuzz/fuzzed_folder.h"
#include "tests/fuzz/targets.h"

#include <vector>

namespace {

/// Two payloads, cut somewhere in the middle.
void read_gpmf(std::string_view bytes) {
  gpo::GpmfCount counted;
  std::vector<gpo::GpmfPayload> payloads;
  for (const std::string_view part : {bytes, bytes.substr(bytes.size() / 2)})
    payloads.push_back(gpo::parse_gpmf(part, "fuzzed", counted));
  gpo::gpmf_times_ns(payloads, {0, 1, 2});
}

void read_folder(std::string_view bytes) {
  const gpo::fuzz::Folder folder(
      bytes, {"odometry.csv", "camera_matrix.csv", "imu.csv", "data.jsonl", "calibration.json"});
  gpo::fuzz::parse([&] { gpo::read_stray_scanner(folder.path()); });
  gpo::fuzz::parse([&] { gpo::read_spectacular(folder.path() / "data.jsonl"); });
}

}  // namespace

void gpo::fuzz::fuzz_logs(std::string_view bytes) {
  if (bytes.empty()) return;
  const char kind = bytes[0];
  bytes.remove_prefix(1);
  gpo::fuzz::parse([&] {
    switch (kind) {
      case 'g':
        read_gpmf(bytes);
        break;
      case 'c':
        gpo::parse_camm(bytes, "fuzzed");
        break;
      case 'l':
        gpo::read_gcsv(gpo::fuzz::file_of(bytes));
        break;
      case 's':
        gpo::read_sensor_logger(gpo::fuzz::file_of(bytes));
        break;
      case 'j':
        gpo::read_spectacular(gpo::fuzz::file_of(bytes));
        break;
      case 'm':
        gpo::gopro_settings(gpo::fuzz::file_of(bytes));
        gpo::read_telemetry_track(gpo::fuzz::file_of(bytes));
        gpo::view_of_metadata(gpo::fuzz::file_of(bytes));
        break;
      case 'v':
        gpo::view_of_gpmf(bytes);
        break;
      case 'k':
        gpo::metadata_value(bytes, "com.apple.quicktime.camera.focal_length.35mm_equivalent");
        break;
      default:
        read_folder(bytes);
    }
  });
}
