// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Another program's result as a method.
#include "tests/app/program.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::BadInput;
using test::desk;
using test::fresh_folder;
using test::Outcome;
using test::read_file;
using test::spawned;
using test::write_file;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kFolder = GPO_SOURCE_DIR "/tests/app/results";
const std::string kColmap = "--result colmap=" + kFolder + "/colmap";
const std::string kOrb = "--result orb=" + kFolder + "/CameraTrajectory.txt";

json result_of(const std::string& arguments, const fs::path& folder) {
  const fs::path file = folder / "result.json";
  const Outcome outcome = spawned("run " + arguments + " --json " + file.string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  return outcome.exit_code == 0 ? json::parse(read_file(file)) : json{};
}

TEST(Result, ColmapAndOrbSlamSolveTheDesk) {
  const fs::path folder = fresh_folder();
  const json colmap = result_of(desk().string() + " --method colmap " + kColmap, folder);
  EXPECT_LT(colmap["metrics"]["pne_deg"], 2);
  EXPECT_LT(colmap["metrics"]["ate_m"], 1e-3);
  EXPECT_EQ(colmap["frames"].size(), 30U);
  const json orb = result_of(desk().string() + " --method orb " + kOrb, folder);
  EXPECT_LT(orb["metrics"]["pne_deg"], 2);
  EXPECT_LT(orb["metrics"]["ate_m"], 1e-3);
  EXPECT_GT(orb["uncertainty"]["normal_sigma_deg"], 0);
}

TEST(Result, WhatIsReadIsSaidOnce) {
  const Outcome outcome = spawned("run " + desk().string() + " --method orb " + kOrb);
  EXPECT_EQ(outcome.err,
            "orb: TUM with nanoseconds, camera poses; 28 of the window's 30 frames, the "
            "others resected; plane through points triangulated from its cameras\n");
}

// What ours writes of a window is the same window's result again.
TEST(Result, OurOwnTrajectoryComesBack) {
  const fs::path folder = fresh_folder();
  for (const std::string format : {"tum", "euroc", "kitti"}) {
    const fs::path file = folder / format, points = folder / "points.ply";
    ASSERT_EQ(spawned(fmt::format("run {} --frames 10 --trajectory {} --trajectory-format {} "
                                  "--points {}",
                                  desk().string(),
                                  file.string(),
                                  format,
                                  points.string()))
                  .exit_code,
              0);
    const json ours = result_of(desk().string() + " --frames 10", folder);
    const json back = result_of(fmt::format("{} --frames 10 --method it --result it={},{}",
                                            desk().string(),
                                            file.string(),
                                            points.string()),
                                folder);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(back["plane"]["normal"][k], ours["plane"]["normal"][k], 1e-6) << format;
      EXPECT_NEAR(back["frames"][9]["p_wc"][k], ours["frames"][9]["p_wc"][k], 1e-6) << format;
    }
  }
}

TEST(Result, ItStandsInTheComparisonTheCurvesAndTheExperiment) {
  const fs::path folder = fresh_folder();
  const std::string both =
      fmt::format("{} --methods gpo,colmap,orb {} {}", desk().string(), kColmap, kOrb);
  const Outcome compare =
      spawned("snapshot " + both + " --view compare --output " + (folder / "compare.png").string());
  EXPECT_EQ(compare.exit_code, 0) << compare.err;
  EXPECT_GT(fs::file_size(folder / "compare.png"), 100'000U);
  const Outcome evaluate =
      spawned("evaluate " + both + " --lengths 15:30:15 --starts 0:60:15 --output " +
              (folder / "out").string());
  EXPECT_EQ(evaluate.exit_code, 0) << evaluate.err;
  EXPECT_THAT(
      read_file(folder / "out/results.csv"),
      AllOf(HasSubstr("orb: has 0 of the window's 15 frames"), HasSubstr("colmap: has 0 of")));
}

// A file harms nobody: there is no question.
TEST(Result, ASessionBringsIt) {
  const fs::path folder = fresh_folder();
  const fs::path session = folder / "session.json", script = folder / "script.txt";
  write_file(script, "save-session " + session.string() + "\n");
  ASSERT_EQ(
      spawned(
          fmt::format(
              "snapshot {} --method orb {} --script {}", desk().string(), kOrb, script.string()))
          .exit_code,
      0);
  EXPECT_EQ(json::parse(read_file(session))["results"],
            json::array({"orb=" + kFolder + "/CameraTrajectory.txt"}));
  const fs::path result = folder / "result.json";
  write_file(script, fmt::format("open {}\nexport result {}\n", session.string(), result.string()));
  const Outcome outcome = spawned("snapshot --script " + script.string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const json opened = json::parse(read_file(result));
  EXPECT_EQ(opened["method"], "orb");
  EXPECT_LT(opened["metrics"]["ate_m"], 1e-3);
}

TEST(Result, BadFilesAreRefusedBeforeAnythingIsDone) {
  const fs::path folder = fresh_folder(), bad = folder / "bad.txt", json = folder / "a.json";
  write_file(bad, "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 0\n");
  const std::string run = "run " + desk().string() + " --json " + json.string() + " --result ";
  for (const BadInput& one : {
           BadInput{run + "it", "--result: 'it', expected NAME=FILE"},
           BadInput{run + "gpo=" + kFolder + "/colmap", "there already is a method 'gpo'"},
           BadInput{run + "it=" + bad.string(), "bad.txt:2: found a quaternion of norm 0"},
           BadInput{run + "it=" + folder.string() + "/none", "none: no such file"},
           BadInput{run + "it=" + folder.string(), "found neither images.bin nor images.txt"},
           BadInput{run + "it=" + bad.string() + ",frame=wheel", "wheel"},
       }) {
    const Outcome outcome = spawned(one.arguments);
    EXPECT_EQ(outcome.exit_code, 2) << one;
    EXPECT_THAT(outcome.err, HasSubstr(one.message));
    EXPECT_FALSE(fs::exists(json)) << one;
  }
}

}  // namespace
}  // namespace gpo
