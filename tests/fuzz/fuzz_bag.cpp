// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// All containers of bags, told apart by their first bytes.
#include "engine/recording/layouts/layouts.h"
#include "tests/fuzz/fuzzed_file.h"
#include "tests/fuzz/targets.h"

void gpo::fuzz::fuzz_bag(std::string_view bytes) {
  const auto file = gpo::fuzz::file_of(bytes);
  gpo::fuzz::parse([&] {
    const auto recording = gpo::read_bag(file, {.tracks = {}, .cache_bytes = std::size_t{1} << 20});
    recording.images->bgr(recording.frame_count() - 1);
  });
}
