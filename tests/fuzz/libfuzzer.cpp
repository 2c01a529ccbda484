// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's entry points for the target that GPO_FUZZ_TARGET names.
#include "tests/fuzz/targets.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {

gpo::fuzz::Target chosen{};

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  gpo::fuzz::quiet_libraries();
  const char* name = std::getenv("GPO_FUZZ_TARGET");
  for (const auto& target : gpo::fuzz::targets())
    if (name != nullptr && std::string_view(name) == target.name) chosen = target;
  if (chosen.read != nullptr) return 0;
  std::fputs("GPO_FUZZ_TARGET names no target. Choose one of:\n", stderr);
  for (const auto& target : gpo::fuzz::targets()) std::fprintf(stderr, "%s\n", target.name);
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen.read({reinterpret_cast<const char*>(data), size});
  return 0;
}
