// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "tests/app/program.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

void expect_same_result(const fs::path& recording, const std::string& arguments) {
  const fs::path converted = fresh_folder() / "euroc";
  succeeding("convert {} --output {}", recording, converted);
  json before = run_json("{} {}", recording, arguments);
  json after = run_json("{} {}", converted, arguments);
  for (const char* key : {"recording", "timing_ms", "truth"}) {
    before.erase(key);
    after.erase(key);
  }
  expect_same_json(before, after, 1e-6, "");
}

TEST(Convert, KeepsTheResultOfTheDesk) { expect_same_result(desk(), "--frames 20"); }

TEST(Convert, KeepsTheResultOfRealTracks) {
  SKIP_WITHOUT(shared("cards-tracks"));
  expect_same_result(shared("cards-tracks"), "--start 58 --frames 15 --method ba");
}

TEST(Convert, KeepsTheReadoutTime) {
  const fs::path folder = fresh_folder();
  const fs::path camera = "mav0/cam0/sensor.yaml";
  fs::copy(desk(), folder / "given", fs::copy_options::recursive);
  write_file(folder / "given" / camera,
             read_file(folder / "given" / camera) +
                 "readout_direction: left\nreadout_s: 0.012\nreadout_sigma_s: 0.001\n");
  succeeding("convert {} --output {}", folder / "given", folder / "made");
  EXPECT_THAT(read_file(folder / "made" / camera),
              AllOf(HasSubstr("readout_direction: left"),
                    HasSubstr("readout_s: 0.012"),
                    HasSubstr("readout_sigma_s: 0.001")));
  EXPECT_THAT(succeeding("info {}", folder / "made").out, HasSubstr("12.00 ms, last column first"));
  EXPECT_THAT(succeeding("info {}", desk()).out, testing::ContainsRegex("readout +unknown"));
}

TEST(Convert, WritesTheFormatThatTheExtensionNames) {
  const fs::path folder = fresh_folder();
  for (const char* name : {"a.mcap", "B.MCAP"}) {
    succeeding("convert {} --output {}", kDesk, folder / name);
    EXPECT_TRUE(fs::is_regular_file(folder / name));
    EXPECT_THAT(succeeding("info {}", folder / name).out, HasSubstr("ROS bag"));
  }
}

TEST(Convert, RefusesToChangeTheCameraOfABagInTheSameFolder) {
  const fs::path folder = fresh_folder();
  succeeding("convert {} --output {}", kDesk, folder / "given" / "a.mcap");
  fs::create_directory(folder / "bags");
  fs::copy(folder / "given" / "a.mcap", folder / "bags" / "a.mcap");
  expect_refused(program("convert {} --output {}", kDesk, folder / "bags" / "b.bag"),
                 "choose a folder without other recordings");
}

TEST(Convert, RefusesAnExistingFolderAndAForeignExtension) {
  expect_each_refused("convert " + kDesk,
                      {{" --output {}/..", "is not empty; choose a new or empty folder"},
                       {" --format euroc --output {}/a.bag", "--format euroc writes a folder, but"},
                       {" --format mcap --output {}/a.bag", "wrong extension, expected .mcap"},
                       {" --output {}/a.db3", "found the ending .db3, expected a folder, or a"},
                       {" --output {}/a.MP4", "found the ending .mp4, expected a folder, or a"},
                       {" --output {}/a.bag/", "found the ending .bag, expected a folder, or a"}});
}

std::vector<std::vector<double>> rows_of(const fs::path& file) {
  std::vector<std::vector<double>> rows;
  for (std::string line : split(read_file(file), '\n')) {
    if (line.starts_with('#')) continue;
    std::ranges::replace(line, ',', ' ');
    std::istringstream cells(line);
    rows.emplace_back(std::istream_iterator<double>(cells), std::istream_iterator<double>());
  }
  return rows;
}

