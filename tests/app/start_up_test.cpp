// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::AllOf, testing::Contains, testing::Each, testing::Lt, testing::Not, testing::SizeIs,
    testing::StartsWith;

/// Returns the shared libraries that a command loads, such as "libvtkCommonCore-9".
std::set<std::string> loaded_by(const std::string& arguments) {
  const Outcome outcome = shell("LD_DEBUG=files '" GPO_PROGRAM "' {} >/dev/null", arguments);
  EXPECT_EQ(outcome.exit_code, 0) << arguments;
  return matches_in(outcome.err, R"(calling init: \S*/(lib[^/\s]+?)\.)", 1);
}

/// Loading each takes longer than all others together.
const auto kNoneOfTheSlow = Each(AllOf(Not(StartsWith("libvtk")),
                                       Not(StartsWith("libopencv_imgcodecs")),
                                       Not(StartsWith("libgdal")),
                                       Not(StartsWith("libavformat"))));

TEST(StartUp, CommandsThatDrawNothingLoadFewLibraries) {
  EXPECT_THAT(loaded_by("--version"), AllOf(SizeIs(Lt(90)), kNoneOfTheSlow));
  EXPECT_THAT(loaded_by("run sequences/desk --frames 5"), AllOf(SizeIs(Lt(110)), kNoneOfTheSlow));
}

TEST(StartUp, CommandsThatDrawLoadLibrariesOfViews) {
  EXPECT_THAT(loaded_by("snapshot --help"), Contains(StartsWith("libvtk")));
}

TEST(StartUp, ReportsMissingProgramForDrawing) {
  const fs::path folder = fresh_folder();
  fs::create_directories(folder / "bin");
  fs::copy_file(GPO_PROGRAM, folder / "bin/gpo-inspector");
  const Outcome outcome = shell("'{}' snapshot", folder / "bin/gpo-inspector");
  expect_refused(outcome, "libexec/gpo-inspector/gpo-inspector: cannot be started: No such file");
}

}  // namespace
}  // namespace gpo::test
