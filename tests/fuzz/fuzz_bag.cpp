// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// All containers of bags, told apart by their first bytes.
#include "engine/recording/layouts/layouts.h"
#include "tests/fuzz/fuzzed_file.h"

#include <iostream>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::cerr.setstate(std::ios::failbit);  // OpenCV would tell each failure
  const auto file = gpo::fuzz::file_of(gpo::fuzz::bytes_of(data, size));
  gpo::fuzz::parse([&] {
    const auto recording = gpo::read_bag(file, {.tracks = {}, .cache_bytes = std::size_t{1} << 20});
    recording.pictures->bgr(recording.frame_count() - 1);
  });
  return 0;
}