/// ATE as evo computes it from two trajectories: RMS after a similarity by Umeyama's method.
double ate_m(const std::vector<std::vector<double>>& truth,
             const std::vector<std::vector<double>>& estimate) {
  const auto n = static_cast<Eigen::Index>(truth.size());
  Eigen::Matrix3Xd a(3, n), b(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    a.col(i) << estimate[i][1], estimate[i][2], estimate[i][3];
    b.col(i) << truth[i][1], truth[i][2], truth[i][3];
  }
  const Eigen::Matrix4d T = Eigen::umeyama(a, b, true);
  const Eigen::Matrix3Xd error =
      (T.topLeftCorner<3, 3>() * a).colwise() + T.topRightCorner<3, 1>() - b;
  return std::sqrt(error.colwise().squaredNorm().mean());
}

TEST(Trajectories, AreReadableByEvo) {
  const fs::path folder = fresh_folder();
  const auto write = [&](const std::string& format) {
    const fs::path file = folder / format;
    const std::string run = "run sequences/desk --trajectory-format " + format;
    succeeding("{0} --trajectory {1} --true-trajectory {1}-truth --json {1}.json", run, file);
    return std::pair(rows_of(file), rows_of(folder / (format + "-truth")));
  };
  const auto [tum, tum_truth] = write("tum");
  const auto [euroc, euroc_truth] = write("euroc");
  const auto [kitti, kitti_truth] = write("kitti");
  for (const auto& rows : {tum, euroc, kitti, kitti_truth}) ASSERT_EQ(rows.size(), 30U);
  for (int i = 0; i < 30; ++i) {
    ASSERT_EQ(tum[i].size(), 8U);
    ASSERT_EQ(euroc[i].size(), 8U);
    ASSERT_EQ(kitti[i].size(), 12U);
    EXPECT_NEAR(euroc[i][0] * 1e-9, tum[i][0], 1e-6);
    const Eigen::Quaterniond q(tum[i][7], tum[i][4], tum[i][5], tum[i][6]);
    EXPECT_NEAR(q.norm(), 1, 1e-8);
    const Eigen::Matrix3d R = q.normalized().matrix();
    for (int row = 0; row < 3; ++row) {
      EXPECT_NEAR(kitti[i][4 * row + 3], tum[i][1 + row], 1e-8);
      EXPECT_NEAR(euroc[i][1 + row], tum[i][1 + row], 1e-12);
      for (int column = 0; column < 3; ++column)
        EXPECT_NEAR(kitti[i][4 * row + column], R(row, column), 1e-7);
    }
    EXPECT_EQ(euroc[i][4], tum[i][7]);  // w first, w last
    EXPECT_EQ(euroc[i][5], tum[i][4]);
  }
  const json metrics = read_json(folder / "tum.json")["metrics"];
  EXPECT_NEAR(ate_m(tum_truth, tum), metrics["ate_m"], 1e-6);
}

TEST(Trajectories, RefuseTrueTrajectoryWithoutTruth) {
  const fs::path folder = fresh_folder();
  copy_of_desk(folder / "desk", {"mav0/state_groundtruth_estimate0", "board.yaml"});
  const Outcome outcome = program("run {0}/desk --true-trajectory {0}/truth.txt", folder);
  expect_exit(2, outcome, "desk: no ground truth");
  EXPECT_FALSE(fs::exists(folder / "truth.txt"));
}

TEST(Trajectories, TruthWithoutAPlaneGivesTheAte) {
  const fs::path copy = copy_of_desk(fresh_folder() / "desk", {"plane.yaml", "board.yaml"});
  const json whole = run_json(kDesk)["metrics"], without = run_json(copy.string())["metrics"];
  EXPECT_EQ(without["ate_m"], whole["ate_m"]);
  EXPECT_TRUE(without["pne_deg"].is_null());
}

TEST(Info, JsonIsPrintedOrWrittenToAFile) {
  const std::string file = (fresh_folder() / "deep/info.json").string();
  const std::string printed = program("info --json {}", kDesk).out;
  EXPECT_TRUE(json::accept(printed));
  for (const auto& [arguments, to_file] : {std::pair{kDesk + " --json", false},
                                           {kDesk + " --json -", false},
                                           {"--json - " + kDesk, false},
                                           {kDesk + " --json " + file, true},
                                           {"--json " + file + " " + kDesk, true},
                                           {"--json=" + file + " " + kDesk, true}}) {
    const Outcome outcome = succeeding("info {}", arguments);
    EXPECT_EQ(outcome.out, to_file ? "" : printed) << arguments;
    EXPECT_EQ(to_file ? read_file(file) : outcome.out, printed) << arguments;
    fs::remove_all(fs::path(file).parent_path());
  }
}

