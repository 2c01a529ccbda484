// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

TEST(RunOutputs, ReportsUnwritableOutputBeforeTheWork) {
  const Outcome outcome = program("run {} --json README.md/such/r.json", kDesk);
  expect_refused(outcome, "README.md/such/r.json: cannot be written, no folder can be created in ");
  EXPECT_EQ(outcome.out, "");
}

TEST(RunOutputs, StandardOutputHasOnlyTheRequestedOutput) {
  const std::string run = "run " + kDesk + " --frames 8 ";
  const Outcome result = succeeding("{}--json -", run);
  EXPECT_TRUE(json::accept(result.out)) << result.out.substr(0, 200);
  EXPECT_THAT(result.err, HasSubstr("status      ok"));
  const Outcome points = program("{}--points -", run);
  EXPECT_TRUE(points.out.starts_with("ply\n")) << points.out.substr(0, 200);
  const Outcome both = program("{}--json - --points -", run);
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_EQ(both.out, "");
}

TEST(RunOutputs, RefusesOneFileForTwoOutputs) {
  const fs::path folder = fresh_folder();
  const std::string run = "run " + kDesk + " --frames 8 ";
  fs::create_symlink("a.txt", folder / "link.txt");
  for (const char* other : {"a.txt", "./a.txt", "x/../a.txt", "link.txt"})
    for (const char* option : {"trajectory", "true-trajectory", "points"})
      expect_exit(2,
                  program("{0}--json {1}/a.txt --{2} {1}/{3}", run, folder, option, other),
                  "expected a file for each");
  EXPECT_FALSE(fs::exists(folder / "a.txt"));
  succeeding("{}--json /dev/null --points /dev/null", run);
}

TEST(RunOutputs, DoesNotOverwriteItsInput) {
  const fs::path file = fresh_folder() / "tracks.csv";
  write_file(file, "frame,track,x,y\n0,1,2,3\n");
  expect_exit(2,
              program("run {0} --tracks {1} --json {1}", kDesk, file),
              fmt::format("--json and --tracks: found {} for both", file));
  EXPECT_THAT(read_file(file), HasSubstr("frame,track"));
}

TEST(Outputs, DoNotOverwriteWhatARecordingWasReadFrom) {
  const fs::path copy = fresh_folder() / "desk";
  fs::copy(desk(), copy, fs::copy_options::recursive);
  for (const auto& [command, file] : std::vector<std::pair<std::string, fs::path>>{
           {"run {} --frames 8 --export ply={}", "mav0/cam0/sensor.yaml"},
           {"run {} --frames 8 --json {}", "mav0/imu0/data.csv"},
           {"run {} --frames 8 --trajectory {}", "mav0/state_groundtruth_estimate0/data.csv"},
           {"run {} --frames 8 --json {}", "mav0/imu0/sensor.yaml"},
           {"calibrate {} --gyroscope --output {}", "mav0/cam0/sensor.yaml"}}) {
    const fs::path output = copy / file;
    const std::string before = read_file(output);
    expect_exit(2,
                program(fmt::runtime(command), copy, output),
                "belongs to the recording and would be overwritten");
    EXPECT_EQ(read_file(output), before);
  }
  const fs::path own = copy / "result.json";
  for (int time = 0; time < 2; ++time) succeeding("run {} --frames 8 --json {}", copy, own);
}

TEST(Outputs, DoNotOverwriteItFromScripts) {
  const fs::path folder = fresh_folder(), copy = folder / "desk", script = folder / "script.txt";
  fs::copy(desk(), copy, fs::copy_options::recursive);
  const fs::path gyroscope = copy / "mav0/imu0/data.csv", camera = copy / "mav0/cam0/sensor.yaml";
  for (const auto& [line, file] : {std::pair("export trajectory ", gyroscope),
                                   {"export ply ", camera},
                                   {"export result ", camera}}) {
    const std::string before = read_file(file);
    write_file(script, line + file.string() + "\n");
    expect_exit(2,
                program("snapshot {} --frames 8 --script {}", copy, script),
                "belongs to the recording and would be overwritten");
    EXPECT_EQ(read_file(file), before) << line;
  }
}

}  // namespace
}  // namespace gpo::test
