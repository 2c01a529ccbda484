// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using ::testing::HasSubstr;

TEST(View, ReactsToKeysInARealWindowAndClosesWithZero) {
  for (const char* tool : {"xvfb-run", "xdotool", "import"}) {
    if (shell(std::string("command -v ") + tool).exit_code != 0) {
      GTEST_SKIP() << tool << " is not installed";
    }
  }
  if (!std::filesystem::exists(desk())) GTEST_SKIP() << "no bundled recording";
  const Outcome outcome = shell("cd '" + fresh_folder().string() +
                                "' && xvfb-run -a -s '-screen 0 1280x1024x24' '" GPO_SOURCE_DIR
                                "/tests/app/drive_window.sh' '" GPO_PROGRAM "' '" +
                                desk().string() + "'");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
}

TEST(View, WithoutADisplaySaysWhatWorksWithoutOne) {
  const Outcome outcome = program("view");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("display"));
  EXPECT_THAT(outcome.err, HasSubstr("snapshot"));
}

TEST(View, OfWhatIsNotThereSaysSo) {
  const Outcome outcome = program("view no/such/folder");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no/such/folder: no such file or folder"));
}

}  // namespace
}  // namespace gpo::test
