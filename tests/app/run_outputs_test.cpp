// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

TEST(RunOutputs, UnwritableOutputIsToldBeforeTheWork) {
  const Outcome outcome = program("run " + desk().string() + " --json README.md/such/r.json");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("README.md/such/r.json: cannot be written, no folder can be made in "));
  EXPECT_EQ(outcome.out, "");
}

TEST(RunOutputs, MakesTheFoldersOfWhatItWrites) {
  const fs::path file = fresh_folder() / "a/b/r.json";
  const Outcome outcome = program("run " + desk().string() + " --frames 8 --json " + file.string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(json::accept(read_file(file)));
}

TEST(RunOutputs, WritesToStandardOutputWhatIsAskedForAndNothingElse) {
  const std::string run = "run " + desk().string() + " --frames 8 ";
  const Outcome result = program(run + "--json -");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(json::accept(result.out)) << result.out.substr(0, 200);
  EXPECT_THAT(result.err, HasSubstr("status      ok"));
  const Outcome points = program(run + "--points -");
  EXPECT_TRUE(points.out.starts_with("ply\n")) << points.out.substr(0, 200);
  const Outcome both = program(run + "--json - --points -");
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_EQ(both.out, "");
}

TEST(RunOutputs, RefusesOneFileForTwoOutputs) {
  const fs::path folder = fresh_folder();
  const std::string run = "run " + desk().string() + " --frames 8 ";
  const std::string file = (folder / "a.txt").string();
  fs::create_symlink("a.txt", folder / "link.txt");
  for (const std::string& other : {file,
                                   (folder / "." / "a.txt").string(),
                                   (folder / "x/../a.txt").string(),
                                   (folder / "link.txt").string()}) {
    for (const char* option : {"--trajectory ", "--true-trajectory ", "--points "}) {
      const Outcome outcome = program(run + "--json " + file + " " + option + other);
      EXPECT_EQ(outcome.exit_code, 2) << option << other;
      EXPECT_THAT(outcome.err, HasSubstr("expected a file for each"));
    }
  }
  EXPECT_FALSE(fs::exists(file));
  EXPECT_EQ(program(run + "--json /dev/null --points /dev/null").exit_code, 0);
}

TEST(RunOutputs, DoesNotWriteOverWhatItReads) {
  const fs::path file = fresh_folder() / "tracks.csv";
  write_file(file, "frame,track,x,y\n0,1,2,3\n");
  const std::string path = file.string();
  const Outcome outcome =
      program("run " + desk().string() + " --tracks " + path + " --json " + path);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--json and --tracks: found " + path + " for both"));
  EXPECT_THAT(read_file(file), HasSubstr("frame,track"));
}

}  // namespace
}  // namespace gpo::test
