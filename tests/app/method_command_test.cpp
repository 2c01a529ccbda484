// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// A user's own method, as a command.
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

/// Debian's, whatever other Python comes first on this machine.
const std::string kDebiansPython = "PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3";

#define SKIP_WITHOUT_PYTHONS(modules)                                    \
  if (shell(kDebiansPython + " -c 'import " modules "'").exit_code != 0) \
  GTEST_SKIP() << "Debian's Python has not all of " modules " on this machine"

std::string run_mine(const std::string& command, const std::string& more = "") {
  return fmt::format("run {} --frames 10 --method mine --method-command mine=\"{}\" {}",
                     desk().string(),
                     command,
                     more);
}

json result_in(const std::string& arguments, const fs::path& file) {
  const Outcome outcome = spawned(arguments + " --json " + file.string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  return outcome.exit_code == 0 ? json::parse(read_file(file)) : json{};
}

/// What `run --json` says, as a user's own program would.
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

TEST(MethodCommand, WhatOursFoundComesBackAsItIs) {
  const fs::path folder = fresh_folder();
  const json ours =
      result_in("run " + desk().string() + " --frames 10 --method gpo", folder / "ours.json");
  write_file(folder / "answer", answer_of(ours) + "\n");
  const json theirs =
      result_in(run_mine(fmt::format("read w; cat '{}'", (folder / "answer").string())),
                folder / "theirs.json");
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

TEST(MethodCommand, AFailureIsTheWindowsAndSaysWhy) {
  const Outcome bad = spawned(run_mine("read w; echo '{}'; cat"));
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.out, HasSubstr("mine: answer 1: cameras: is missing"));
  const Outcome ended = spawned(run_mine("echo no module >&2; exit 1"));
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.err, "mine: no module\n") << "what it says is shown";
  EXPECT_THAT(ended.out, HasSubstr("mine: ended with exit code 1 before answer 1: no module"));
  const Outcome late = spawned(run_mine("sleep 1000", "--method-timeout 0.3"));
  EXPECT_THAT(late.out, HasSubstr("mine: no answer 1 within 0.3 s"));
  const Outcome much = spawned(run_mine("head -c 2000000000 /dev/zero"));
  EXPECT_EQ(much.exit_code, 1);
  EXPECT_THAT(much.out, HasSubstr("mine: answer 1 is longer than 8 MiB"));
  EXPECT_LT(much.peak_kib, 1 << 19);
}

TEST(MethodCommand, WhatCannotBeMeantIsRefused) {
  const fs::path folder = fresh_folder();
  const std::string run = "run " + desk().string() + " --json " + (folder / "a.json").string();
  for (const BadInput& bad : {
           BadInput{run + " --method-command mine", "--method-command: 'mine', expected NAME="},
           BadInput{run + " --method-command gpo=cat", "there already is a method 'gpo'"},
           BadInput{run + " --method-command m=cat --method-command m=cat",
                    "there already is a method 'm'"},
           BadInput{run + " --method-command m=cat --method-timeout 0", "--method-timeout"},
           BadInput{run + " --method m", "--method: unknown value 'm', expected one of gpo"},
       })
    expect_refused(spawned(bad.arguments), bad, folder);
}

