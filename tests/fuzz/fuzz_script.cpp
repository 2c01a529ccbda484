// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzzed_file.h"
#include "tests/fuzz/targets.h"
#include "ui/workbench/actions/actions.h"

void gpo::fuzz::fuzz_script(std::string_view bytes) {
  const auto file = gpo::fuzz::file_of(bytes);
  gpo::fuzz::parse([&] { gpo::read_script(file); });
}
