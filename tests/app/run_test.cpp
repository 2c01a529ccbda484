// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/pose.h"
#include "engine/window/tracks.h"
#include "tests/app/program.h"

#include <algorithm>
#include <array>
#include <sstream>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

json run_json(const std::string& arguments, int expected_exit = 0) {
  const fs::path file = fresh_folder() / "result.json";
  const Outcome outcome = program("run " + arguments + " --json " + file.string());
  EXPECT_EQ(outcome.exit_code, expected_exit) << outcome.out << outcome.err;
  return json::parse(read_file(file));
}

TEST(Run, ScanWritesALineAStart) {
  const fs::path folder = fresh_folder();
  const Outcome outcome = program("run " + desk().string() + " --frames 20 --scan-step 13 --scan " +
                                  (folder / "scan.csv").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("4 starts, 13 frames apart, of windows of 20 frames: "));
  EXPECT_THAT(outcome.out, HasSubstr("best start: "));
  std::istringstream csv(read_file(folder / "scan.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "start,time_s,status,verdict,sigma_deg,pne_deg,reason");
  for (int start = 0; start < 40; start += 13) {
    ASSERT_TRUE(std::getline(csv, line));
    EXPECT_TRUE(line.starts_with(std::to_string(start) + ",")) << line;
    EXPECT_THAT(line, HasSubstr(",ok,ready,"));
  }
  EXPECT_FALSE(std::getline(csv, line));
  const Outcome long_one =
      program("run " + desk().string() + " --frames 900 --scan " + (folder / "b.csv").string());
  EXPECT_EQ(long_one.exit_code, 2);
  EXPECT_THAT(long_one.err, HasSubstr("--frames: 900, but desk has 60 frames"));
}

TEST(Run, DeskGivesWhatTheContractPromises) {
  const json j = run_json(desk().string());
  EXPECT_EQ(j["method"], "gpo_joint");
  EXPECT_EQ(j["status"], "ok");
  EXPECT_EQ(j["reason"], "");
  EXPECT_EQ(j["window"]["start"], 0);
  EXPECT_EQ(j["window"]["frames"], 30);
  EXPECT_EQ(j["settings"]["rotations"], "gyro-calibrated");
  EXPECT_EQ(j["settings"]["tracking"], "anchored");
  EXPECT_EQ(j["settings"]["inliers"], "planes");
  EXPECT_EQ(j["planes"][0]["normal"], j["plane"]["normal"]);
  EXPECT_EQ(j["planes"][0]["tracks"].size(), j["window"]["inliers"]);
  EXPECT_EQ(j["verdict"]["scene"], "several planes") << "the desk, and the books on it";
  EXPECT_LT(j["metrics"]["pne_deg"], 0.02);
  EXPECT_EQ(j["settings"]["ransac"], true);
  EXPECT_EQ(j["settings"]["ransac_threshold_px"], 2.0);
  EXPECT_EQ(j["settings"]["seed"], 1);
  EXPECT_EQ(j["plane"]["distance"], 1.0);
  EXPECT_LT(j["plane"]["normal"][2], 0);
  EXPECT_EQ(j["frames"].size(), 30U);
  EXPECT_EQ(j["frames"][0]["p_wc"], json::parse("[0.0, 0.0, 0.0]"));
  EXPECT_EQ(j["frames"][29]["index"], 29);
  EXPECT_EQ(j["points"].size(), j["window"]["inliers"]);
  EXPECT_EQ(j["solver"]["unknowns"], 182) << "two planes, 29 poses, the gyroscope's bias";
  EXPECT_EQ(j["solver"]["termination"], "convergence");
  for (const char* key : {"track", "ransac", "rotations", "initialize", "optimize", "total"}) {
    EXPECT_GE(j["timing_ms"][key], 0) << key;
  }
  EXPECT_LE(j["timing_ms"]["optimize"], j["timing_ms"]["initialize"]);
}

TEST(Run, CandidatesAreThereWhereHomographiesWereDecomposed) {
  EXPECT_FALSE(run_json(desk().string()).contains("candidates"));
  const json j = run_json(desk().string() + " --start 5 --frames 20 --method pnp");
  ASSERT_TRUE(j.contains("candidates"));
  int taken = 0;
  for (const json& candidate : j["candidates"]) {
    EXPECT_GE(candidate["frame"], 6);  // counted in the recording
    EXPECT_LE(candidate["frame"], 24);
    EXPECT_EQ(candidate["decomposition"], "malis_vargas");
    EXPECT_EQ(candidate["normal"].size(), 3U);
    EXPECT_EQ(candidate["tau"].size(), 3U);
    EXPECT_EQ(candidate["q_21_xyzw"].size(), 4U);
    EXPECT_GE(candidate["score"], 0);
    taken += candidate["rejected"] == "" ? 1 : 0;
  }
  EXPECT_GE(taken, 1);
}

TEST(Run, DeskIsAccurate) {
  const json metrics = run_json(desk().string())["metrics"];
  EXPECT_EQ(metrics["alignment"], "ok");
  EXPECT_LT(metrics["pne_deg"], 1.0);
  EXPECT_LT(metrics["pne_aligned_deg"], 1.5);
  EXPECT_LT(metrics["ate_m"], 0.005);
  EXPECT_LT(metrics["pde_m"], 0.02);
  EXPECT_GT(metrics["pne_bound_deg"], 0);
}

TEST(Run, BoardStandsInForAMissingPlaneFile) {
  const fs::path copy = fresh_folder() / "desk";
  fs::copy(desk(), copy, fs::copy_options::recursive);
  fs::remove(copy / "plane.yaml");
  const fs::path file = fs::path(GPO_TEST_OUTPUT_DIR) / "without_plane.json";
  ASSERT_EQ(program("run " + copy.string() + " --json " + file.string()).exit_code, 0);
  const json with = run_json(desk().string())["metrics"];
  const json without = json::parse(read_file(file))["metrics"];
  EXPECT_NEAR(without["pne_deg"], with["pne_deg"], 0.2);
  EXPECT_NEAR(without["pde_m"], with["pde_m"], 0.002);
}

TEST(Run, AllRotationSourcesOfTheDeskAgree) {
  for (const char* source : {"gyro", "gyro-calibrated", "averaging", "truth"}) {
    const json j = run_json(desk().string() + " --rotations " + source);
    EXPECT_EQ(j["settings"]["rotations"], source);
    EXPECT_LT(j["metrics"]["pne_deg"], 2.0) << source;
  }
}

TEST(Run, SameInputSettingsAndSeedGiveTheSameFile) {
  json a = run_json(desk().string() + " --seed 7");
  json b = run_json(desk().string() + " --seed 7");
  a.erase("timing_ms");
  b.erase("timing_ms");
  EXPECT_EQ(a.dump(), b.dump());
}

TEST(Run, TrajectoryIsTumAndPointsArePly) {
  const fs::path folder = fresh_folder();
  const std::string files = " --trajectory " + (folder / "t.txt").string() + " --points " +
                            (folder / "p.ply").string() + " --json " + (folder / "r.json").string();
  ASSERT_EQ(program("run " + desk().string() + files).exit_code, 0);
  const json j = json::parse(read_file(folder / "r.json"));
  std::istringstream trajectory(read_file(folder / "t.txt"));
  std::string line;
  std::getline(trajectory, line);
  EXPECT_EQ(line[0], '#');
  for (const json& frame : j["frames"]) {
    ASSERT_TRUE(std::getline(trajectory, line));
    std::istringstream row(line);
    std::array<double, 8> v{};
    for (double& x : v) row >> x;
    EXPECT_NEAR(v[0], frame["timestamp_ns"].get<double>() * 1e-9, 1e-5);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(v[1 + k], frame["p_wc"][k], 1e-8);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(v[4 + k], frame["q_wc_xyzw"][k], 1e-8);
  }
  EXPECT_FALSE(std::getline(trajectory, line));
  EXPECT_THAT(read_file(folder / "p.ply"),
              HasSubstr("element vertex " + std::to_string(j["points"].size())));
}

TEST(Run, TrajectoryAndPointsAreInMetersWhereTheAccelerometerTells) {
  const fs::path folder = fresh_folder();
  const auto z_of_first_point = [&](const std::string& options) {
    const fs::path ply = folder / "p.ply", path = folder / "t.txt";
    const Outcome outcome = program("run " + desk().string() + options + " --points " +
                                    ply.string() + " --trajectory " + path.string());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string unit = options.empty() ? "unit = distance of the plane" : "unit = meter";
    EXPECT_THAT(read_file(path), HasSubstr(unit));
    const std::string text = read_file(ply);
    EXPECT_THAT(text, HasSubstr(unit));
    std::istringstream points(text.substr(text.find("end_header\n") + 11));
    double x = 0, y = 0, z = 0;
    points >> x >> y >> z;
    return z;
  };
  const double scale = run_json(desk().string())["inertial"]["scale"];
  EXPECT_NEAR(z_of_first_point(" --metric"), scale * z_of_first_point(""), 1e-8);
  const Outcome without = program("run " + desk().string() + " --gravity off --metric --points " +
                                  (folder / "none.ply").string());
  EXPECT_NE(without.exit_code, 0);
  EXPECT_THAT(without.err,
              HasSubstr("meters: found no scale (no accelerometer is used), expected one"));
  EXPECT_FALSE(fs::exists(folder / "none.ply"));
  EXPECT_THAT(program("run " + desk().string() + " --metric").err,
              HasSubstr("--metric is not used"));
}

TEST(Run, TableHasUnits) {
  const Outcome outcome = program("run " + desk().string());
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* text : {"status      ok", " px RMS", " mm\n", " deg", "iterations"}) {
    EXPECT_THAT(outcome.out, HasSubstr(text));
  }
}

TEST(Run, FailedInitializationExitsOneWithoutPoses) {
  const fs::path folder = fresh_folder();
  std::string tracks = "frame,track,x,y\n";
  for (int frame = 0; frame < 30; ++frame) {
    for (int track = 0; track < 40; ++track) {
      tracks +=
          fmt::format("{},{},{},{}\n", frame, track, 50 + 70 * (track % 8), 60 + 80 * (track / 8));
    }
  }
  write_file(folder / "still.csv", tracks);
  const Outcome outcome =
      program("run " + desk().string() + " --rotations averaging --tracks " +
              (folder / "still.csv").string() + " --json " + (folder / "r.json").string() +
              " --trajectory " + (folder / "t.txt").string());
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("failed: no parallax"));
  EXPECT_THAT(outcome.err, HasSubstr("--scan - lists the frames from which a window can be"));
  EXPECT_FALSE(fs::exists(folder / "t.txt"));
  const json j = json::parse(read_file(folder / "r.json"));
  EXPECT_EQ(j["status"], "failed");
  EXPECT_THAT(j["reason"], HasSubstr("no parallax"));
  EXPECT_TRUE(j["plane"].is_null());
  EXPECT_TRUE(j["frames"][0]["p_wc"].is_null());
  EXPECT_TRUE(j["points"].empty());
  EXPECT_FALSE(j.contains("metrics"));
}

