// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/calibration_file.h"
#include "tests/fuzz/fuzzed_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes = "=== camera.xml\n" + std::string(gpo::fuzz::bytes_of(data, size));
  const gpo::fuzz::Folder folder(bytes, {"camera.xml"});
  gpo::fuzz::parse([&] { gpo::read_calibration(folder.path() / "camera.xml"); });
  return 0;
}
