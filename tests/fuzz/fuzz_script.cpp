// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzzed_file.h"
#include "ui/workbench/session/script.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = gpo::fuzz::file_of(gpo::fuzz::bytes_of(data, size));
  gpo::fuzz::parse([&] { gpo::read_script(file); });
  return 0;
}
