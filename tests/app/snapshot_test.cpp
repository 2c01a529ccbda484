// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "engine/files/image_codec.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/app/program.h"

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

using testing::HasSubstr;

Outcome snapshot(const std::string& view, const fs::path& output, const std::string& more = "") {
  return program("snapshot {} --view {} --output {} {}", kDesk, view, output, more);
}

Outcome compared(const fs::path& output, const fs::path& baseline, const std::string& more = "") {
  return snapshot("image", output, fmt::format("--baseline {} {}", baseline, more));
}

/// The baseline of a view, of this suite if it has its own: Mesa and Dear ImGui of Debian 13 draw
/// round points and small circles differently, a fifth of a percent of the pixels.
fs::path baseline_of(const std::string& view) {
  const fs::path all = GPO_SOURCE_DIR "/tests/snapshots";
  const fs::path own = all / GPO_SUITE / (view + ".png");
  return fs::exists(own) ? own : all / (view + ".png");
}

TEST(SnapshotOf, AgreesWithItsBaselineAndIsReproducible) {
  const fs::path folder = fresh_folder();
  // Independent of the table of methods.
  const std::string variants = "--methods gpo,gpo+no-ransac,gpo+truth --size ";
  for (const std::string view : {"image", "scene", "normals", "window", "compare", "curves"}) {
    SCOPED_TRACE(view);
    const fs::path file = folder / (view + ".png");
    const std::string options = view == "compare"  ? variants + "1080x440"
                                : view == "curves" ? variants + "1200x400"
                                                   : "";
    const Outcome outcome =
        snapshot(view, file, fmt::format("{} --baseline {}", options, baseline_of(view)));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
    const std::string first = read_file(file);
    EXPECT_EQ(snapshot(view, file, options).exit_code, 0);
    EXPECT_EQ(read_file(file), first) << "not the same bytes";
  }
}

TEST(Snapshot, CompareDrawsEveryMethodOfTheTable) {
  const fs::path file = fresh_folder() / "a.png";
  const Outcome outcome = snapshot("compare", file, "--frames 12");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_FALSE(read_image(file).empty());
}

TEST(Snapshot, WarnsAboutUnusedOptions) {
  const fs::path file = fresh_folder() / "a.png";
  EXPECT_EQ(
      snapshot("image", file, "--frames 12 --method gpo --methods gpo --lengths 5 --loss huber")
          .err,
      "--methods is not used. Only the views compare and curves read it\n"
      "--lengths is not used. Only the view curves reads it\n"
      "--loss is not used. Applies only to gpo_joint\n");
  const std::string three = "--frames 12 --methods gpo,gpo+no-ransac,gpo_joint ";
  EXPECT_EQ(snapshot("compare", file, three + "--loss huber --tracking anchored").err, "");
  EXPECT_EQ(snapshot("compare", file, three + "--ransac --method ba").err,
            "--method is not used. The compared methods set it themselves\n"
            "--ransac is not used. The compared methods set it themselves\n");
}

TEST(Snapshot, CurvesNeedGroundTruth) {
  const fs::path folder = fresh_folder();
  copy_of_desk(folder / "in", {"board.yaml", "mav0/state_groundtruth_estimate0"});
  expect_exit(
      2,
      program("snapshot {0}/in --view curves --lengths 5 --methods gpo --output {0}/a.png", folder),
      "has no ground truth");
  EXPECT_FALSE(fs::exists(folder / "a.png"));
}

TEST(Snapshot, HasTheRequestedSize) {
  const fs::path file = fresh_folder() / "a.png";
  ASSERT_EQ(snapshot("window", file, "--size 1000x600").exit_code, 0);
  EXPECT_EQ(read_image(file).size(), cv::Size(1000, 600));
}

TEST(Snapshot, DifferenceExitsOneAndIsDrawn) {
  const fs::path folder = fresh_folder();
  ASSERT_EQ(snapshot("image", folder / "base.png", "--frame 20").exit_code, 0);
  // Another method moves the cube and the outliers only a little.
  for (const char* other : {"--frame 24", "--frame 20 --method gpo"}) {
    const Outcome outcome = compared(folder / "a.png", folder / "base.png", other);
    expect_exit(1, outcome, (folder / "a.diff.png").string());
    EXPECT_TRUE(fs::remove(folder / "a.diff.png"));
  }
}

TEST(Snapshot, ToleranceDefinesEquality) {
  const fs::path folder = fresh_folder();
  ASSERT_EQ(snapshot("image", folder / "a.png").exit_code, 0);
  write_image(folder / "brighter.png", read_image(folder / "a.png") + cv::Scalar::all(5));
  const fs::path brighter = folder / "brighter.png";
  EXPECT_EQ(compared(folder / "b.png", brighter).exit_code, 1);
  EXPECT_EQ(compared(folder / "c.png", brighter, "--tolerance 6").exit_code, 0);
}

