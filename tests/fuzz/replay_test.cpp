// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Seeds and former crashes of the fuzz targets, without mutations and sanitizers: tests/nightly.sh
// has those.
#include "tests/engine/peak_memory.h"
#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>

#include <gtest/gtest.h>

namespace gpo::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr long kMostKiB = 1 << 20;
const std::array<fs::path, 2> kKinds = {GPO_SOURCE_DIR "/tests/fuzz/seeds",
                                        GPO_SOURCE_DIR "/tests/fuzz/crashes"};

class FuzzReplay : public ::testing::TestWithParam<Target> {
 protected:
  static void SetUpTestSuite() { quiet_libraries(); }
};

TEST_P(FuzzReplay, ReadsOrRefusesEveryInputInBoundedMemory) {
  int inputs = 0;
  for (const fs::path& kind : kKinds) {
    const fs::path folder = kind / GetParam().name;
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
  for (const fs::path& kind : kKinds)
    for (const auto& entry : fs::directory_iterator(kind)) {
      const auto is_target = [&](const Target& one) { return entry.path().filename() == one.name; };
      EXPECT_TRUE(std::ranges::any_of(targets(), is_target)) << entry.path();
    }
}

}  // namespace
}  // namespace gpo::fuzz
