// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Debian's Python, even if another one comes first on this machine.
const std::string kDebiansPython = "PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3";

#define SKIP_WITHOUT_PYTHONS(modules)                                    \
  if (shell(kDebiansPython + " -c 'import " modules "'").exit_code != 0) \
  GTEST_SKIP() << "Debian's Python has not all of " modules " on this machine"

std::string mine(const std::string& command, const std::string& more = "") {
  return fmt::format(
      "{} --frames 10 --method mine --method-command mine=\"{}\" {}", kDesk, command, more);
}

/// The result of `run --json` in the format of a user's own program.
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
  return fmt::format("read w; cat '{}'", (folder / "answer").string());
}

TEST(MethodCommand, ReturnsTheResultOfOurMethodUnchanged) {
  const json ours = run_json(kDesk + " --frames 10 --method gpo");
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
      1, program("run " + mine("read w; echo '{}'; cat")), "mine: answer 1: cameras: is missing");
  const Outcome ended = program("run " + mine("echo no module >&2; exit 1"));
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.err, "mine: no module\n") << "its standard error is shown";
  EXPECT_THAT(ended.out, HasSubstr("mine: ended with exit code 1 before answer 1: no module"));
  const Outcome late = program("run " + mine("sleep 1000", "--method-timeout 0.3"));
  EXPECT_THAT(late.out, HasSubstr("mine: no answer 1 within 0.3 s"));
  const Outcome much = spawned("run " + mine("head -c 2000000000 /dev/zero"));
  expect_exit(1, much, "mine: answer 1 is longer than 8 MiB");
  EXPECT_LT(much.peak_kib, 1 << 19);
}

TEST(MethodCommand, RefusesInvalidArguments) {
  const fs::path folder = fresh_folder();
  const std::string run = "run " + kDesk + " --json " + (folder / "a.json").string();
  for (const BadInput& bad :
       {BadInput{" --method-command mine", "--method-command: 'mine', expected NAME="},
        {" --method-command gpo=cat", "there already is a method 'gpo'"},
        {" --method-command m=cat --method-command m=cat", "there already is a method 'm'"},
        {" --method-command m=cat --method-timeout 0", "--method-timeout"},
        {" --method m", "--method: unknown value 'm', expected one of gpo"}})
    expect_refused(program(run + bad.arguments), bad, folder);
}

TEST(MethodCommand, ExperimentContinuesAfterEachFailure) {
  const fs::path folder = fresh_folder();
  write_file(folder / "mine.sh",
             "read w; echo '{\"failed\": \"said so\"}'; read w; printf '{\"cam'; kill -9 $$\n");
  const auto evaluate = [&] {
    return program(fmt::format(
        "evaluate {} --methods gpo,mine --lengths 10 --starts 0:30:10 --jobs 1 --output {} "
        "--method-command mine='sh {}'",
        kDesk,
        (folder / "out").string(),
        (folder / "mine.sh").string()));
  };
  const Outcome outcome = evaluate();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string csv = read_file(folder / "out/results.csv");
  EXPECT_THAT(csv,
              AllOf(HasSubstr("mine: said so"),
                    HasSubstr("mine: was killed by signal 9 (Killed) in the middle of answer 2")));
  const json summary = json::parse(read_file(folder / "out/experiment.json"));
  EXPECT_THAT(summary["commands"]["mine"].get<std::string>(), HasSubstr("mine.sh"));
  write_file(folder / "mine.sh", "while read w; do echo '{\"failed\": \"mended\"}'; done\n");
  EXPECT_THAT(evaluate().err, HasSubstr("command or files of a method"));
  EXPECT_THAT(read_file(folder / "out/results.csv"),
              AllOf(HasSubstr("mine: mended"), Not(HasSubstr("said so"))));
}

