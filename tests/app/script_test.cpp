// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// Runs scripts of commands without a display.
class Script : public testing::Test {
 protected:
  Outcome run(const std::string& lines, const std::string& arguments = "") {
    write_file(folder_ / "script.txt", lines);
    return program("snapshot --script '{}' {}", folder_ / "script.txt", arguments);
  }
  std::string in(const std::string& name) const { return (folder_ / name).string(); }
  cv::Mat image(const std::string& name) const { return cv::imread(in(name)); }

  std::filesystem::path folder_ = fresh_folder();
};

TEST_F(Script, OpensRecordingsAndDrawsViewsOfAnySize) {
  expect_refused(run("# a comment and an empty line\n\nopen '" + kDesk + "'\n"),
                 "script.txt:3: ");  // only double quotes are allowed
  const Outcome outcome = run("open \"" + kDesk + "\"\nframe 12  # counts from 0\n" +
                              "screenshot " + in("window.png") + " window 1024x640\nscreenshot " +
                              in("picture.png") + " picture\nview normals\nscreenshot " +
                              in("normals.png") + " normals 500x400\nview compare\nscreenshot " +
                              in("compare.png") + " compare 1200x500\n");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(image("window.png").size(), cv::Size(1024, 640));
  EXPECT_EQ(image("picture.png").size(), cv::Size(640, 480));
  EXPECT_EQ(image("normals.png").size(), cv::Size(500, 400));
  EXPECT_EQ(image("compare.png").size(), cv::Size(1200, 500));
  EXPECT_THAT(outcome.out, HasSubstr("saved " + in("normals.png")));
}

TEST_F(Script, IsReproducible) {
  const std::string lines = "frame 20\nselect track 17\nview track\nview normals\nscreenshot ";
  ASSERT_EQ(run(lines + in("a.png"), kDesk).exit_code, 0);
  ASSERT_EQ(run(lines + in("b.png"), kDesk).exit_code, 0);
  EXPECT_EQ(read_file(in("a.png")), read_file(in("b.png")));
}

TEST_F(Script, ExportsTheCurrentResult) {
  const Outcome outcome =
      run("method pba\nset frames 20\nframe 10\nselect outliers\nexclude\nexport result " +
              in("a.json") + "\nexport trajectory " + in("a.txt") + "\nexport points " +
              in("a.ply") + "\n",
          kDesk);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto result = read_json(in("a.json"));
  EXPECT_EQ(result["method"], "pba");
  EXPECT_EQ(result["window"]["frames"], 20);
  EXPECT_FALSE(result["settings"]["exclude"].empty());
  EXPECT_EQ(std::ranges::count(read_file(in("a.txt")), '\n'), 21);  // a comment and 20 frames
}

TEST_F(Script, SessionRestoresTheView) {
  const std::string lines =
      "method ba\nframe 7\nbookmark \"look here\"\ntheme light\nview solver\nselect track 17\n";
  const std::string save = "save-session " + in("s.json") + "\nscreenshot " + in("a.png");
  ASSERT_EQ(run(lines + save, kDesk).exit_code, 0);
  const Outcome outcome = run("open " + in("s.json") + "\nscreenshot " + in("b.png"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  // The window without the status line, which has the last message.
  const cv::Rect shown(0, 0, 1280, 690);
  EXPECT_EQ(cv::norm(image("a.png")(shown), image("b.png")(shown), cv::NORM_INF), 0);
  const auto session = read_json(in("s.json"));
  EXPECT_EQ(session["settings"]["method"], "ba");
  EXPECT_EQ(session["frame"], 7);
}

TEST_F(Script, StopsAtTheFirstInvalidLine) {
  for (const auto& [lines, message] :
       {std::pair{"frame 3\nfly\n", "script.txt:2: unknown command \"fly\""},
        {"frame\n", "script.txt:1: frame: expected N"},
        {"screenshot a.png cellar\n", "script.txt:1: screenshot: unknown view 'cellar'"},
        {"frame 200\n", "script.txt:1: frame: 200 is outside of the recording, expected 0 to 59"},
        {"frame 59\nframe -1\n", "script.txt:2: frame: -1 is outside of the recording"},
        {"screenshot a.png 4294967936x480\n", "script.txt:1: screenshot: '4294967936x480'"},
        {"set frames 1\n", "script.txt:1: frames: '1', expected a number from 2 to 1000"},
        {"open no/such/folder\n", "script.txt:1: no/such/folder"},
        {"export result no/such/a.json\n", "script.txt:1: no/such/a.json"}}) {
    SCOPED_TRACE(lines);
    expect_refused(run(lines, kDesk), message);
  }
  EXPECT_THAT(program("snapshot --script no/such/script").err, HasSubstr("no/such/script"));
}

TEST_F(Script, ReportsWhyAShortWindowFails) {
  const Outcome outcome = run("set frames 8\nexport result " + in("a.json") + "\n",
                              GPO_SOURCE_DIR "/sequences/low-parallax.yaml");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto result = read_json(in("a.json"));
  EXPECT_EQ(result["status"], "failed");
  EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("of its distance from the plane"));
}

}  // namespace
}  // namespace gpo::test
