// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "tests/app/program.h"

#include <sstream>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not;

std::string mine(const std::string& command, const std::string& more = "") {
  return fmt::format(
      "{} --frames 10 --method mine --method-command mine=\"{}\" {}", kDesk, command, more);
}

std::string answer_of(const json& result) {
  json cameras = json::array();
  for (const json& frame : result["frames"]) {
    const std::vector<double> q = frame["q_wc_xyzw"];
    const Eigen::Matrix3d R = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
    json rows = json::array();
    for (int i = 0; i < 3; ++i) rows.push_back({R(i, 0), R(i, 1), R(i, 2)});
    cameras.push_back({{"R_wc", rows}, {"center", frame["p_wc"]}});
  }
  json plane;
  for (const char* key : {"normal", "distance"}) plane[key] = result["plane"][key];
  return json{{"cameras", cameras}, {"plane", plane}}.dump();
}

/// A command that answers with the result of our own method.
std::string answering_with(const json& result, const fs::path& folder) {
  write_file(folder / "answer", answer_of(result) + "\n");
  return fmt::format("read w; cat '{}'", folder / "answer");
}

TEST(MethodCommand, ReturnsTheResultOfOurMethodUnchanged) {
  const json ours = run_json("{} --frames 10 --method gpo", kDesk);
  const json theirs = run_json(mine(answering_with(ours, fresh_folder())));
  EXPECT_EQ(theirs["method"], "mine");
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(theirs["plane"]["normal"][k], ours["plane"]["normal"][k], 1e-12);
    EXPECT_NEAR(theirs["frames"][9]["p_wc"][k], ours["frames"][9]["p_wc"][k], 1e-12);
  }
  EXPECT_NEAR(theirs["metrics"]["ate_m"], ours["metrics"]["ate_m"], 1e-9);
  EXPECT_NEAR(theirs["metrics"]["pne_deg"], ours["metrics"]["pne_deg"], 1e-6);
  EXPECT_GT(theirs["uncertainty"]["normal_sigma_deg"], 0);
  EXPECT_EQ(theirs["verdict"]["readiness"], ours["verdict"]["readiness"]);
}

TEST(MethodCommand, ReportsTheFailureOfTheCommand) {
  expect_exit(
      1, program("run {}", mine("read w; echo '{}'; cat")), "mine: answer 1: cameras: is missing");
  const Outcome ended = program("run {}", mine("echo no module >&2; exit 1"));
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.err, "mine: no module\n") << "its standard error is shown";
  EXPECT_THAT(ended.out, HasSubstr("mine: ended with exit code 1 before answer 1: no module"));
  EXPECT_THAT(program("run {}", mine("sleep 1000", "--method-timeout 0.3")).out,
              HasSubstr("mine: no answer 1 within 0.3 s"));
  const Outcome much = spawned("run " + mine("head -c 2000000000 /dev/zero"));
  expect_exit(1, much, "mine: answer 1 is longer than 8 MiB");
  EXPECT_LT(much.peak_kib, 1 << 19);
}

TEST(MethodCommand, RefusesInvalidArguments) {
  expect_each_refused(
      "run " + kDesk + " --json {}/a.json",
      {{" --method-command mine", "--method-command: 'mine', expected NAME="},
       {" --method-command gpo=cat", "there already is a method 'gpo'"},
       {" --method-command m=cat --method-command m=cat", "there already is a method 'm'"},
       {" --method-command m=cat --method-timeout 0", "--method-timeout"},
       {" --method m", "--method: unknown value 'm', expected one of gpo"}});
}