// Every second window's process is killed in the middle of its answer; the others fail, too, but
// say so. What is ours is not disturbed.
TEST(MethodCommand, AnExperimentGoesOnAfterEachFailure) {
  const fs::path folder = fresh_folder();
  write_file(folder / "mine.sh",
             "read w; echo '{\"failed\": \"said so\"}'; read w; printf '{\"cam'; kill -9 $$\n");
  const auto evaluate = [&] {
    return spawned(fmt::format(
        "evaluate {} --methods gpo,mine --lengths 10 --starts 0:30:10 --jobs 1 --output {} "
        "--method-command mine='sh {}'",
        desk().string(),
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

TEST(MethodCommand, ItStandsInTheComparisonAndTheCurves) {
  const fs::path folder = fresh_folder();
  const json ours =
      result_in("run " + desk().string() + " --frames 10 --method gpo", folder / "ours.json");
  write_file(folder / "answer", answer_of(ours) + "\n");
  for (const std::string view : {"compare", "curves --lengths 10"}) {
    const Outcome outcome = spawned(fmt::format(
        "snapshot {} --frames 10 --view {} --methods gpo,mine --output {} --method-command "
        "mine=\"read w; cat '{}'\"",
        desk().string(),
        view,
        (folder / "picture.png").string(),
        (folder / "answer").string()));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_GT(fs::file_size(folder / "picture.png"), 10'000U);
  }
}

/// A session that was saved with a method of its own, which leaves a file where it is started.
fs::path session_with_command(const fs::path& folder) {
  const fs::path session = folder / "session.json", script = folder / "save.txt";
  write_file(script, "save-session " + session.string() + "\n");
  const Outcome outcome = spawned(fmt::format(
      "snapshot {} --frames 10 --method mine --script {} --method-command mine=\"touch '{}'; cat\"",
      desk().string(),
      script.string(),
      (folder / "started").string()));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(fs::remove(folder / "started"));
  return session;
}

// Sessions and scripts come from others, too.
TEST(MethodCommand, ASessionStartsNoneUnlessThatIsAllowed) {
  const fs::path folder = fresh_folder();
  const fs::path session = session_with_command(folder), script = folder / "open.txt";
  const json saved = json::parse(read_file(session));
  ASSERT_EQ(saved["method_commands"].size(), 1U);
  EXPECT_THAT(saved["method_commands"][0].get<std::string>(), testing::StartsWith("mine=touch "));
  write_file(script, "open " + session.string() + "\n");
  const Outcome without = spawned("snapshot --script " + script.string());
  EXPECT_EQ(without.exit_code, 0) << without.err;
  EXPECT_THAT(without.err,
              AllOf(HasSubstr("mine: not started: only a session names its command (touch "),
                    HasSubstr("--allow-commands starts it")));
  EXPECT_FALSE(fs::exists(folder / "started"));
  EXPECT_EQ(spawned("snapshot --allow-commands --script " + script.string()).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "started"));
  EXPECT_TRUE(fs::remove(folder / "started"));
  const Outcome other = spawned("snapshot --method-command mine=cat --script " + script.string());
  EXPECT_EQ(other.err, "") << "what the command line says of a name is what counts";
  EXPECT_FALSE(fs::exists(folder / "started"));
}

TEST(MethodCommand, ASessionsBadCommandsAreRefused) {
  const fs::path folder = fresh_folder();
  const fs::path session = session_with_command(folder), script = folder / "open.txt";
  write_file(script, "open " + session.string() + "\n");
  const json good = json::parse(read_file(session));
  for (const auto& [commands, message] : std::vector<std::pair<json, std::string>>{
           {json::object({{"mine", "touch it"}}), "method_commands: expected a list of texts"},
           {json::array({"mine"}), "'mine', expected NAME='COMMAND'"},
           {json::array({"gpo=cat"}), "there already is a method 'gpo'"}}) {
    json bad = good;
    bad["method_commands"] = commands;
    write_file(session, bad.dump());
    const Outcome outcome = spawned("snapshot --allow-commands --script " + script.string());
    EXPECT_EQ(outcome.exit_code, 2) << commands;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  }
}

TEST(MethodCommand, ASessionsCommandsMustFitIntoTheQuestion) {
  const fs::path folder = fresh_folder();
  const fs::path session = session_with_command(folder), script = folder / "open.txt";
  write_file(script, "open " + session.string() + "\n");
  json saved = json::parse(read_file(session));
  saved["method_commands"][0] = "mine=true" + std::string(5000, ' ') + "; rm it";
  write_file(session, saved.dump());
  const Outcome outcome = spawned("snapshot --script " + script.string());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("which a question can show"));
}

TEST(MethodCommand, ShardsAreMergedWithoutIt) {
  const fs::path folder = fresh_folder();
  for (int k = 1; k <= 2; ++k) {
    const Outcome shard = spawned(fmt::format(
        "evaluate {} --methods gpo,mine --lengths 10 --starts 0:20:10 --shard {}/2 --output {} "
        "--method-command mine='read w; echo no >&2'",
        desk().string(),
        k,
        (folder / "shards").string()));
    EXPECT_EQ(shard.exit_code, 0) << shard.err;
  }
  const Outcome merged = spawned(fmt::format(
      "evaluate --merge {} --output {}", (folder / "shards").string(), (folder / "out").string()));
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_THAT(read_file(folder / "out/results.csv"), HasSubstr("mine: ended"));
}

std::string opencv_command() {
  return "--method-command opencv='" + kDebiansPython +
         " " GPO_SOURCE_DIR "/engine/examples/peers/opencv_initializer.py'";
}

TEST(OpencvInitializer, SolvesTheDesk) {
  SKIP_WITHOUT_PYTHONS("cv2, numpy");
  const json result = result_in("run " + desk().string() + " --method opencv " + opencv_command(),
                                fresh_folder() / "a.json");
  EXPECT_EQ(result["frames"].size(), 30U);
  EXPECT_LT(result["metrics"]["pne_deg"], 3);
  EXPECT_GT(result["timing_ms"]["optimize"], 0);
  EXPECT_LT(result["timing_ms"]["optimize"], result["timing_ms"]["initialize"]);
}

TEST(OpencvInitializer, SolvesTheRoom) {
  SKIP_WITHOUT_PYTHONS("cv2, numpy");
  const fs::path room = fs::path(GPO_SHARED_DIR) / "data/euroc-room";
  if (!fs::exists(room)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  const fs::path folder = fresh_folder();
  const Outcome outcome = spawned(fmt::format(
      "evaluate {} --methods gpo_joint,opencv --lengths 20 --starts 0:40:10 --output {} {}",
      room.string(),
      folder.string(),
      opencv_command()));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string csv = read_file(folder / "results.csv");
  EXPECT_THAT(csv, HasSubstr(",opencv,"));
}

// The schemas say what is sent and what is read.
TEST(MethodCommand, WindowsAndAnswersFitTheirSchemas) {
  SKIP_WITHOUT_PYTHONS("cv2, jsonschema, numpy");
  const fs::path room = fs::path(GPO_SHARED_DIR) / "data/euroc-room";
  for (const fs::path& recording : {desk(), room}) {
    if (!fs::exists(recording)) continue;
    const Outcome outcome =
        spawned(fmt::format("run {} --frames 20 --method checked --method-command checked='{} "
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
