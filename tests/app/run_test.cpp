// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "engine/window/tracks.h"
#include "tests/app/program.h"

#include <array>
#include <sstream>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::AllOf, testing::HasSubstr, testing::StartsWith;

TEST(Run, ScanWritesOneLineForEachStart) {
  const fs::path folder = fresh_folder();
  const Outcome outcome =
      succeeding("run {} --frames 20 --scan-step 13 --scan {}", kDesk, folder / "scan.csv");
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("4 starts, 13 frames apart, windows of 20 frames: "),
                    HasSubstr("best start: ")));
  const auto lines = split(read_file(folder / "scan.csv"), '\n');
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_EQ(lines[0], "start,time_s,status,verdict,sigma_deg,pne_deg,reason");
  for (int k = 0; k < 4; ++k)
    EXPECT_THAT(lines[k + 1],
                AllOf(StartsWith(fmt::format("{},", 13 * k)), HasSubstr(",ok,ready,")));
  expect_exit(2,
              program("run {} --frames 900 --scan {}", kDesk, folder / "b.csv"),
              "--frames: 900, but desk has 60 frames");
}

TEST(Run, DeskHasAllDocumentedKeys) {
  const json j = run_json(kDesk);
  for (const auto& [pointer, value] : std::vector<std::pair<const char*, json>>{
           {"/method", "gpo_joint"},
           {"/status", "ok"},
           {"/reason", ""},
           {"/window/start", 0},
           {"/window/frames", 30},
           {"/settings/rotations", "gyro-calibrated"},
           {"/settings/tracking", "anchored"},
           {"/settings/inliers", "planes"},
           {"/settings/ransac", true},
           {"/settings/ransac_threshold_px", 2.0},
           {"/settings/seed", 1},
           {"/verdict/scene", "several planes"},  // the desk and the books on it
           {"/plane/distance", 1.0},
           {"/frames/0/p_wc", {0.0, 0.0, 0.0}},
           {"/frames/29/index", 29},
           {"/solver/unknowns", 183},  // two planes, 29 poses, gyroscope bias and clock
           {"/solver/termination", "convergence"},
           {"/metrics/alignment", "ok"}})
    EXPECT_EQ(j.at(json::json_pointer(pointer)), value) << pointer;
  EXPECT_EQ(j["planes"][0]["normal"], j["plane"]["normal"]);
  EXPECT_EQ(j["planes"][0]["tracks"].size(), j["window"]["inliers"]);
  EXPECT_LT(j["metrics"]["pne_deg"], 0.02);
  EXPECT_LT(j["metrics"]["pne_aligned_deg"], 1.5);
  EXPECT_LT(j["metrics"]["ate_m"], 0.005);
  EXPECT_LT(j["metrics"]["pde_m"], 0.02);
  EXPECT_GT(j["metrics"]["pne_bound_deg"], 0);
  EXPECT_LT(j["plane"]["normal"][2], 0);
  EXPECT_EQ(j["frames"].size(), 30U);
  EXPECT_EQ(j["frames"][0]["lost"], 0);
  EXPECT_GT(j["window"]["lost"], 0);
  EXPECT_EQ(j["window"]["lost"], j["frames"][29]["lost"]);
  EXPECT_EQ(j["points"].size(), j["window"]["inliers"]);
  for (const char* key : {"track", "ransac", "rotations", "initialize", "optimize", "total"})
    EXPECT_GE(j["timing_ms"][key], 0) << key;
  EXPECT_LE(j["timing_ms"]["optimize"], j["timing_ms"]["initialize"]);
}

