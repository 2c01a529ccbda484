// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kFolder = GPO_SOURCE_DIR "/tests/app/results";
const std::string kColmap = "--result colmap=" + kFolder + "/colmap";
const std::string kOrb = "--result orb=" + kFolder + "/CameraTrajectory.txt";

TEST(Result, ColmapAndOrbSlamSolveTheDesk) {
  const json colmap = run_json("{} --method colmap {}", kDesk, kColmap);
  EXPECT_EQ(colmap["frames"].size(), 30U);
  const json orb = run_json("{} --method orb {}", kDesk, kOrb);
  EXPECT_GT(orb["uncertainty"]["normal_sigma_deg"], 0);
  for (const json& result : {colmap, orb}) {
    EXPECT_LT(result["metrics"]["pne_deg"], 2);
    EXPECT_LT(result["metrics"]["ate_m"], 1e-3);
  }
}

TEST(Result, ReportsItsFormatOnce) {
  EXPECT_EQ(program("run {} --method orb {}", kDesk, kOrb).err,
            "orb: TUM with nanoseconds, camera poses; 28 of the window's 30 frames, the "
            "others resected; plane through points triangulated from its cameras\n");
}

TEST(Result, ReadsOurOwnTrajectory) {
  const fs::path file = fresh_folder() / "trajectory";
  for (const char* format : {"tum", "euroc", "kitti"}) {
    const json ours =
        run_json("{0} --frames 10 --trajectory {1} --trajectory-format {2} --points {1}.ply",
                 kDesk,
                 file,
                 format);
    const json back = run_json("{0} --frames 10 --method it --result it={1},{1}.ply", kDesk, file);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(back["plane"]["normal"][k], ours["plane"]["normal"][k], 1e-6) << format;
      EXPECT_NEAR(back["frames"][9]["p_wc"][k], ours["frames"][9]["p_wc"][k], 1e-6) << format;
    }
  }
}

TEST(Result, IsShownInComparisonAndExperiment) {
  const fs::path folder = fresh_folder();
  const std::string both = fmt::format("{} --methods gpo,colmap,orb {} {}", kDesk, kColmap, kOrb);
  succeeding("snapshot {} --view compare --output {}", both, folder / "compare.png");
  EXPECT_GT(fs::file_size(folder / "compare.png"), 100'000U);
  succeeding("evaluate {} --lengths 15:30:15 --starts 0:60:15 --output {}", both, folder / "out");
  EXPECT_THAT(
      read_file(folder / "out/results.csv"),
      AllOf(HasSubstr("orb: has 0 of the window's 15 frames"), HasSubstr("colmap: has 0 of")));
}

TEST(Result, IsPartOfSessions) {
  const fs::path folder = fresh_folder();
  const fs::path session = folder / "session.json", script = folder / "script.txt";
  write_file(script, "save-session " + session.string() + "\n");
  succeeding("snapshot {} --method orb {} --script {}", kDesk, kOrb, script);
  EXPECT_EQ(read_json(session)["results"],
            json::array({"orb=" + kFolder + "/CameraTrajectory.txt"}));
  const fs::path result = folder / "result.json";
  write_file(script, fmt::format("open {}\nexport result {}\n", session, result));
  succeeding("snapshot --script {}", script);
  const json opened = read_json(result);
  EXPECT_EQ(opened["method"], "orb");
  EXPECT_LT(opened["metrics"]["ate_m"], 1e-3);
}

TEST(Result, RefusesBadFilesBeforeAnyWork) {
  const fs::path folder = fresh_folder(), bad = folder / "bad.txt", json = folder / "a.json";
  write_file(bad, "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 0\n");
  for (const BadInput& one : {BadInput{"it", "--result: 'it', expected NAME=FILE"},
                              {"gpo=" + kFolder + "/colmap", "there already is a method 'gpo'"},
                              {"it=" + bad.string(), "bad.txt:2: found a quaternion of norm 0"},
                              {"it=" + folder.string() + "/none", "none: no such file"},
                              {"it=" + folder.string(), "found neither images.bin nor images.txt"},
                              {"it=" + bad.string() + ",frame=wheel", "wheel"}}) {
    expect_exit(
        2, program("run {} --json {} --result {}", kDesk, json, one.arguments), one.message);
    EXPECT_FALSE(fs::exists(json)) << one.arguments;
  }
}

}  // namespace
}  // namespace gpo::test
