// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// FFmpeg's own code is not instrumented: this looks for what ours makes of its answers.
#include "engine/recording/images/video_decoder.h"
#include "tests/fuzz/fuzzed_file.h"
#include "tests/fuzz/targets.h"

void gpo::fuzz::fuzz_video(std::string_view bytes) {
  const auto file = gpo::fuzz::file_of(bytes);
  gpo::fuzz::parse([&] {
    gpo::VideoDecoder decoder(file);
    const int count = static_cast<int>(decoder.index().times.size());
    if (count > 0) decoder.decode(count - 1);
    if (count > 0) decoder.decode(0);
  });
}