TEST(MethodCommand, ExperimentContinuesAfterEachFailure) {
  const fs::path folder = fresh_folder();
  write_file(folder / "mine.sh",
             "read w; echo '{\"failed\": \"said so\"}'; read w; printf '{\"cam'; kill -9 $$\n");
  const auto evaluate = [&] {
    return program(
        "evaluate sequences/desk --methods gpo,mine --lengths 10 --starts 0:30:10 --jobs 1 "
        "--output {0}/out --method-command mine='sh {0}/mine.sh'",
        folder);
  };
  const Outcome outcome = evaluate();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string csv = read_file(folder / "out/results.csv");
  EXPECT_THAT(csv,
              AllOf(HasSubstr("mine: said so"),
                    HasSubstr("mine: was killed by signal 9 (Killed) in the middle of answer 2")));
  const json summary = read_json(folder / "out/experiment.json");
  EXPECT_THAT(summary["commands"]["mine"].get<std::string>(), HasSubstr("mine.sh"));
  write_file(folder / "mine.sh", "while read w; do echo '{\"failed\": \"mended\"}'; done\n");
  EXPECT_THAT(evaluate().err, HasSubstr("command or files of a method"));
  EXPECT_THAT(read_file(folder / "out/results.csv"),
              AllOf(HasSubstr("mine: mended"), Not(HasSubstr("said so"))));
}