TEST(Info, DoesNotOverwriteARecording) {
  const fs::path recipe = fresh_folder() / "mine.yaml";
  write_file(recipe, "seed: 1\n");
  expect_exit(2,
              program("info --json {} {}", recipe, kDesk),
              "mine.yaml already exists and is not a .json file");
  EXPECT_EQ(read_file(recipe), "seed: 1\n");
  EXPECT_THAT(program("info --json").err, HasSubstr("recording"));
}

struct Mistaken {
  std::string name, content, message;
};

const std::vector<Mistaken> kMistaken = {
    {"board.yaml",
     "{pattern: chessboard, columns: 9, rows: 6, square: 0.025}",
     "the description of a printed board, expected a recording"},
    {"plane.yaml", "normal: [0, 0, 1]\ndistance: 0\n", "the true plane of a recording, expected"},
    {"camera.yaml",
     "resolution: [8, 6]\nintrinsics: [6, 6, 4, 3]\n",
     "the calibration of a camera, expected"},
    {"calibration.json",
     R"({"camera_matrix": {"rows": 3}})",
     "the calibration of a camera, expected"},
    {"groundtruth.yaml", "T_truth_camera: []\n", "the mounting of a ground truth, expected"},
    {"s.json",
     R"({"kind": "gpo-inspector session", "version": 1})",
     "a session, expected a recording; `view --session` opens it"},
    {"results.csv", "recording,configuration,", "results of `evaluate`, expected a recording"},
    {"a.png", "x", "a single image, expected a recording"}};

TEST(KnownFile, IsRecognizedAndRefused) {
  for (const auto& [name, content, message] : kMistaken) {
    const fs::path file = fresh_folder() / name;
    write_file(file, content);
    for (const std::string command : {"info ", "run ", "evaluate --output /dev/null/x "}) {
      SCOPED_TRACE(command + name);
      expect_refused(program(command + file.string()), name + ": found " + message);
    }
  }
}

TEST(Help, UsageErrorsPointToIt) {
  const Outcome unknown = program("inspect sequences/desk");
  expect_refused(unknown, "unknown command 'inspect', expected one of view, info");
  EXPECT_THAT(unknown.err, HasSubstr("; see gpo-inspector --help\n"));
  EXPECT_THAT(program("run --bogus x").err, HasSubstr("; see gpo-inspector run --help\n"));
  EXPECT_THAT(program("--bogus").err, HasSubstr("; see gpo-inspector --help\n"));
}

TEST(Help, HelpAndVersionArePrinted) {
  EXPECT_THAT(succeeding("--help").out, HasSubstr("synthesize"));
  EXPECT_THAT(succeeding("--version").out, testing::MatchesRegex("gpo-inspector [0-9.]+\n"));
}

std::vector<fs::path> recordings_of(const std::string& name) {
  fs::create_directories(GPO_RECORDINGS_DIR);
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(GPO_RECORDINGS_DIR)) {
    if (entry.path().filename().string().starts_with(name + "-")) folders.push_back(entry.path());
  }
  return folders;
}

/// A recipe whose recording is not cached yet.
fs::path fresh_recipe(const std::string& name, const std::string& text) {
  for (const fs::path& folder : recordings_of(name)) fs::remove_all(folder);
  const fs::path recipe = fresh_folder() / (name + ".yaml");
  write_file(recipe, text);
  return recipe;
}

TEST(RecipeAsRecording, InfoNamesThePathOfTheRecipe) {
  const fs::path recipe = fresh_recipe("infotest", small_recipe_text());
  const Outcome first = succeeding("info --json {}", recipe);
  EXPECT_EQ(first.err, "");  // no progress bar without a terminal
  const json info = json::parse(first.out);
  EXPECT_EQ(info["recording"], recipe.string());
  EXPECT_EQ(info["frames"], 4);
  EXPECT_EQ(program("info --json {}", recipe).out, first.out);
}