TEST(MethodCommand, IsShownInComparisonAndCurves) {
  const fs::path folder = fresh_folder();
  const std::string command = answering_with(run_json(kDesk + " --frames 10 --method gpo"), folder);
  for (const std::string view : {"compare", "curves --lengths 10"}) {
    const Outcome outcome = succeeding(fmt::format(
        "snapshot {} --frames 10 --view {} --methods gpo,mine --output {} --method-command "
        "mine=\"{}\"",
        kDesk,
        view,
        (folder / "picture.png").string(),
        command));
    EXPECT_EQ(outcome.err, "");
    EXPECT_GT(fs::file_size(folder / "picture.png"), 10'000U);
  }
}

/// A session saved with an own method, whose command leaves a file where it is started.
class SessionWithCommand : public testing::Test {
 protected:
  SessionWithCommand() {
    write_file(folder_ / "save.txt", "save-session " + session_.string() + "\n");
    write_file(folder_ / "open.txt", "open " + session_.string() + "\n");
    succeeding(fmt::format(
        "snapshot {} --frames 10 --method mine --script {} --method-command mine=\"touch '{}'; "
        "cat\"",
        kDesk,
        (folder_ / "save.txt").string(),
        started_.string()));
    EXPECT_TRUE(fs::remove(started_));
    saved_ = json::parse(read_file(session_));
  }
  Outcome open(const std::string& options = "") const {
    return program("snapshot " + options + " --script " + (folder_ / "open.txt").string());
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
           {json::object({{"mine", "touch it"}}), "method_commands: expected a list of texts"},
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
  for (int k = 1; k <= 2; ++k) {
    succeeding(fmt::format(
        "evaluate {} --methods gpo,mine --lengths 10 --starts 0:20:10 --shard {}/2 --output {} "
        "--method-command mine='read w; echo no >&2'",
        kDesk,
        k,
        (folder / "shards").string()));
  }
  succeeding(fmt::format(
      "evaluate --merge {} --output {}", (folder / "shards").string(), (folder / "out").string()));
  EXPECT_THAT(read_file(folder / "out/results.csv"), HasSubstr("mine: ended"));
}

std::string opencv_command() {
  return "--method-command opencv='" + kDebiansPython +
         " " GPO_SOURCE_DIR "/engine/examples/peers/opencv_initializer.py'";
}

TEST(OpencvInitializer, SolvesTheDesk) {
  SKIP_WITHOUT_PYTHONS("cv2, numpy");
  const json result = run_json(kDesk + " --method opencv " + opencv_command());
  EXPECT_EQ(result["frames"].size(), 30U);
  EXPECT_LT(result["metrics"]["pne_deg"], 3);
  EXPECT_GT(result["timing_ms"]["optimize"], 0);
  EXPECT_LT(result["timing_ms"]["optimize"], result["timing_ms"]["initialize"]);
}

TEST(OpencvInitializer, SolvesTheRoom) {
  SKIP_WITHOUT_PYTHONS("cv2, numpy");
  SKIP_WITHOUT(shared("euroc-room"));
  const fs::path folder = fresh_folder();
  succeeding(fmt::format(
      "evaluate {} --methods gpo_joint,opencv --lengths 20 --starts 0:40:10 --output {} {}",
      shared("euroc-room").string(),
      folder.string(),
      opencv_command()));
  EXPECT_THAT(read_file(folder / "results.csv"), HasSubstr(",opencv,"));
}

TEST(MethodCommand, WindowsAndAnswersFitTheirSchemas) {
  SKIP_WITHOUT_PYTHONS("cv2, jsonschema, numpy");
  for (const fs::path& recording : {desk(), shared("euroc-room")}) {
    if (!fs::exists(recording)) continue;
    const Outcome outcome =
        program(fmt::format("run {} --frames 20 --method checked --method-command checked='{} "
                            "{}/tests/app/checked_initializer.py'",
                            recording.string(),
                            kDebiansPython,
                            GPO_SOURCE_DIR));
    EXPECT_EQ(outcome.err, "") << recording;
    EXPECT_THAT(outcome.out, Not(HasSubstr("checked:"))) << recording;
  }
}

}  // namespace
}  // namespace gpo::test
