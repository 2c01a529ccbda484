// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Seeds and former crashes of the fuzz targets, without mutations and sanitizers: tests/nightly.sh
// has those.
#include "tests/engine/peak_memory.h"
#include "tests/fuzz/targets.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include <gtest/gtest.h>

namespace gpo::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr long kMostKiB = 1 << 20;

class FuzzReplay : public ::testing::TestWithParam<Target> {
 protected:
  static void SetUpTestSuite() { quiet_libraries(); }
};

TEST_P(FuzzReplay, ReadsOrRefusesEveryInputInBoundedMemory) {
  const fs::path fuzz = fs::path(GPO_SOURCE_DIR) / "tests/fuzz";
  int inputs = 0;
  for (const char* kind : {"seeds", "crashes"}) {
    const fs::path folder = fuzz / kind / GetParam().name;
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder)) {
      std::ifstream stream(entry.path(), std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
      const test::PeakMemory memory;
      EXPECT_NO_THROW(GetParam().read(bytes)) << entry.path();
      EXPECT_LT(memory.kib(), kMostKiB) << entry.path();
      ++inputs;
    }
  }
  EXPECT_GT(inputs, 0);
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzReplay, ::testing::ValuesIn(targets()), [](const auto& info) {
  return std::string(info.param.name);
});

TEST(FuzzTargets, EveryFolderOfInputsBelongsToOne) {
  for (const char* kind : {"seeds", "crashes"}) {
    for (const auto& entry :
         fs::directory_iterator(fs::path(GPO_SOURCE_DIR) / "tests/fuzz" / kind)) {
      const std::string name = entry.path().filename();
      const bool known =
          std::ranges::any_of(targets(), [&](const Target& target) { return name == target.name; });
      EXPECT_TRUE(known) << entry.path();
    }
  }
}

}  // namespace
}  // namespace gpo::fuzz