TEST(RecipeAsRecording, RunNamesTheRecordingAfterTheRecipe) {
  // Large enough for tracking.
  const fs::path recipe =
      fresh_recipe("runtest",
                   replaced(small_recipe_text(),
                            {{"resolution: [160, 120]", "resolution: [320, 240]"},
                             {"[125, 124, 80.4, 59.2]", "[250, 248, 160.4, 119.2]"}}));
  const Outcome outcome = program("run {} --frames 4 --json -", recipe);
  EXPECT_THAT(outcome.err, HasSubstr("recording   runtest\n"));
  EXPECT_EQ(json::parse(outcome.out)["recording"], recipe.string());
}

/// The message goes on; how, depends on the speed of the machine.
const std::string kStopped = "gpo-inspector: stopped; ";

TEST(Synthesize, InterruptionLeavesNothing) {
  const fs::path recipe = fresh_recipe("interrupted", small_recipe_with("count: 4", "count: 1000"));
  const std::string output = (recipe.parent_path() / "out").string();
  const Outcome outcome = signaled("INT",
                                   "ls " + output + ".*.unfinished/mav0/imu0/data.csv",
                                   fmt::format("synthesize {} --output {}", recipe, output));
  expect_exit(1, outcome, kStopped);
  EXPECT_FALSE(fs::exists(output));
  for (const fs::path& left : fs::directory_iterator(recipe.parent_path()))
    EXPECT_THAT(left.string(), testing::Not(HasSubstr("unfinished")));
}

TEST(Synthesize, InterruptionOfRunLeavesNothing) {
  const fs::path recipe =
      fresh_recipe("interruptedrun", small_recipe_with("count: 4", "count: 1000"));
  const Outcome outcome =
      signaled("INT",
               "[ -e " GPO_RECORDINGS_DIR "/interruptedrun-*/*/mav0/imu0/data.csv ]",
               "run " + recipe.string());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr(kStopped));
  for (const fs::path& folder : recordings_of("interruptedrun"))
    EXPECT_FALSE(fs::exists(folder / "interruptedrun")) << folder;
}

TEST(RecipeAsRecording, ConcurrentProcessesShareIt) {
  const fs::path recipe = fresh_recipe("sharetest", small_recipe_text());
  const std::string info = "'" GPO_PROGRAM "' info --json " + recipe.string();
  const std::string others =
      info + " > /dev/null & first=$! ; " + info + " > /dev/null & second=$! ; ";
  const Outcome outcome = shell("{}{} && wait $first && wait $second", others, info);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["frames"], 4);
  EXPECT_EQ(recordings_of("sharetest").size(), 1U);
}

TEST(RecipeAsRecording, BrokenRecipeIsRefusedWithOneLine) {
  const fs::path recipe = fresh_recipe("brokentest", small_recipe_with("rate: 200", "rate: fast"));
  for (const std::string command : {"info ", "run ", "view "})
    expect_refused(program(command + recipe.string()),
                   "brokentest.yaml:27: key `gyroscope.rate`: found \"fast\"");
  EXPECT_TRUE(recordings_of("brokentest").empty());
  EXPECT_EQ(program("info {}", recipe.parent_path() / "none.yaml").exit_code, 2);
}

TEST(Findings, AreListedAsTextAndJson) {
  EXPECT_THAT(succeeding("findings").out, HasSubstr("Implausible focal length or principal point"));
  const json listed = json::parse(succeeding("findings --json").out)["findings"];
  const auto row = std::ranges::find_if(
      listed, [](const json& one) { return one["key"] == "implausible-intrinsics"; });
  ASSERT_NE(row, listed.end());
  EXPECT_EQ((*row)["looks_at"], "recording");
  EXPECT_EQ((*row)["may_be_ignored"], true);
}

}  // namespace
}  // namespace gpo::test
