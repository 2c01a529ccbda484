// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// Runs a script of this folder with its own display and working folder.
Outcome driven(const std::string& script, const std::string& arguments) {
  return shell("cd '{}' && '" GPO_SOURCE_DIR "/tests/with_display.sh' 1920x1080 '" GPO_SOURCE_DIR
               "/tests/app/{}' '" GPO_PROGRAM "' '{}' {}",
               fresh_folder(),
               script,
               kDesk,
               arguments);
}

class RealWindow : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* tool : {"Xvfb", "xdotool", "import"})
      if (shell(std::string("command -v ") + tool).exit_code != 0)
        GTEST_SKIP() << tool << " is not installed";
    if (!fs::exists(desk())) GTEST_SKIP() << "no bundled recording";
  }
};

TEST_F(RealWindow, ReactsToKeysAndExitsWithZero) {
  const Outcome outcome = driven("drive_window.sh", "");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
}

TEST_F(RealWindow, FollowsATourByMouseAndKeyboard) {
  if (shell("/usr/bin/python3 -c 'import Xlib'").exit_code != 0)
    GTEST_SKIP() << "python3-xlib is not installed";
  const fs::path other = fs::path(GPO_TEST_OUTPUT_DIR) / "dropped";
  fs::copy(desk(), other, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  const Outcome outcome = driven("tour_window.sh", "'" + other.string() + "'");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
}

TEST(View, WithoutADisplayPointsToSnapshot) {
  const Outcome outcome = program("view {}", kDesk);
  expect_exit(2, outcome, "display");
  EXPECT_THAT(outcome.err, HasSubstr("snapshot"));
}

TEST(View, RefusesAMissingRecordingAsRunDoes) {
  for (const char* command : {"view", "run"})
    expect_refused(program("{} no/such/folder", command), "no/such/folder: no such file or folder");
}

}  // namespace
}  // namespace gpo::test
