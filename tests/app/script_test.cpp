// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// Scripts of the window's commands, run without a display.
class Script : public testing::Test {
 protected:
  Outcome run(const std::string& lines, const std::string& arguments = "") {
    write_file(folder_ / "script.txt", lines);
    return program("snapshot --script '" + (folder_ / "script.txt").string() + "' " + arguments);
  }
  std::string in(const std::string& name) const { return (folder_ / name).string(); }
  cv::Mat image(const std::string& name) const { return cv::imread(in(name)); }

  std::filesystem::path folder_ = fresh_folder();
};

TEST_F(Script, OpensChoosesAndDrawsAnyViewAtAnySize) {
  const Outcome outcome = run("# a comment, and an empty line\n\nopen '" + desk().string() +
                              "'\nopen \"" + desk().string() + "\"\nframe 12  # counted from 0\n" +
                              "screenshot " + in("window.png") + " window 1024x640\nscreenshot " +
                              in("picture.png") + " picture\nview normals\nscreenshot " +
                              in("normals.png") + " normals 500x400\nview compare\nscreenshot " +
                              in("compare.png") + " compare 1200x500\n");
  // Quotes are double ones; the first line says that there is no such folder and ends the script.
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("script.txt:3: "));
  const Outcome again = run("open \"" + desk().string() + "\"\nframe 12  # counted from 0\n" +
                            "screenshot " + in("window.png") + " window 1024x640\nscreenshot " +
                            in("picture.png") + " picture\nview normals\nscreenshot " +
                            in("normals.png") + " normals 500x400\nview compare\nscreenshot " +
                            in("compare.png") + " compare 1200x500\n");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(image("window.png").size(), cv::Size(1024, 640));
  EXPECT_EQ(image("picture.png").size(), cv::Size(640, 480));
  EXPECT_EQ(image("normals.png").size(), cv::Size(500, 400));
  EXPECT_EQ(image("compare.png").size(), cv::Size(1200, 500));
  EXPECT_THAT(again.out, HasSubstr("saved " + in("normals.png")));
}

TEST_F(Script, IsTheSameEveryTime) {
  const std::string lines = "frame 20\nselect track 17\nview track\nview normals\nscreenshot ";
  ASSERT_EQ(run(lines + in("a.png"), desk().string()).exit_code, 0);
  ASSERT_EQ(run(lines + in("b.png"), desk().string()).exit_code, 0);
  EXPECT_EQ(read_file(in("a.png")), read_file(in("b.png")));
}

TEST_F(Script, ExportsWhatIsShown) {
  const Outcome outcome =
      run("method pba\nset frames 20\nframe 10\nselect outliers\nexclude\nexport result " +
              in("a.json") + "\nexport trajectory " + in("a.txt") + "\nexport points " +
              in("a.ply") + "\n",
          desk().string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto result = json::parse(read_file(in("a.json")));
  EXPECT_EQ(result["method"], "pba");
  EXPECT_EQ(result["window"]["frames"], 20);
  EXPECT_FALSE(result["settings"]["exclude"].empty());
  const auto lines = [](const std::string& text) { return std::ranges::count(text, '\n'); };
  EXPECT_EQ(lines(read_file(in("a.txt"))), 21);  // a comment line, and one a frame
}

TEST_F(Script, OfASessionGoesOnWhereItWasSaved) {
  ASSERT_EQ(
      run("method ba\nframe 7\nbookmark \"look here\"\ntheme light\nview solver\nselect track "
          "17\nsave-session " +
              in("s.json") + "\nscreenshot " + in("a.png"),
          desk().string())
          .exit_code,
      0);
  const Outcome outcome = run("open " + in("s.json") + "\nscreenshot " + in("b.png"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  // All of the window but the line with the last message.
  const cv::Rect shown(0, 0, 1280, 690);
  EXPECT_EQ(cv::norm(image("a.png")(shown), image("b.png")(shown), cv::NORM_INF), 0);
  const auto session = json::parse(read_file(in("s.json")));
  EXPECT_EQ(session["settings"]["method"], "ba");
  EXPECT_EQ(session["frame"], 7);
}

TEST_F(Script, EndsAtTheFirstLineThatIsWrong) {
  for (const auto& [lines, what] :
       {std::pair{"frame 3\nfly\n", "script.txt:2: unknown command \"fly\""},
        {"frame\n", "script.txt:1: frame: expected N"},
        {"screenshot a.png cellar\n", "script.txt:1: screenshot: unknown view 'cellar'"},
        {"frame 200\n",
         "script.txt:1: frame: 200 is not in the recording, which has frames 0 to 59"},
        {"frame 59\nframe -1\n", "script.txt:2: frame: -1 is not in the recording"},
        {"screenshot a.png 4294967936x480\n", "script.txt:1: screenshot: '4294967936x480'"},
        {"set frames 1\n", "script.txt:1: frames: '1', expected a number from 2 to 1000"},
        {"open no/such/folder\n", "script.txt:1: no/such/folder"},
        {"export result no/such/a.json\n", "script.txt:1: no/such/a.json"}}) {
    const Outcome outcome = run(lines, desk().string());
    EXPECT_EQ(outcome.exit_code, 2) << lines;
    EXPECT_THAT(outcome.err, HasSubstr(what));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  }
  EXPECT_THAT(program("snapshot --script no/such/script").err, HasSubstr("no/such/script"));
}

TEST_F(Script, TellsWhyAShortWindowIsRefused) {
  const Outcome outcome = run("set frames 8\nexport result " + in("a.json") + "\n",
                              GPO_SOURCE_DIR "/sequences/low-parallax.yaml");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto result = json::parse(read_file(in("a.json")));
  EXPECT_EQ(result["status"], "failed");
  EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("of its distance from the plane"));
}

}  // namespace
}  // namespace gpo::test