TEST(Run, LeavesOutTracksByTheirIds) {
  const json whole = run_json(desk().string());
  const json without = run_json(desk().string() + " --exclude 23,17,23");
  EXPECT_EQ(without["settings"]["exclude"], (std::vector<int>{17, 23}));
  EXPECT_FALSE(whole["settings"].contains("exclude"));
  EXPECT_EQ(without["window"]["tracks"], whole["window"]["tracks"]);
  for (const json& point : without["points"])
    EXPECT_TRUE(point["track"] != 17 && point["track"] != 23);
}

TEST(Run, SaysWhatIsNotUsed) {
  const fs::path file = fresh_folder() / "result.json";
  const Outcome outcome =
      program("run " + desk().string() +
              " --frames 12 --method ba --loss huber --seed 2 --trajectory-format euroc --json " +
              file.string());
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err,
            "--loss is not used. Only gpo_joint lets one choose this\n"
            "--trajectory-format is not used. No trajectory is written\n");
  const json j = json::parse(read_file(file));
  EXPECT_EQ(j["unused_settings"],
            json::parse(R"(["solver", "error", "loss", "shutter", "planes", "time_offset"])"));
  EXPECT_EQ(run_json(desk().string() + " --method gpo_joint")["unused_settings"], json::array());
}

class RunOnBadInput : public testing::TestWithParam<BadInput> {};