TEST(Snapshot, DoesNotOverwriteItsBaseline) {
  const fs::path folder = fresh_folder(), base = folder / "a.diff.png";
  write_file(base, "the baseline");
  for (const char* output : {"a.diff.png", "./a.diff.png"})
    expect_exit(2, compared(folder / output, base), "--output and --baseline: found ");
  EXPECT_EQ(compared(folder / "a.png", base).exit_code, 2);
  EXPECT_EQ(read_file(base), "the baseline");
}

TEST(Snapshot, BaselineOfAnotherSizeIsReported) {
  const fs::path folder = fresh_folder();
  write_image(folder / "base.png", cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(9)));
  const Outcome outcome = compared(folder / "a.png", folder / "base.png");
  expect_exit(1, outcome, "the baseline is 320x240, the image 640x480");
  EXPECT_EQ(outcome.out.find("pixels that differ"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("diff.png"), std::string::npos) << outcome.out;  // not written
}

/// Draws a view of a frame for a window of the first frames.
DrawnView drawn_frame(const std::string& view, int frame, int frames) {
  static const auto recording = open_recording(desk());
  ViewRequest request;
  request.view = view;
  request.frame = frame;
  request.window.frames = frames;
  return draw_view(recording, request);
}

TEST(Snapshot, FramesAfterTheWindowHaveExtrapolatedCameras) {
  const auto dashes = [](const cv::Mat& image) {  // which frame an extrapolated image
    cv::Mat border;
    cv::inRange(image.rowRange(1, 4), cv::Scalar(204, 233, 245), cv::Scalar(224, 253, 255), border);
    return cv::countNonZero(border);
  };
  const DrawnView after = drawn_frame("image", 27, 20);
  EXPECT_TRUE(after.failures.empty());
  EXPECT_GT(dashes(after.image), 200);
  EXPECT_LT(dashes(drawn_frame("image", 27, 28).image), 20) << "in the window";
  EXPECT_GT(
      cv::norm(
          drawn_frame("scene", 27, 20).image, drawn_frame("scene", 19, 20).image, cv::NORM_INF),
      100)
      << "the scene has the path of these cameras";
}

TEST(Snapshot, FramesOutsideOfAFailedWindowShowTheirImage) {
  const DrawnView drawn = drawn_frame("image", 40, 2);
  EXPECT_FALSE(drawn.ok);
  const cv::Mat frame = open_recording(desk())->images->bgr(40);
  const cv::Rect below(0, 240, 640, 200);
  EXPECT_LT(cv::norm(drawn.image(below), frame(below), cv::NORM_INF), 3);
}

TEST(Snapshot, RefusesBadInputInOneLineAndLeavesNoFile) {
  expect_each_refused(
      "snapshot " + kDesk + " --output {}/a.png ",
      {{"--view imgae", "--view"},
       {"", "--view"},
       {"--view image --size 100", "--size: '100'"},
       {"--view image --size 0x5", "--size: '0x5'"},
       {"--view image --size 4294967936x480", "--size: '4294967936x480'"},
       {"--view image --frame 60", "--frame: 60 is not in the recording"},
       {"--view image --frame -1", "--frame: -1"},
       {"--view image --tolerance 300", "--tolerance"},
       {"--view compare --methods gpo,nonsense",
        "unknown method 'nonsense', expected all or some of gpo"},
       {"--view curves --methods gpo+nonsense",
        "unknown setting 'nonsense', expected one of ransac"},
       {"--view curves --lengths 1", "--lengths"},
       {"--view curves --lengths 5:200:5", "--lengths: '5:200:5' has a window of 200 frames"},
       {"--view compare --frame 60", "--frame: 60 is not in the recording"},
       {"--view image --baseline no.png", "--baseline: no.png: no such file"}});
}

TEST(Snapshot, ReportsThatOneImageIsNoWindow) {
  const auto folder = fresh_folder();
  write_file(folder / "one" / "0.png", encode_png(cv::Mat(48, 64, CV_8UC1, cv::Scalar(90))));
  const Outcome outcome = program("snapshot '{}' --view window --output '{}'",
                                  (folder / "one").string(),
                                  (folder / "a.png").string());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("Needs at least 2 frames; the recording has 1"));
}

TEST(Snapshot, OutputMustBePng) {
  expect_refused(snapshot("image", fresh_folder() / "a.bmp"), "ends in .png");
}

