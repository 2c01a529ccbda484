// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/external_methods/own_method.h"

#include "engine/files/text_file.h"
#include "tests/engine/simulated_window.h"
#include "tests/engine/test_folder.h"

#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace gpo::test {
namespace {

using testing::ElementsAre, testing::HasSubstr;
using Json = nlohmann::ordered_json;

Window wandering_window() {
  return simulate_fitted({.motion = Motion::wander, .frames = 6, .points = 60}).window;
}

std::vector<double> numbers_of(const auto& matrix) {
  std::vector<double> rows;
  for (int i = 0; i < matrix.rows(); ++i)
    for (int j = 0; j < matrix.cols(); ++j) rows.push_back(matrix(i, j));
  return rows;
}

enum class Given { all, plane, points, cameras };

/// Returns a result as the answer of a user's program.
std::string answer_of(const Initialization& result, Given given) {
  Json json = {{"cameras", Json::array()}};
  for (const Pose& camera : result.cameras)
    json["cameras"].push_back(
        {{"R_wc", numbers_of(camera.R_wc)}, {"center", numbers_of(camera.p_wc)}});
  if (given == Given::all || given == Given::plane)
    json["plane"] = {{"normal", numbers_of(result.plane.normal)},
                     {"distance", result.plane.distance}};
  if (given == Given::all || given == Given::points) {
    json["points"] = Json::array();
    for (const MapPoint& point : result.points)
      json["points"].push_back({{"track", point.track}, {"position", numbers_of(point.position)}});
  }
  return json_text(json, -1);
}

CommandOptions patient() { return {.time_limit = std::chrono::seconds(60)}; }

Method mine(const std::string& command, const CommandOptions& options = patient()) {
  return command_method({"mine", command}, options, 0);
}

/// Runs a command that answers with the lines of a file.
Initialization answered(const Window& window, const std::string& answers) {
  const TestFolder folder;
  const auto file = folder.write("answers", answers);
  return mine(fmt::format("exec 3< '{}'; while read -r window; do read -r answer <&3; echo "
                          "\"$answer\"; done",
                          file.string()))
      .initialize(window, {}, {});
}

class CommandMethodAnswer : public testing::Test {
 protected:
  const Window window = wandering_window();
  const Initialization ours = find_method("gpo").initialize(window, {}, {});
};

std::string reason_of(const std::string& command, CommandOptions options = patient()) {
  const Initialization result = mine(command, options).initialize(wandering_window(), {}, {});
  EXPECT_FALSE(result.ok) << command;
  EXPECT_EQ(result.reason.find('\n'), std::string::npos) << result.reason;
  return result.reason;
}

TEST_F(CommandMethodAnswer, ReturnsTheGivenResultUnchanged) {
  ASSERT_TRUE(ours.ok) << ours.reason;
  const Initialization theirs = answered(window, answer_of(ours, Given::plane));
  ASSERT_TRUE(theirs.ok) << theirs.reason;
  EXPECT_EQ(theirs.plane.normal, ours.plane.normal);
  EXPECT_EQ(theirs.plane.distance, 1);
  ASSERT_EQ(theirs.cameras.size(), ours.cameras.size());
  for (std::size_t i = 0; i < ours.cameras.size(); ++i) {
    EXPECT_EQ(theirs.cameras[i].R_wc, ours.cameras[i].R_wc);
    EXPECT_EQ(theirs.cameras[i].p_wc, ours.cameras[i].p_wc);
  }
  ASSERT_EQ(theirs.points.size(), ours.points.size());
  EXPECT_EQ(theirs.points.front().position, ours.points.front().position);
  EXPECT_EQ(theirs.rms_px, ours.rms_px);
}

TEST_F(CommandMethodAnswer, FitsMissingPlaneAndTriangulatesMissingPoints) {
  for (const Given given : {Given::points, Given::cameras}) {
    const Initialization theirs = answered(window, answer_of(ours, given));
    ASSERT_TRUE(theirs.ok) << theirs.reason;
    EXPECT_LT(angle_deg(theirs.plane.normal, ours.plane.normal), 2);
    EXPECT_EQ(theirs.plane.distance, 1);
    EXPECT_NEAR(theirs.cameras.back().p_wc.norm(), ours.cameras.back().p_wc.norm(), 0.02);
    EXPECT_LT(theirs.rms_px, 1.5);
  }
}

TEST_F(CommandMethodAnswer, AcceptsAnyWorldAndScaleAndResectsAMissingCamera) {
  Initialization moved = ours;
  const Pose world{so3_exp({0.3, -1, 0.5}), {5, -3, 2}};
  const double scale = 7;
  for (Pose& camera : moved.cameras) {
    camera.p_wc *= scale;
    camera = world * camera;
  }
  for (MapPoint& point : moved.points) point.position = to_world(world, scale * point.position);
  moved.plane = {-(world.R_wc * ours.plane.normal), 0};
  moved.plane.distance = -moved.plane.normal.dot(moved.points.front().position);
  const Initialization theirs = answered(window, answer_of(moved, Given::all));
  ASSERT_TRUE(theirs.ok) << theirs.reason;
  EXPECT_LT(angle_deg(theirs.plane.normal, ours.plane.normal), 1e-6);
  for (std::size_t i = 0; i < ours.cameras.size(); ++i) {
    EXPECT_LT((theirs.cameras[i].R_wc - ours.cameras[i].R_wc).norm(), 1e-9);
    EXPECT_LT((theirs.cameras[i].p_wc - ours.cameras[i].p_wc).norm(), 1e-3);
  }
  Json answer = Json::parse(answer_of(ours, Given::all));
  answer["cameras"][3] = nullptr;
  const Initialization resected = answered(window, json_text(answer, -1));
  ASSERT_TRUE(resected.ok) << resected.reason;
  EXPECT_LT((resected.cameras[3].p_wc - ours.cameras[3].p_wc).norm(), 0.02);
}

TEST_F(CommandMethodAnswer, RejectsResultThatDoesNotFitTheTracks) {
  Initialization wrong = ours;
  wrong.plane.normal = so3_exp({0.8, 0, 0}) * wrong.plane.normal;
  const Initialization theirs = answered(window, answer_of(wrong, Given::plane));
  EXPECT_FALSE(theirs.ok);
  EXPECT_THAT(theirs.reason, testing::StartsWith("mine: "));
}

/// Returns our result as a user's answer, with all its points.
Answer same_answer(const Initialization& ours) {
  return {.cameras = {ours.cameras.begin(), ours.cameras.end()},
          .plane = ours.plane,
          .points = ours.points};
}

TEST_F(CommandMethodAnswer, RejectsPointsThatDoNotFitOrAreBehind) {
  EXPECT_TRUE(initialization_of(window, same_answer(ours)).ok);
  Answer scaled = same_answer(ours), behind = same_answer(ours);
  for (MapPoint& point : scaled.points) point.position *= 1.5;
  for (MapPoint& point : behind.points) point.position *= -1;
  EXPECT_THAT(initialization_of(window, scaled).reason,
              testing::StartsWith("the points do not fit their tracks: median residual "));
  EXPECT_THAT(initialization_of(window, behind).reason,
              HasSubstr("points are behind the reference camera"));
}

TEST_F(CommandMethodAnswer, NamesTheOneCameraThatDoesNotFit) {
  Answer answer = same_answer(ours);
  answer.cameras[4]->p_wc.x() += 0.2;
  const Initialization theirs = initialization_of(window, answer);
  EXPECT_FALSE(theirs.ok);
  EXPECT_THAT(theirs.reason,
              testing::StartsWith("the camera of frame 4 does not fit its tracks: median "));
  EXPECT_TRUE(theirs.refused);
}

TEST_F(CommandMethodAnswer, RejectsTwoDifferentLeadingPlanes) {
  Answer answer = same_answer(ours);
  answer.planes = {{window.leader, ours.plane}};
  EXPECT_TRUE(initialization_of(window, answer).ok);
  answer.planes.front().plane.distance *= 2;
  EXPECT_THAT(initialization_of(window, answer).reason, HasSubstr("two different leading planes"));
}

TEST(CommandMethod, ReportsEachFailureInOneLine) {
  EXPECT_EQ(reason_of("read w; echo '{\"failed\": \"too dark\"}'; cat"), "mine: too dark");
  EXPECT_THAT(reason_of("cat"), HasSubstr("mine: answer 1: "));
  EXPECT_THAT(reason_of("read w; echo garbage; cat"),
              HasSubstr("mine: answer 1: invalid JSON from byte 1 on: 'garbage'"));
  EXPECT_EQ(reason_of("read w; printf '{\"cam'; kill -9 $$"),
            "mine: was killed by signal 9 (Killed) in the middle of answer 1");
  EXPECT_EQ(reason_of("echo broken >&2; exit 3"),
            "mine: ended with exit code 3 before answer 1: broken");
  EXPECT_THAT(reason_of("/no/such/program"),
              testing::AllOf(HasSubstr("ended with exit code 127"), HasSubstr("not found")));
  EXPECT_EQ(reason_of("head -c 2000000000 /dev/zero | tr '\\0' '['"),
            "mine: answer 1 is longer than 8 MiB");
  EXPECT_EQ(reason_of("sleep 1000", {.time_limit = std::chrono::milliseconds(200)}),
            "mine: no answer 1 within 0.2 s");
  EXPECT_EQ(reason_of("printf begun; sleep 1000", {.time_limit = std::chrono::milliseconds(500)}),
            "mine: no answer 1 within 0.5 s, only its beginning");
}

TEST(CommandMethod, OneProcessServesManyWindowsUntilItFailsOrEnds) {
  const TestFolder folder;
  const Window window = wandering_window();
  const auto count = folder.path() / "started";
  const Method method =
      mine(fmt::format("echo >> '{}'; read w; echo '{{\"failed\": \"a\"}}'; read w; "
                       "echo '{{\"failed\": \"b\"}}'; read w; echo garbage; read w",
                       count.string()));
  std::vector<std::string> reasons;
  for (int i = 0; i < 4; ++i) reasons.push_back(method.initialize(window, {}, {}).reason);
  EXPECT_THAT(
      reasons,
      ElementsAre("mine: a", "mine: b", HasSubstr("mine: answer 3: invalid JSON"), "mine: a"));
  EXPECT_EQ(folder.read("started"), "\n\n");
  const Method once = mine("read w; echo '{\"failed\": \"once\"}'");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(once.initialize(window, {}, {}).reason, "mine: once");
}

TEST(CommandMethod, StartsOneProcessPerThread) {
  const Window window = wandering_window();
  const Method method =
      mine("while read w; do sleep 0.1; echo \"{\\\"failed\\\": \\\"$$\\\"}\"; done");
  std::vector<std::string> reasons(3);
  {
    std::vector<std::jthread> threads;
    for (std::string& reason : reasons)
      threads.emplace_back([&] { reason = method.initialize(window, {}, {}).reason; });
  }
  EXPECT_NE(reasons[0], reasons[1]);
  EXPECT_NE(reasons[1], reasons[2]);
  EXPECT_THAT(reasons, testing::Each(testing::StartsWith("mine: ")));
}

TEST(CommandMethod, StopIsNoFailure) {
  std::stop_source stop;
  stop.request_stop();
  const Initialization result =
      mine("sleep 1000").initialize(wandering_window(), {}, Watch(stop.get_token()));
  EXPECT_TRUE(result.stopped);
}

TEST(CommandMethod, PassesOnStandardError) {
  std::vector<std::string> lines;
  CommandOptions options = patient();
  options.on_line = [&](const std::string& name, const std::string& line) {
    lines.push_back(name + ": " + line);
  };
  reason_of(
      "read w; echo 'slow' >&2; printf 'a\\033b\\n' >&2; sleep 0.2; echo '{\"failed\": \"x\"}'",
      options);
  EXPECT_THAT(lines, ElementsAre("mine: slow", "mine: a\\x1Bb"));
  lines.clear();
  reason_of("read w; seq 1000 >&2; sleep 0.2; echo '{\"failed\": \"x\"}'", options);
  EXPECT_EQ(lines.size(), 21U);
  EXPECT_EQ(lines.back(), "mine: ...");
}

TEST(CommandMethod, IdentityDependsOnContentOfFiles) {
  const TestFolder folder;
  const auto identity = [&](const std::string& content) {
    const auto file = folder.write("mine.py", content);
    return mine("python3 " + file.string()).identity;
  };
  const std::string first = identity("one");
  EXPECT_THAT(first, testing::StartsWith("python3 /"));
  EXPECT_NE(identity("two"), first);
  EXPECT_EQ(identity("one"), first);
}

TEST(MethodCommand, HasNameAndCommand) {
  const NamedText parsed = parse_method_command("my_2-nd=FOO=1 python3 mine.py");
  EXPECT_EQ(parsed.name, "my_2-nd");
  EXPECT_EQ(parsed.text, "FOO=1 python3 mine.py");
  for (const char* bad : {"", "mine", "=cat", "mine=", "mine= ", "a+b=cat", "a,b=cat", "all=cat"})
    EXPECT_THAT(error_of([&] { parse_method_command(bad); }), HasSubstr("--method-command")) << bad;
}

TEST(WindowJson, ContainsTheWindow) {
  Window window = wandering_window();
  window.points_px[2].col(7).setConstant(std::numeric_limits<double>::quiet_NaN());
  Gyroscope gyroscope;
  gyroscope.time_offset_ns = 1000;
  for (int i = -20; i < 400; ++i) {
    gyroscope.timestamps_ns.push_back(window.timestamps_ns[0] + 1000 + i * std::int64_t{5'000'000});
    gyroscope.rates_rad_s.emplace_back(i, 0, 0);
  }
  const Sources sources{.gyroscope = &gyroscope,
                        .images = std::vector<std::filesystem::path>(6, "a.png")};
  const Json json = Json::parse(json_text(window_json(window, sources), -1));
  EXPECT_EQ(json["tracks"].size(), 6U);
  EXPECT_EQ(json["tracks"][2].size(), 60U);
  EXPECT_TRUE(json["tracks"][2][7].is_null());
  EXPECT_EQ(json["tracks"][2][8][1], window.points_px[2](1, 8)) << "all digits";
  EXPECT_EQ(json["inliers"][1][5], static_cast<bool>(window.inlier[1][5]));
  EXPECT_EQ(json["K"][0][2], window.K(0, 2));
  EXPECT_EQ(json["rotations"][5][0][1], window.R_wc[5](0, 1));
  EXPECT_EQ(json["homographies"][5][0][1], window.H_i1[5](0, 1));
  EXPECT_EQ(json["pictures"].size(), 6U);
  EXPECT_FALSE(json.contains("video"));
  EXPECT_FALSE(json.contains("camera"));
  const Json& times = json["gyroscope"]["timestamps_ns"];
  EXPECT_LE(times.front(), window.timestamps_ns.front() + 1000);
  EXPECT_GT(times.front(), window.timestamps_ns.front() - 6'000'000);
  EXPECT_GE(times.back(), window.timestamps_ns.back() + 1000);
  EXPECT_LT(times.back(), window.timestamps_ns.back() + 6'000'000);
  EXPECT_EQ(times.size(), json["gyroscope"]["rates_rad_s"].size());
}

constexpr ExpectedAnswer kExpected{.id = 4, .frames = 2, .tracks = 10, .planes = 2};
const std::string kStill = R"({"R_wc": [[1,0,0],[0,1,0],[0,0,1]], "center": [0,0,0]})";
const std::string kMoved = R"({"R_wc": [0,-1,0, 1,0,0, 0,0,1], "center": [1,2,3]})";

std::string answer_with(const std::string& more, const std::string& second = kMoved) {
  return fmt::format(R"({{"cameras": [{}, {}]{}}})", kStill, second, more);
}

TEST(ReadAnswer, ReadsAllKeys) {
  const Answer answer =
      read_answer(answer_with(R"(, "id": 4, "plane": {"normal": [0,0,-2], "distance": 4},
        "planes": [{"plane": 1, "normal": [0,-1,0], "distance": 3}],
        "points": [{"track": 9, "position": [0.5, 1e-3, 2]}], "milliseconds": 12.5)"),
                  kExpected);
  EXPECT_FALSE(answer.failed);
  ASSERT_EQ(answer.cameras.size(), 2U);
  EXPECT_EQ(answer.cameras[1]->R_wc(0, 1), -1) << "by rows";
  EXPECT_EQ(answer.cameras[1]->R_wc(1, 0), 1);
  EXPECT_EQ(answer.cameras[1]->p_wc, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(answer.plane->normal, Eigen::Vector3d(0, 0, -1)) << "of length 1";
  EXPECT_EQ(answer.plane->distance, 2);
  ASSERT_EQ(answer.planes.size(), 1U);
  EXPECT_EQ(answer.planes[0].number, 1);
  ASSERT_EQ(answer.points.size(), 1U);
  EXPECT_EQ(answer.points[0].track, 9);
  EXPECT_EQ(answer.points[0].position, Eigen::Vector3d(0.5, 1e-3, 2));
  EXPECT_EQ(answer.milliseconds, 12.5);
}

TEST(ReadAnswer, AcceptsMissingCameraReasonAloneAndRotationsOfFewDigits) {
  EXPECT_FALSE(read_answer(answer_with("", "null"), kExpected).cameras[1]);
  const Answer failed = read_answer(R"({"failed": "too\ndark"})", kExpected);
  EXPECT_EQ(failed.failed, "too\\ndark") << "one line";
  EXPECT_EQ(read_answer(R"({"failed": " "})", kExpected).failed, "failed without a reason");
  const Answer answer = read_answer(
      answer_with("", R"({"R_wc": [0.8,-0.6001,0, 0.6,0.8,0, 0,0,1], "center": [0,0,0]})"),
      kExpected);
  const Eigen::Matrix3d R = answer.cameras[1]->R_wc;
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_NEAR(R(1, 0), 0.6, 1e-3);
}

TEST(ReadAnswer, NamesTheKeyOfAnError) {
  const auto camera = [](const std::string& R, const std::string& center) {
    return answer_with("", fmt::format(R"({{"R_wc": {}, "center": {}}})", R, center));
  };
  const std::string nine = "[1,0,0, 0,1,0, 0,0,1]";
  for (
      const auto& [line, message] : {
          std::pair{std::string("cameras"), std::string("invalid JSON from byte 1 on: 'cameras'")},
          {"", "invalid JSON"},
          {R"({"cameras": NaN})", "cameras: expected an array"},
          {"[1]", "answer: expected an object"},
          {"{}", "cameras: is missing, as is failed"},
          {R"({"camrea": 1})", "camrea: unknown key, expected id, failed, cameras"},
          {R"({"failed": 7})", "failed: expected a string"},
          {R"({"cameras": []})", "cameras: expected 2, one per frame, found 0"},
          {R"({"cameras": [null, null]})", "cameras[0]: expected the reference camera"},
          {answer_with("", "7"), "cameras[1]: expected an object"},
          {answer_with("", R"({"R_wc": [1], "center": [0,0,0], "scale": 1})"),
           "cameras[1].scale: unknown key"},
          {answer_with("", R"({"center": [0,0,0]})"), "cameras[1].R_wc: is missing"},
          {camera("[1,2,3]", "[0,0,0]"), "cameras[1].R_wc: expected 9 numbers"},
          {camera("[1,0,0, 0,1,0, 0,0,1, 0]", "[0,0,0]"), "cameras[1].R_wc: expected 9 numbers"},
          {camera("[1,0,0, 0,1,0, 0,0,\"1\"]", "[0,0,0]"),
           "cameras[1].R_wc: found '1', expected 9 numbers"},
          {camera("[1,0,0, 0,1,0, 0,0,2]", "[0,0,0]"), "cameras[1].R_wc: expected a rotation"},
          {camera("[1,0,0, 0,1,0, 0,0,-1]", "[0,0,0]"),
           "cameras[1].R_wc: expected a rotation matrix, row by row, found a reflection"},
          {camera(nine, "[0, NaN, 0]"), "cameras[1].center: found 'NaN', expected 3 numbers"},
          {camera(nine, "[0,0,-Infinity]"), "cameras[1].center: found '-Infinity', expected 3"},
          {camera(nine, "[0,0]"), "cameras[1].center: expected 3 numbers"},
          {camera(nine, "[0,0,1e300]"),
           "cameras[1].center: 1e+300 is too large, expected at most 1e+12"},
          {camera(nine, "[0,0,1e999]"), "out of range"},
          {answer_with(R"(, "id": 3)"), "id: expected 4, as in the question"},
          {answer_with(R"(, "plane": {"normal": [0,0,0], "distance": 1})"),
           "plane.normal: expected a vector that is not zero"},
          {answer_with(R"(, "plane": {"normal": [0,0,1], "distance": 0})"),
           "plane.distance: expected a plane that does not contain the reference camera"},
          {answer_with(R"(, "planes": [{"plane": 2, "normal": [0,0,1], "distance": 1}])"),
           "planes[0].plane: expected a number from 0 to 1"},
          {answer_with(R"(, "points": 3)"), "points: expected an array"},
          {answer_with(R"(, "points": [{"track": 10, "position": [0,0,1]}])"),
           "points[0].track: expected a number from 0 to 9"},
          {answer_with(
               R"(, "points": [{"track": 1, "position": [0,0,1]}, {"track": 1, "position": [0,0,1]}])"),
           "points[1].track: expected each track once, found 1 again"},
          {answer_with(R"(, "milliseconds": "1")"), "milliseconds: found '1', expected a number"},
          {answer_with(R"(, "milliseconds": -3)"), "milliseconds: expected 0 or more, found -3"},
          {std::string(100'000, '['), "nested too deep"},
      })
    EXPECT_THAT(error_of([&, &line = line] { read_answer(line, kExpected); }), HasSubstr(message))
        << line;
}

}  // namespace
}  // namespace gpo::test