TEST_P(RunOnBadInput, ExitsTwoWithOneLineAndLeavesNoFile) {
  const fs::path folder = fresh_folder();
  const Outcome outcome = program("run " + desk().string() + " " + GetParam().arguments +
                                  " --json " + (folder / "r.json").string());
  expect_refused(outcome, GetParam(), folder);
}

INSTANTIATE_TEST_SUITE_P(
    Usage,
    RunOnBadInput,
    testing::Values(
        BadInput{"--method gpoo", "--method: unknown value 'gpoo', expected one of gpo"},
        BadInput{"--start 60",
                 "--start: frame 60 is not in the recording, which has frames 0 to 59"},
        BadInput{"--start 40",
                 "30 frames from frame 40 on do not fit, the recording has 60 frames"},
        BadInput{"--frames 1", "--frames"},
        BadInput{"--start -1", "--start"},
        BadInput{"--start abc", "--start"},
        BadInput{"--rotations gyr", "--rotations: unknown value 'gyr'"},
        BadInput{"--tracking anchor", "--tracking: unknown value 'anchor', expected one of"},
        BadInput{"--inliers some", "--inliers: unknown value 'some', expected one of per-frame"},
        BadInput{"--solver gauss", "--solver: unknown value 'gauss', expected one of schur, ceres"},
        BadInput{"--error two", "--error: unknown value 'two', expected one of transfer"},
        BadInput{"--loss cauchy", "--loss: unknown value 'cauchy', expected one of squared"},
        BadInput{"--shutter fast", "--shutter: unknown value 'fast', expected one of estimated"},
        BadInput{"--exclude 3,9999",
                 "--exclude: track 9999 is not in the window, which has tracks 0 to"},
        BadInput{"--exclude 3,x", "--exclude"},
        BadInput{"--bogus", "--bogus"},
        BadInput{"--tracks no-such-file.csv", "no-such-file.csv"}));