TEST(MethodCommand, IsShownInComparisonAndCurves) {
  const fs::path folder = fresh_folder();
  const std::string mine = answering_with(run_json("{} --frames 10 --method gpo", kDesk), folder);
  for (const std::string view : {"compare", "curves --lengths 10"}) {
    const fs::path image = folder / "image.png";
    const Outcome outcome = succeeding(
        "snapshot sequences/desk --frames 10 --methods gpo,mine --view {} --output {} "
        "--method-command mine=\"{}\"",
        view,
        image,
        mine);
    EXPECT_EQ(outcome.err, "");
    EXPECT_GT(fs::file_size(image), 10'000U);
  }
}

TEST(MethodCommand, HasTheWindowsUncertaintyAndTheTextSaysSo) {
  const fs::path folder = fresh_folder();
  const std::string mine = answering_with(run_json("{} --frames 10 --method gpo", kDesk), folder);
  const Outcome outcome =
      succeeding("run sequences/desk --frames 10 --method mine --method-command mine=\"{}\"", mine);
  EXPECT_THAT(outcome.out, HasSubstr("1 sigma of the window, not of the method"));
}

/// A session saved with an own method, whose command leaves a file where it is started.
class SessionWithCommand : public testing::Test {
 protected:
  SessionWithCommand() {
    write_file(folder_ / "save.txt", "save-session " + session_.string() + "\n");
    write_file(folder_ / "open.txt", "open " + session_.string() + "\n");
    succeeding(
        "snapshot {0} --frames 10 --method mine --script {1}/save.txt "
        "--method-command mine=\"touch '{1}/started'; cat\"",
        kDesk,
        folder_);
    EXPECT_TRUE(fs::remove(started_));
    saved_ = read_json(session_);
  }
  Outcome open(const std::string& options = "") const {
    return program("snapshot {} --script {}", options, folder_ / "open.txt");
  }

  fs::path folder_ = fresh_folder();
  fs::path session_ = folder_ / "session.json", started_ = folder_ / "started";
  json saved_;
};

TEST_F(SessionWithCommand, StartsItOnlyIfAllowed) {
  ASSERT_EQ(saved_["method_commands"].size(), 1U);
  EXPECT_THAT(saved_["method_commands"][0].get<std::string>(), testing::StartsWith("mine=touch "));
  const Outcome without = open();
  EXPECT_EQ(without.exit_code, 0) << without.err;
  EXPECT_THAT(without.err,
              AllOf(HasSubstr("mine: not started: only a session names its command (touch "),
                    HasSubstr("--allow-commands starts it")));
  EXPECT_FALSE(fs::exists(started_));
  EXPECT_EQ(open("--allow-commands").exit_code, 0);
  EXPECT_TRUE(fs::remove(started_));
  EXPECT_EQ(open("--method-command mine=cat").err, "") << "the command line takes precedence";
  EXPECT_FALSE(fs::exists(started_));
}

TEST_F(SessionWithCommand, RefusesInvalidCommands) {
  for (const auto& [commands, message] : std::vector<std::pair<json, std::string>>{
           {json::object({{"mine", "touch it"}}), "method_commands: expected a list of strings"},
           {json::array({"mine"}), "'mine', expected NAME='COMMAND'"},
           {json::array({"gpo=cat"}), "there already is a method 'gpo'"}}) {
    saved_["method_commands"] = commands;
    write_file(session_, saved_.dump());
    expect_exit(2, open("--allow-commands"), message);
  }
}

TEST_F(SessionWithCommand, RefusesCommandsTooLongForTheQuestion) {
  saved_["method_commands"][0] = "mine=true" + std::string(5000, ' ') + "; rm it";
  write_file(session_, saved_.dump());
  expect_exit(2, open(), "a question can show at most");
}

TEST(MethodCommand, ShardsAreMergedWithoutTheCommand) {
  const fs::path folder = fresh_folder();
  for (const char* shard : {"1/2", "2/2"})
    succeeding(
        "evaluate sequences/desk --methods gpo,mine --lengths 10 --starts 0:20:10 --shard {} "
        "--output {}/shards --method-command mine='read w; echo no >&2'",
        shard,
        folder);
  succeeding("evaluate --merge {0}/shards --output {0}/out", folder);
  EXPECT_THAT(read_file(folder / "out/results.csv"), HasSubstr("mine: ended"));
}

const std::string kOpencv = "--method-command opencv='" DEBIANS_PYTHON GPO_SOURCE_DIR
                            "/engine/examples/peers/opencv_initializer.py'";

TEST(OpencvInitializer, SolvesTheDesk) {
  SKIP_WITHOUT_PYTHONS("cv2, numpy");
  const json result = run_json("{} --method opencv {}", kDesk, kOpencv);
  EXPECT_EQ(result["frames"].size(), 30U);
  EXPECT_LT(result["metrics"]["pne_deg"], 3);
  EXPECT_GT(result["timing_ms"]["optimize"], 0);
  EXPECT_LT(result["timing_ms"]["optimize"], result["timing_ms"]["initialize"]);
}

TEST(OpencvInitializer, SolvesTheRoom) {
  SKIP_WITHOUT_PYTHONS("cv2, numpy");
  SKIP_WITHOUT(shared("euroc-room"));
  const fs::path folder = fresh_folder();
  succeeding("evaluate {} --methods gpo_joint,opencv --lengths 20 --starts 0:40:10 --output {} {}",
             shared("euroc-room"),
             folder,
             kOpencv);
  EXPECT_THAT(read_file(folder / "results.csv"), HasSubstr(",opencv,"));
}

TEST(MethodCommand, WindowsAndAnswersFitTheirSchemas) {
  SKIP_WITHOUT_PYTHONS("cv2, jsonschema, numpy");
  for (const fs::path& recording : {desk(), shared("euroc-room")}) {
    if (!fs::exists(recording)) continue;
    const Outcome outcome =
        program("run {} --frames 20 --method checked --method-command checked='" DEBIANS_PYTHON
                    GPO_SOURCE_DIR "/tests/app/checked_initializer.py'",
                recording);
    EXPECT_EQ(outcome.err, "") << recording;
    EXPECT_THAT(outcome.out, Not(HasSubstr("checked:"))) << recording;
  }
}

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
  EXPECT_EQ(
      program("run {} --method orb {}", kDesk, kOrb).err,
      "orb: TUM with nanoseconds, camera poses; 28 of the window's 30 frames (2 in gaps of up "
      "to 0.1 s between poses), the others resected; plane through points triangulated from "
      "its cameras\n");
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

/// Writes the true cameras of the desk as a TUM trajectory of a larger scale whose clock is early.
void write_scaled_trajectory(const fs::path& file, double scale, double early_s) {
  succeeding("run {} --frames 60 --true-trajectory {}", kDesk, file);
  std::istringstream rows(read_file(file));
  std::string text;
  for (std::string row; std::getline(rows, row);) {
    const auto v = split(row + " ", ' ');
    if (row.starts_with('#')) continue;
    text += fmt::format("{:.9f}", std::stod(v[0]) - early_s);
    for (int k = 1; k < 4; ++k) text += fmt::format(" {:.9f}", scale * std::stod(v[k]));
    for (int k = 4; k < 8; ++k) text += " " + v[k];
    text += "\n";
  }
  write_file(file, text);
}

TEST(ResultOfOthers, HasItsOwnScaleAndTimeOffsetInJsonAndExports) {
  const fs::path folder = fresh_folder();
  write_scaled_trajectory(folder / "slam.txt", 1.02, 0.02);
  const std::string metric = fmt::format(
      "{} --method slam --result slam={}/slam.txt,scale=metric,offset=auto", kDesk, folder);
  const json result =
      run_json("{0} --metric --trajectory {1}/a.txt --true-trajectory {1}/b.txt", metric, folder);
  EXPECT_NEAR(result["imported"]["time_offset_s"], 0.02, 1e-5);
  EXPECT_EQ(result["imported"]["applied_time_offset_s"], result["imported"]["time_offset_s"]);
  EXPECT_GT(result["imported"]["time_offset_sigma_s"], 0);
  EXPECT_EQ(result["metric_scale"]["source"], "result");
  EXPECT_EQ(result["metric_scale"]["sigma"], nullptr);
  EXPECT_EQ(result["metric_scale"]["meters_per_unit"], result["imported"]["meters_per_unit"]);
  EXPECT_NEAR(result["metrics"]["scale_error_percent"], 2, 1e-3);
  EXPECT_NE(result["inertial"]["scale"], result["metric_scale"]["meters_per_unit"]);
  const auto length_of = [](const fs::path& file) {
    std::istringstream rows(read_file(file));
    std::vector<Eigen::Vector3d> centers;
    for (std::string row; std::getline(rows, row);) {
      const auto v = split(row + " ", ' ');
      if (!row.starts_with('#'))
        centers.emplace_back(std::stod(v[1]), std::stod(v[2]), std::stod(v[3]));
    }
    return (centers.back() - centers.front()).norm();
  };
  EXPECT_NEAR(length_of(folder / "a.txt") / length_of(folder / "b.txt"), 1.02, 1e-5);
  write_file(folder / "script", fmt::format("metric on\nexport trajectory {}/c.txt\n", folder));
  succeeding("snapshot {} --script {}/script", metric, folder);
  EXPECT_NEAR(length_of(folder / "c.txt") / length_of(folder / "b.txt"), 1.02, 1e-5);
  const json free =
      run_json("{} --method slam --result slam={}/slam.txt,offset=0.02", kDesk, folder);
  EXPECT_EQ(free["metric_scale"]["source"], "accelerometer");
  EXPECT_EQ(free["imported"]["meters_per_unit"], nullptr);
  EXPECT_EQ(free["imported"]["applied_time_offset_s"], 0.02);
  EXPECT_LT(std::abs(free["metrics"]["scale_error_percent"].get<double>()), 1.5);
}

TEST(ResultOfOthers, ProposesBodyPosesWhereTheyFitFarBetter) {
  const fs::path folder = fresh_folder();
  std::istringstream rows(read_file(desk() / "mav0/state_groundtruth_estimate0/data.csv"));
  std::string text;
  for (std::string row; std::getline(rows, row);) {
    const auto v = split(row + ",", ',');
    if (row.starts_with('#') || v.size() < 8) continue;
    const std::int64_t ns = std::stoll(v[0]);
    text += fmt::format("{}.{:09d},{},{},{},{},{},{},{}\n",
                        ns / 1000000000,
                        ns % 1000000000,
                        v[1],
                        v[2],
                        v[3],
                        v[5],
                        v[6],
                        v[7],
                        v[4]);
  }
  write_file(folder / "body.csv", text);
  const Outcome as_camera = program("run {} --method x --result x={}/body.csv", kDesk, folder);
  expect_exit(1, as_camera, "x: add ,frame=body: as body poses its rotations are ");
  EXPECT_THAT(as_camera.out, Not(HasSubstr("verdict     ready")));
  const json result = run_json("{} --method x --result x={}/body.csv,frame=body", kDesk, folder);
  EXPECT_LT(result["metrics"]["ate_m"], 1e-5);
}

}  // namespace
}  // namespace gpo::test