TEST(Run, HasCandidatesIfHomographiesWereDecomposed) {
  EXPECT_FALSE(run_json(kDesk).contains("candidates"));
  const json j = run_json("{} --start 5 --frames 20 --method pnp", kDesk);
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

TEST(Run, BoardReplacesAMissingPlaneFile) {
  const fs::path copy = copy_of_desk(fresh_folder() / "desk", {"plane.yaml"});
  const json with = run_json(kDesk)["metrics"], without = run_json(copy.string())["metrics"];
  EXPECT_NEAR(without["pne_deg"], with["pne_deg"], 0.2);
  EXPECT_NEAR(without["pde_m"], with["pde_m"], 0.002);
}

TEST(Run, AllRotationSourcesOfTheDeskAgree) {
  for (const char* source : {"gyro", "gyro-calibrated", "averaging", "truth"}) {
    const json j = run_json("{} --rotations {}", kDesk, source);
    EXPECT_EQ(j["settings"]["rotations"], source);
    EXPECT_LT(j["metrics"]["pne_deg"], 2.0) << source;
  }
}

TEST(Run, SameInputSettingsAndSeedGiveTheSameResult) {
  json a = run_json("{} --seed 7", kDesk), b = run_json("{} --seed 7", kDesk);
  a.erase("timing_ms");
  b.erase("timing_ms");
  EXPECT_EQ(a.dump(), b.dump());
}

TEST(Run, TwoPointsSetScaleAndWorldOfTheExports) {
  const fs::path folder = fresh_folder();
  const json j = run_json(
      "{0} --scale-points 137,231,432,334 --scale-length 0.3 --world-points 137,231,432,334 "
      "--trajectory {1}/t.txt --points {1}/p.ply",
      kDesk,
      folder);
  EXPECT_EQ(j["metric_scale"]["source"], "points");
  const json& T = j["world"]["T_world_reference"];
  EXPECT_EQ(T["scale"], j["metric_scale"]["meters_per_unit"]);
  EXPECT_EQ(j["world"]["unit"], "m");
  EXPECT_NEAR(j["world"]["planes"][0]["normal"][2], 1, 1e-9);
  EXPECT_NEAR(j["world"]["planes"][0]["distance"], 0, 1e-9);
  const std::string path = read_file(folder / "t.txt"), points = read_file(folder / "p.ply");
  EXPECT_THAT(path,
              HasSubstr("world = chosen (z normal to the plane, x towards a second point); "
                        "unit = meter"));
  EXPECT_THAT(points, HasSubstr("unit = meter"));
  std::istringstream first(split(path, '\n').at(1));
  double seconds = 0;
  first >> seconds;
  for (int k = 0; k < 3; ++k) {
    double coordinate = 0;
    first >> coordinate;
    EXPECT_NEAR(coordinate, T["t"][k], 1e-8) << k;
  }
  const auto refuse = [](const char* options, const char* message) {
    expect_exit(2, program("run {} {}", kDesk, options), message);
  };
  refuse("--scale-points 5,5,6,6 --scale-length 1", "point (5, 5) is on no plane");
  refuse("--scale-points 5,5,5,5 --scale-length 1", "expected two different points");
  refuse("--scale-points 137,231,432,334 --scale-length 0", "expected a number from 1e-06");
  refuse("--scale-points 137,231,432,334", "scale_points need scale_length");
}

TEST(Run, TrajectoryIsTumAndPointsArePly) {
  const fs::path folder = fresh_folder();
  const json j = run_json("{0} --trajectory {1}/t.txt --points {1}/p.ply", kDesk, folder);
  const auto lines = split(read_file(folder / "t.txt"), '\n');
  ASSERT_EQ(lines.size(), 31U);
  EXPECT_EQ(lines[0][0], '#');
  for (int i = 0; i < 30; ++i) {
    const json& frame = j["frames"][i];
    std::istringstream row(lines[i + 1]);
    std::array<double, 8> v{};
    for (double& x : v) row >> x;
    EXPECT_NEAR(v[0], frame["timestamp_ns"].get<double>() * 1e-9, 1e-5);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(v[1 + k], frame["p_wc"][k], 1e-8);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(v[4 + k], frame["q_wc_xyzw"][k], 1e-8);
  }
  EXPECT_THAT(read_file(folder / "p.ply"),
              HasSubstr("element vertex " + std::to_string(j["points"].size())));
}

TEST(Run, MetricTrajectoryAndPointsAreInMeters) {
  const fs::path folder = fresh_folder();
  const auto z_of_first_point = [&](const std::string& options) {
    const fs::path ply = folder / "p.ply", path = folder / "t.txt";
    succeeding("run {}{} --points {} --trajectory {}", kDesk, options, ply, path);
    const std::string unit = options.empty() ? "unit = distance of the plane" : "unit = meter";
    EXPECT_THAT(read_file(path), HasSubstr(unit));
    const std::string text = read_file(ply);
    EXPECT_THAT(text, HasSubstr(unit));
    std::istringstream points(text.substr(text.find("end_header\n") + 11));
    double x = 0, y = 0, z = 0;
    points >> x >> y >> z;
    return z;
  };
  const double scale = run_json(kDesk)["inertial"]["scale"];
  EXPECT_NEAR(z_of_first_point(" --metric"), scale * z_of_first_point(""), 1e-8);
  const Outcome off = program("run {} --gravity off --metric --points {}/none.ply", kDesk, folder);
  EXPECT_NE(off.exit_code, 0);
  EXPECT_THAT(off.err, HasSubstr("meters: the scale is unknown (no accelerometer is used)"));
  EXPECT_FALSE(fs::exists(folder / "none.ply"));
  EXPECT_THAT(program("run {} --metric", kDesk).err, HasSubstr("--metric is not used"));
}

TEST(Run, TableShowsUnits) {
  const Outcome outcome = succeeding("run {}", kDesk);
  for (const char* text : {"status      ok", " px RMS", " mm\n", " deg", "iterations"})
    EXPECT_THAT(outcome.out, HasSubstr(text));
}

TEST(Run, FailedInitializationExitsOneWithoutPoses) {
  const fs::path folder = fresh_folder();
  std::string tracks = "frame,track,x,y\n";
  for (int frame = 0; frame < 30; ++frame)
    for (int track = 0; track < 40; ++track)
      tracks +=
          fmt::format("{},{},{},{}\n", frame, track, 50 + 70 * (track % 8), 60 + 80 * (track / 8));
  write_file(folder / "still.csv", tracks);
  const Outcome outcome = program(
      "run sequences/desk --rotations averaging --tracks {0}/still.csv --json {0}/r.json "
      "--trajectory {0}/t.txt --export ply={0}/map.ply",
      folder);
  expect_exit(1, outcome, "failed: no parallax");
  EXPECT_THAT(
      outcome.err,
      HasSubstr("not written, because the initialization failed: --trajectory, --export ply\n"));
  EXPECT_THAT(outcome.err, HasSubstr("--scan - lists the frames from which a window can be"));
  EXPECT_FALSE(fs::exists(folder / "t.txt"));
  EXPECT_FALSE(fs::exists(folder / "map.ply"));
  const json j = read_json(folder / "r.json");
  EXPECT_EQ(j["status"], "failed");
  EXPECT_THAT(j["reason"], HasSubstr("no parallax"));
  EXPECT_TRUE(j["plane"].is_null());
  EXPECT_TRUE(j["frames"][0]["p_wc"].is_null());
  EXPECT_TRUE(j["points"].empty());
  EXPECT_FALSE(j.contains("metrics"));
}

TEST(Run, ResultsFitTheirSchemaAndHaveAVerdict) {
  SKIP_WITHOUT_PYTHONS("jsonschema");
  const fs::path folder = fresh_folder();
  const std::vector<std::pair<std::string, std::string>> runs = {
      {"", "ready"},
      {"--scale-points 137,231,432,334 --scale-length 0.3 --world-points 137,231,432,334", "ready"},
      {"--frames 4", "weak"},
      {"--method pnp --start 5 --frames 20 --gravity off", "weak"},
      {"--method orb --result orb=" GPO_SOURCE_DIR
       "/tests/app/results/CameraTrajectory.txt,scale=metric,offset=auto",
       "ready"},
      {"--frames 20 --plane 7", "weak"},
      {"--frames 2 --method pnp", "degenerate"}};
  for (const auto& [options, readiness] : runs) {
    SCOPED_TRACE(options);
    program("run {} {} --json {}/r.json", kDesk, options, folder);
    const json j = read_json(folder / "r.json");
    EXPECT_EQ(j["verdict"]["readiness"], readiness);
    EXPECT_NE(j["verdict"]["reason"], "");
    const Outcome checked = shell(DEBIANS_PYTHON "-W ignore -m jsonschema -i {} " GPO_SOURCE_DIR
                                                 "/engine/inspection/report/run_result.schema.json",
                                  folder / "r.json");
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
  }
}

TEST(Run, NamesTransferAndReprojectionErrorsForEveryMethod) {
  const json over_plane = run_json("{} --method gpo --frames 20", kDesk);
  const json bundle = run_json("{} --method ba --frames 20", kDesk);
  for (const json& j : {over_plane, bundle})
    EXPECT_LT(j["reprojection_rms_px"], j["transfer_rms_px"]);
  EXPECT_EQ(over_plane["cube_corners"].size(), 8U);
  EXPECT_EQ(over_plane["camera"]["image_size_px"], json::parse("[640, 480]"));
  EXPECT_EQ(over_plane["camera"]["lens_model"], "radial-tangential");
}

TEST(Run, ExcludesTracksById) {
  const json whole = run_json(kDesk), without = run_json("{} --exclude 23,17,23", kDesk);
  EXPECT_EQ(without["settings"]["exclude"], (std::vector<int>{17, 23}));
  EXPECT_FALSE(whole["settings"].contains("exclude"));
  EXPECT_EQ(without["window"]["tracks"], whole["window"]["tracks"]);
  for (const json& point : without["points"])
    EXPECT_TRUE(point["track"] != 17 && point["track"] != 23);
}

TEST(Run, WarnsAboutUnusedOptions) {
  const fs::path file = fresh_folder() / "result.json";
  EXPECT_EQ(succeeding("run sequences/desk --frames 12 --method ba --loss huber --seed 2 "
                       "--trajectory-format euroc --json {}",
                       file)
                .err,
            "--loss is not used. Applies only to gpo_joint\n"
            "--trajectory-format is not used. No trajectory is written\n");
  const json j = read_json(file);
  EXPECT_EQ(j["unused_settings"],
            json::parse(R"(["solver", "error", "loss", "shutter", "planes", "time_offset"])"));
  EXPECT_EQ(run_json("{} --method gpo_joint", kDesk)["unused_settings"], json::array());
}

TEST(Run, WarnsAboutSettingsThatOthersSwitchOff) {
  EXPECT_EQ(succeeding("run sequences/desk --frames 12 --method gpo --gravity off "
                       "--accelerometer-bias-sigma 0.1 --scale-length-sigma 0.1 --world-up gravity "
                       "--extrapolate 2 --extrapolated-trajectory")
                .err,
            "--accelerometer-bias-sigma is not used. Gravity is not estimated\n"
            "--scale-length-sigma is not used. There are no scale points\n"
            "--world-up is not used. There are no world points\n"
            "--extrapolated-trajectory is not used. No trajectory is written\n");
}

TEST(Run, RefusesAnEmptyFileName) {
  expect_refused(program("run {} --json ''", kDesk), "--json: '', expected the name of a file");
}

TEST(Run, ShowsAChosenWorldInTheUnitOfItsExports) {
  const std::string world = "--frames 12 --world-points 137,231,432,334";
  EXPECT_THAT(succeeding("run {} {} --gravity off", kDesk, world).out,
              HasSubstr("(plane distances)"));
  const Outcome metric =
      succeeding("run {} {} --scale-points 137,231,432,334 --scale-length 0.3", kDesk, world);
  EXPECT_THAT(metric.out, HasSubstr("(meters)"));
}

TEST(Run, WithoutOptionsTakesAShortRecordingWhole) {
  const fs::path folder = fresh_folder(), camera = folder / "mav0/cam0";
  fs::create_directories(camera);
  fs::create_symlink(desk() / "mav0/cam0/data", camera / "data");
  fs::copy_file(desk() / "mav0/cam0/sensor.yaml", camera / "sensor.yaml");
  const std::string list = read_file(desk() / "mav0/cam0/data.csv");
  std::size_t end = 0;
  for (int line = 0; line < 1 + 20; ++line) end = list.find('\n', end) + 1;
  write_file(camera / "data.csv", list.substr(0, end));
  EXPECT_THAT(succeeding("run {}", folder).out, HasSubstr("frames 0 to 19 (20)"));
  expect_exit(2, program("run {} --start 1", folder), "30 frames from frame 1 on do not fit");
  expect_exit(2, program("run {} --frames 21", folder), "21 frames from frame 0 on do not fit");
}

TEST(Run, RefusesBadInputInOneLineAndLeavesNoFile) {
  expect_each_refused(
      "run " + kDesk + " --json {}/r.json ",
      {{"--method gpoo", "--method: unknown value 'gpoo', expected one of gpo"},
       {"--start 60", "--start: frame 60 is not in the recording, which has frames 0 to 59"},
       {"--start 40", "30 frames from frame 40 on do not fit; the recording has 60 frames"},
       {"--frames 1", "--frames"},
       {"--start -1", "--start"},
       {"--start abc", "--start"},
       {"--rotations gyr", "--rotations: unknown value 'gyr'"},
       {"--tracking anchor", "--tracking: unknown value 'anchor', expected one of"},
       {"--inliers some", "--inliers: unknown value 'some', expected one of per-frame"},
       {"--solver gauss", "--solver: unknown value 'gauss', expected one of schur, ceres"},
       {"--error two", "--error: unknown value 'two', expected one of automatic, transfer"},
       {"--loss cauchy", "--loss: unknown value 'cauchy', expected one of squared"},
       {"--shutter fast", "--shutter: unknown value 'fast', expected one of known"},
       {"--exclude 3,9999", "--exclude: track 9999 is not in the window, which has tracks 0 to"},
       {"--exclude 3,x", "--exclude"},
       {"--mask not:1,2", "expected KIND:X1,Y1,X2,Y2 (a rectangle)"},
       {"--extrapolated-trajectory", "--extrapolate"},
       {"--bogus", "--bogus"},
       {"--tracks no-such-file.csv", "no-such-file.csv"}});
}

TEST(Run, WrittenTracksGiveTheSameResult) {
  const fs::path file = fresh_folder() / "missing/folder/tracks.csv";
  const json written = run_json("{} --frames 12 --tracks-out {}", kDesk, file);
  EXPECT_THAT(read_file(file), StartsWith("#frame,track,x,y,plane,verdict,residual_px,"));
  const json read = run_json("{} --frames 12 --tracks {} --error transfer", kDesk, file);
  EXPECT_EQ(read["window"]["tracks"], written["window"]["tracks"]);
  EXPECT_EQ(read["window"]["inliers"], written["window"]["inliers"]);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(read["plane"]["normal"][k], written["plane"]["normal"][k], 1e-6);
}

TEST(SharedRecordings, ChessboardFloorInitializesByAveraging) {
  SKIP_WITHOUT(shared("chessboard-floor"));
  const json j = run_json("{} --start 180", shared("chessboard-floor"));
  EXPECT_EQ(j["settings"]["rotations"], "averaging");
  EXPECT_EQ(j["metrics"]["alignment"], "ok");
  EXPECT_LT(j["metrics"]["pne_deg"], 2.0);
  EXPECT_LT(j["metrics"]["ate_m"], 0.01);
}

TEST(SharedRecordings, CardsTracksInitializeByGyroscope) {
  SKIP_WITHOUT(shared("cards-tracks"));
  for (const int start : {1, 139, 259}) {
    const json j = run_json(
        "{0} --tracks {0}/tracks.csv --frames 16 --start {1}", shared("cards-tracks"), start);
    EXPECT_EQ(j["status"], "ok") << start;
    const double squares = 2 * j["solver"]["final_cost"].get<double>();
    EXPECT_LT(std::sqrt(2 * squares / j["solver"]["residuals"].get<double>()), 1.5) << start;
    EXPECT_FALSE(j.contains("metrics"));
  }
}

}  // namespace
}  // namespace gpo::test
