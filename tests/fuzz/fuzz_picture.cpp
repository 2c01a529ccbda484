// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/told_view.h"
#include "engine/recording/pictures/picture_file.h"
#include "tests/fuzz/fuzzed_file.h"

#include <iostream>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::cerr.setstate(std::ios::failbit);  // OpenCV would tell each failure
  const auto file = gpo::fuzz::file_of(gpo::fuzz::bytes_of(data, size));
  gpo::fuzz::parse([&] { gpo::read_picture(file); });
  gpo::fuzz::parse([&] { gpo::view_of_exif(file); });
  return 0;
}
