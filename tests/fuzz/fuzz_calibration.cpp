// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/companions/calibration_file.h"
#include "tests/fuzz/fuzzed_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = gpo::fuzz::file_of(gpo::fuzz::bytes_of(data, size));
  gpo::fuzz::parse([&] { gpo::read_calibration(file); });
  return 0;
}