TEST(Run, MissingRecordingIsBadInput) {
  const Outcome outcome = program("run no/such/folder");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no/such/folder"));
}

TEST(Run, TracksThatItWritesAreReadBackToTheSameResult) {
  // Beside the test's own folder, which every run empties.
  const std::string file = fresh_folder().string() + "-tracks.csv";
  const json written = run_json(desk().string() + " --frames 12 --tracks-out " + file);
  EXPECT_THAT(read_file(file), testing::StartsWith("#frame,track,x,y,plane,verdict,residual_px,"));
  const json read = run_json(desk().string() + " --frames 12 --tracks " + file);
  EXPECT_EQ(read["window"]["tracks"], written["window"]["tracks"]);
  EXPECT_EQ(read["window"]["inliers"], written["window"]["inliers"]);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(read["plane"]["normal"][k], written["plane"]["normal"][k], 1e-6);
}

/// The contract's real recordings; they are not part of the repository.
class SharedRecordings : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(shared(""))) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  }
  static fs::path shared(const std::string& name) {
    return fs::path(GPO_SHARED_DIR) / "data" / name;
  }
};

TEST_F(SharedRecordings, ChessboardFloorInitializesByAveraging) {
  const json j = run_json(shared("chessboard-floor").string() + " --start 180");
  EXPECT_EQ(j["settings"]["rotations"], "averaging");
  EXPECT_EQ(j["metrics"]["alignment"], "ok");
  EXPECT_LT(j["metrics"]["pne_deg"], 2.0);
  EXPECT_LT(j["metrics"]["ate_m"], 0.01);
}

TEST_F(SharedRecordings, CardsTracksInitializeByGyroscope) {
  for (const int start : {1, 139, 259}) {
    const json j = run_json(shared("cards-tracks").string() + " --tracks " +
                            shared("cards-tracks/tracks.csv").string() + " --frames 16 --start " +
                            std::to_string(start));
    EXPECT_EQ(j["status"], "ok") << start;
    const double squares = 2 * j["solver"]["final_cost"].get<double>();
    EXPECT_LT(std::sqrt(2 * squares / j["solver"]["residuals"].get<double>()), 1.5) << start;
    EXPECT_FALSE(j.contains("metrics"));
  }
}

}  // namespace
}  // namespace gpo::test
