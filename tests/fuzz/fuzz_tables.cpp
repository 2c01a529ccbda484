// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The first byte chooses what the rest is read as.
#include "engine/recording/companions/gyroscope_file.h"
#include "engine/recording/companions/truth_file.h"
#include "engine/recording/layouts/layouts.h"
#include "tests/fuzz/fuzzed_file.h"
#include "tests/fuzz/targets.h"

constexpr std::int64_t kTime_ns = 1'403'636'579'763'555'584;

void gpo::fuzz::fuzz_tables(std::string_view bytes) {
  if (bytes.empty()) return;
  const char kind = bytes[0];
  bytes.remove_prefix(1);
  const auto file = gpo::fuzz::file_of(bytes);
  gpo::fuzz::parse([&] {
    switch (kind) {
      case 'g':
        gpo::read_gyroscope(file, gpo::TimeUnit::by_sample_rate);
        break;
      case 'i':
        gpo::read_gyroscope(file, gpo::TimeUnit::nanoseconds);
        break;
      case 't':
        gpo::read_tracks(file, std::nullopt);
        break;
      case 'f':
        gpo::read_tracks(file, 30);
        break;
      case 'p':
        gpo::pose_at(gpo::read_euroc_path(file), kTime_ns);
        break;
      case 'm':
        gpo::pose_at(gpo::read_tum_path(file), kTime_ns);
        break;
      default: {
        const auto table = gpo::read_csv(file, {"timestamp"}, gpo::CsvColumns::at_least);
        gpo::csv_time_stamps(table, gpo::TimeUnit::by_frame_rate);
      }
    }
  });
}
