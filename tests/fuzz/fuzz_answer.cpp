// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// What a user's own method answers.
#include "engine/commands/answer.h"
#include "tests/fuzz/fuzzed_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gpo::fuzz::parse([&] {
    gpo::read_answer(gpo::fuzz::bytes_of(data, size),
                     {.id = 1, .frames = 2, .tracks = 4, .planes = 2});
  });
  return 0;
}
