// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// FFmpeg's own code is not instrumented: this looks for what ours makes of its answers.
#include "engine/recording/pictures/video_decoder.h"
#include "tests/fuzz/fuzzed_file.h"

extern "C" {
#include <libavutil/log.h>
}

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  av_log_set_level(AV_LOG_QUIET);  // it has much to say about what is tried here
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = gpo::fuzz::file_of(gpo::fuzz::bytes_of(data, size));
  gpo::fuzz::parse([&] {
    gpo::VideoDecoder decoder(file);
    const int count = static_cast<int>(decoder.index().times.size());
    if (count > 0) decoder.decode(count - 1);
    if (count > 0) decoder.decode(0);
  });
  return 0;
}
