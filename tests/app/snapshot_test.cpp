// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

using testing::HasSubstr;

Outcome snapshot(const std::string& view, const fs::path& output, const std::string& more = "") {
  return program("snapshot {} --view {} --output {} {}", kDesk, view, output, more);
}

/// Compares the view of the image with a baseline.
Outcome compared(const fs::path& output, const fs::path& baseline, const std::string& more = "") {
  return snapshot("image", output, fmt::format("--baseline {} {}", baseline, more));
}

/// The baseline of a view, of this suite if it has its own. Debian 13 needs some: its Mesa and Dear
/// ImGui draw round points and small circles differently, which is a fifth of a percent of the
/// pixels.
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
  EXPECT_FALSE(cv::imread(file).empty());
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
  EXPECT_EQ(cv::imread(file).size(), cv::Size(1000, 600));
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
  cv::imwrite(folder / "brighter.png", cv::imread(folder / "a.png") + cv::Scalar::all(5));
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
  cv::imwrite(folder / "base.png", cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(9)));
  const Outcome outcome = compared(folder / "a.png", folder / "base.png");
  expect_exit(1, outcome, "the baseline is 320x240, the image 640x480");
  EXPECT_EQ(outcome.out.find("pixels that differ"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("diff.png"), std::string::npos) << outcome.out;  // not written
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
       {"--view compare --frame 60", "--frame: 60 is not in the recording"},
       {"--view image --baseline no.png", "--baseline: cannot decode no.png as an image"}});
}

TEST(Snapshot, OutputMustBePng) {
  expect_refused(snapshot("image", fresh_folder() / "a.bmp"), "ends in .png");
}

}  // namespace
}  // namespace gpo::test
