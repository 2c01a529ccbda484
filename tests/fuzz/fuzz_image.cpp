// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/camera_source.h"
#include "engine/recording/images/image_file.h"
#include "tests/fuzz/fuzzed_file.h"
#include "tests/fuzz/targets.h"

void gpo::fuzz::fuzz_image(std::string_view bytes) {
  const auto file = gpo::fuzz::file_of(bytes);
  gpo::fuzz::parse([&] { gpo::read_image(file); });
  gpo::fuzz::parse([&] { gpo::view_of_exif(file); });
}
