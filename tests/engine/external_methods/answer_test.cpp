// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/external_methods/answer.h"

#include "tests/engine/test_folder.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using ::testing::HasSubstr;

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

TEST(ReadAnswer, AcceptsMissingCameraAndReasonAlone) {
  EXPECT_FALSE(read_answer(answer_with("", "null"), kExpected).cameras[1]);
  const Answer failed = read_answer(R"({"failed": "too\ndark"})", kExpected);
  EXPECT_EQ(failed.failed, "too\\ndark") << "one line";
}

TEST(ReadAnswer, OrthonormalizesRotationsOfFewDigits) {
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
          std::pair{std::string("cameras"), std::string("no JSON from byte 1 on: 'cameras'")},
          {"", "no JSON"},
          {R"({"cameras": NaN})", "no JSON"},
          {"[1]", "answer: expected an object"},
          {"{}", "cameras: is missing, as is failed"},
          {R"({"camrea": 1})", "camrea: unknown key, expected id, failed, cameras"},
          {R"({"failed": 7})", "failed: expected a text"},
          {R"({"cameras": []})", "cameras: expected 2, one per frame, found 0"},
          {R"({"cameras": [null, null]})", "cameras[0]: expected the reference camera"},
          {answer_with("", "7"), "cameras[1]: expected an object"},
          {answer_with("", R"({"R_wc": [1], "center": [0,0,0], "scale": 1})"),
           "cameras[1].scale: unknown key"},
          {answer_with("", R"({"center": [0,0,0]})"), "cameras[1].R_wc: is missing"},
          {camera("[1,2,3]", "[0,0,0]"), "cameras[1].R_wc: expected 9 numbers"},
          {camera("[1,0,0, 0,1,0, 0,0,1, 0]", "[0,0,0]"), "cameras[1].R_wc: expected 9 numbers"},
          {camera("[1,0,0, 0,1,0, 0,0,\"1\"]", "[0,0,0]"), "cameras[1].R_wc: expected 9 numbers"},
          {camera("[1,0,0, 0,1,0, 0,0,2]", "[0,0,0]"), "cameras[1].R_wc: expected a rotation"},
          {camera("[1,0,0, 0,1,0, 0,0,-1]", "[0,0,0]"), "cameras[1].R_wc: expected a rotation"},
          {camera(nine, "[0,0]"), "cameras[1].center: expected 3 numbers"},
          {camera(nine, "[0,0,1e300]"), "cameras[1].center: expected 3 numbers"},
          {camera(nine, "[0,0,1e999]"), "out of range"},
          {answer_with(R"(, "id": 3)"), "id: expected 4, as in the question"},
          {answer_with(R"(, "plane": {"normal": [0,0,0], "distance": 1})"),
           "plane.normal: expected a vector that is not zero"},
          {answer_with(R"(, "plane": {"normal": [0,0,1], "distance": 0})"),
           "plane.distance: expected a number that is not zero"},
          {answer_with(R"(, "planes": [{"plane": 2, "normal": [0,0,1], "distance": 1}])"),
           "planes[0].plane: expected a number from 0 to 1"},
          {answer_with(R"(, "points": 3)"), "points: expected an array"},
          {answer_with(R"(, "points": [{"track": 10, "position": [0,0,1]}])"),
           "points[0].track: expected a number from 0 to 9"},
          {answer_with(
               R"(, "points": [{"track": 1, "position": [0,0,1]}, {"track": 1, "position": [0,0,1]}])"),
           "points[1].track: expected each track once, found 1 again"},
          {answer_with(R"(, "milliseconds": "1")"), "milliseconds: expected a number"},
          {std::string(100'000, '['), "nested too deep"},
      })
    EXPECT_THAT(test::error_of([&, &line = line] { read_answer(line, kExpected); }),
                HasSubstr(message))
        << line;
}

}  // namespace
}  // namespace gpo
