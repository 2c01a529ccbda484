// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// What a user's own method answers.
#include "engine/external_methods/answer.h"
#include "tests/fuzz/fuzzed_file.h"
#include "tests/fuzz/targets.h"

void gpo::fuzz::fuzz_answer(std::string_view bytes) {
  gpo::fuzz::parse(
      [&] { gpo::read_answer(bytes, {.id = 1, .frames = 2, .tracks = 4, .planes = 2}); });
}