class Script : public testing::Test {
 protected:
  Outcome run(const std::string& lines, const std::string& arguments = "") {
    write_file(folder_ / "script.txt", lines);
    return program("snapshot --script '{}' {}", folder_ / "script.txt", arguments);
  }
  std::string in(const std::string& name) const { return (folder_ / name).string(); }
  cv::Mat image(const std::string& name) const { return read_image(in(name)); }

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
        {"set frames 1\n", "script.txt:1: frames: '1', expected a whole number from 2 to 1000"},
        {"open no/such/folder\n", "script.txt:1: no/such/folder"},
        {"frame 3\nmodel README.md\n", "script.txt:2: model: README.md: expected .obj, .ply"},
        {"export result no/such/a.json\n", "script.txt:1: no/such/a.json"}}) {
    SCOPED_TRACE(lines);
    expect_refused(run(lines, kDesk), message);
  }
  EXPECT_THAT(program("snapshot --script no/such/script").err, HasSubstr("no/such/script"));
}

TEST_F(Script, StopsAtASessionWhoseRecordingHasMoved) {
  ASSERT_EQ(run("save-session " + in("s.json") + "\n", kDesk).exit_code, 0);
  auto session = read_json(in("s.json"));
  session["recording"] = "/no/such/desk";
  write_file(in("moved.json"), session.dump());
  expect_refused(run("open " + in("moved.json") + "\nexport result " + in("r.json") + "\n", kDesk),
                 "script.txt:1: /no/such/desk has moved. Open it at its new location");
  EXPECT_FALSE(fs::exists(in("r.json")));
}

TEST_F(Script, ReportsWhyAShortWindowFails) {
  const Outcome outcome = run("set frames 8\nexport result " + in("a.json") + "\n",
                              GPO_SOURCE_DIR "/sequences/low-parallax.yaml");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto result = read_json(in("a.json"));
  EXPECT_EQ(result["status"], "failed");
  EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("of its distance from the plane"));
}

Outcome driven(const std::string& script, const std::string& arguments) {
  return shell("cd '{}' && '" GPO_SOURCE_DIR "/tests/with_display.sh' 1920x1080 '" GPO_SOURCE_DIR
               "/tests/app/{}' '" GPO_PROGRAM "' '{}' {}",
               fresh_folder(),
               script,
               kDesk,
               arguments);
}

class RealWindow : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* tool : {"Xvfb", "xdotool", "import"})
      if (shell(std::string("command -v ") + tool).exit_code != 0)
        GTEST_SKIP() << tool << " is not installed";
    if (!fs::exists(desk())) GTEST_SKIP() << "no bundled recording";
  }
};

TEST_F(RealWindow, ReactsToKeysAndExitsWithZero) {
  const Outcome outcome = driven("drive_window.sh", "");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
}

TEST_F(RealWindow, FollowsGermanAndFrenchKeyboardLayouts) {
  if (shell("command -v setxkbmap").exit_code != 0) GTEST_SKIP() << "setxkbmap is not installed";
  const Outcome outcome = driven("layouts_window.sh", "");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
}

TEST_F(RealWindow, FollowsATourByMouseAndKeyboard) {
  if (shell("/usr/bin/python3 -c 'import Xlib'").exit_code != 0)
    GTEST_SKIP() << "python3-xlib is not installed";
  const fs::path other = fs::path(GPO_TEST_OUTPUT_DIR) / "dropped";
  fs::copy(desk(), other, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  const Outcome outcome = driven("tour_window.sh", "'" + other.string() + "'");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
}

TEST_F(RealWindow, EndsAtTheFirstInvalidLineOfAScript) {
  const fs::path folder = fresh_folder();
  for (const auto& [line, message] :
       {std::pair{"fly", "script.txt:1: unknown command \"fly\""},
        {"frame 99", "script.txt:1: frame: 99 is outside of the recording"},
        {"open no/such/folder", "script.txt:1: no/such/folder"}}) {
    write_file(folder / "script.txt",
               fmt::format("{}\nscreenshot {}/after.png\nquit\n", line, folder));
    const Outcome outcome =
        shell("XDG_STATE_HOME={0} '" GPO_SOURCE_DIR "/tests/with_display.sh' 800x600 '" GPO_PROGRAM
              "' view '{1}' --script {0}/script.txt",
              folder,
              kDesk);
    expect_exit(2, outcome, message);
    EXPECT_FALSE(fs::exists(folder / "after.png")) << line;
  }
}

TEST(View, WithoutADisplayPointsToSnapshot) {
  const Outcome outcome = program("view {}", kDesk);
  expect_exit(2, outcome, "display");
  EXPECT_THAT(outcome.err, HasSubstr("snapshot"));
}

TEST(View, RefusesAMissingRecordingAsRunDoes) {
  for (const char* command : {"view", "run"})
    expect_refused(program("{} no/such/folder", command), "no/such/folder: no such file or folder");
}

}  // namespace
}  // namespace gpo::test
