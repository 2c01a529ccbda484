// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/window_test.h"

#include <gmock/gmock.h>
#include <imgui_internal.h>

namespace gpo {
namespace {

using test::refusal, test::run_lines, testing::ElementsAre, testing::HasSubstr;

const Finding kDoubt{.key = "implausible-intrinsics",
                     .level = Level::weak,
                     .sentence = "the principal point is at 0 % of the width",
                     .advice = "check the order of the numbers",
                     .command = "set intrinsics_scale 0.75",
                     .view = "camera"};

Inspection with_findings(std::vector<Finding> findings) {
  Inspection inspection = made_inspection({.normal_sigma_deg = 0.3});
  inspection.findings = std::move(findings);
  return inspection;
}

std::vector<std::string> words_of(const Inspection& inspection) {
  std::vector<std::string> words;
  for (const FindingRow& row : finding_rows(&inspection))
    words.push_back(row.finding.key + " " + row.word);
  return words;
}

TEST(FindingRows, HaveLevelsAndNameIgnoredOnes) {
  EXPECT_TRUE(finding_rows(nullptr).empty());
  Finding ignored = kDoubt;
  ignored.level = Level::note;
  ignored.ignored = true;
  const Inspection inspection = with_findings({{.key = "rotation-only", .level = Level::degenerate},
                                               kDoubt,
                                               {.key = "truth-jump"},
                                               ignored});
  EXPECT_THAT(words_of(inspection),
              ElementsAre("rotation-only degenerate",
                          "implausible-intrinsics weak",
                          "truth-jump note",
                          "implausible-intrinsics ignored"));
  const auto rows = finding_rows(&inspection);
  EXPECT_EQ(rows[0].color, Role::bad);
  EXPECT_EQ(rows[1].color, Role::warning);
  EXPECT_EQ(rows[3].color, Role::text_dim);
  EXPECT_FALSE(rows[0].may_be_ignored);
  EXPECT_TRUE(rows[1].may_be_ignored);
  EXPECT_EQ(rows[0].title, "Rotations alone explain the images");
  EXPECT_TRUE(is_said_by(rows, kDoubt.sentence + ": " + kDoubt.advice));
  EXPECT_FALSE(is_said_by(rows, "normal uncertainty 0.30 deg (1 sigma)"));
}

class FindingActions : public testing::Test {
 protected:
  FindingActions() {
    Inspection inspection = with_findings({kDoubt});
    const auto& ids = inspection.tracks->ids;
    inspection.findings.push_back({.key = "truth-jump",
                                   .tracks = {ids[7], ids[2], -5},
                                   .frames = {inspection.window->start + 4},
                                   .view = "residuals"});
    inspection_ = std::make_shared<const Inspection>(std::move(inspection));
    test::open(state_, inspection_);
  }

  WorkbenchState state_;
  std::shared_ptr<const Inspection> inspection_;
};

TEST_F(FindingActions, ShowTracksFrameAndPane) {
  state_.view.panes.compare = true;
  run_line(state_, "finding truth-jump");
  const auto& ids = inspection_->tracks->ids;
  EXPECT_THAT(state_.selection.tracks, ElementsAre(ids[2], ids[7])) << "those of the window";
  EXPECT_EQ(state_.view.frame, inspection_->window->start + 4);
  EXPECT_EQ(state_.view.panes.drawer, find_pane("residuals"));
  EXPECT_TRUE(state_.view.panes.compare) << "a drawer does not hide it";
  run_line(state_, "finding implausible-intrinsics");
  EXPECT_EQ(state_.selection.tracks.size(), 2U) << "a finding without tracks selects none";
  EXPECT_EQ(state_.view.panes.drawer, find_pane("camera"));
  Inspection other = *inspection_;
  other.findings[0].view = "image";
  state_.results.inspection = std::make_shared<const Inspection>(other);
  state_.view.division.maximized = WindowPart::drawer;
  run_line(state_, "finding implausible-intrinsics");
  EXPECT_FALSE(state_.view.panes.compare);
  EXPECT_EQ(state_.view.division.maximized, WindowPart::none);
}

TEST_F(FindingActions, AreRefusedWithTheKnownKeys) {
  EXPECT_EQ(refusal(state_, "finding nothing"),
            "finding: no finding 'nothing', expected one of implausible-intrinsics, truth-jump");
  EXPECT_EQ(refusal(state_, "run-finding truth-jump"), "run-finding: 'truth-jump' has no command");
  EXPECT_THAT(refusal(state_, "ignore-finding rotation-only"), HasSubstr("cannot ignore"));
  EXPECT_THAT(refusal(state_, "ignore-finding nothing"), HasSubstr("unknown finding"));
  state_.results.inspection = std::make_shared<const Inspection>(with_findings({}));
  EXPECT_EQ(refusal(state_, "finding truth-jump"), "finding: there are no findings");
  state_.results.inspection.reset();
  EXPECT_EQ(refusal(state_, "finding truth-jump"), "finding: no result yet");
}

TEST_F(FindingActions, RunTheCommandAndUndoIt) {
  run_line(state_, "run-finding implausible-intrinsics");
  EXPECT_EQ(state_.document.settings.intrinsics_scale, 0.75);
  run_line(state_, "undo");
  EXPECT_EQ(state_.document.settings.intrinsics_scale, 1);
}

TEST_F(FindingActions, IgnoreAndCountAgain) {
  const auto& ignored = state_.document.settings.options.ignore_findings;
  run_line(state_, "ignore-finding unstable-method");
  run_line(state_, "ignore-finding implausible-intrinsics on");
  run_line(state_, "ignore-finding implausible-intrinsics on");
  EXPECT_THAT(ignored, ElementsAre("implausible-intrinsics", "unstable-method"));
  run_line(state_, "ignore-finding unstable-method off");
  EXPECT_THAT(ignored, ElementsAre("implausible-intrinsics"));
  run_lines(state_, "undo; undo; undo");
  EXPECT_TRUE(ignored.empty());
}

class FindingsGroup : public test::WindowTest {
 protected:
  FindingsGroup() { applies_ = true; }
  void open(std::vector<Finding> findings) {
    WindowTest::open(with_findings(std::move(findings)));
    draw_times(3);
  }
  static const ImGuiWindow& panel() { return *ImGui::FindWindowByName("verdict"); }
  /// Returns the lines of all actions that clicks down the panel run, each once.
  std::vector<std::string> lines_of_clicks(float x) {
    applies_ = false;
    std::vector<std::string> lines;
    const Rectangle place = layout().verdict;
    for (float y = place.y + 4; y < place.bottom(); y += 4) {
      const std::string line = test::line_of(click(x, y));
      if (!line.empty() && (lines.empty() || lines.back() != line)) lines.push_back(line);
    }
    applies_ = true;
    return lines;
  }
};

TEST_F(FindingsGroup, IsAbsentWithoutFindings) {
  open({});
  const float height = panel().ContentSize.y;
  open({kDoubt});
  EXPECT_GT(panel().ContentSize.y, height + 4 * ImGui::GetFontSize());
  keep("findings", context_.read_bgr());
}

TEST_F(FindingsGroup, RowsAndButtonsRunCommands) {
  open({kDoubt});
  EXPECT_THAT(lines_of_clicks(40),
              ElementsAre("finding implausible-intrinsics", "run-finding implausible-intrinsics"));
  Finding ignored = kDoubt;
  ignored.level = Level::note;
  ignored.ignored = true;
  ignored.command.clear();
  open({ignored});
  EXPECT_THAT(
      lines_of_clicks(40),
      ElementsAre("finding implausible-intrinsics", "ignore-finding implausible-intrinsics off"));
}

TEST_F(FindingsGroup, WrapsLongSentencesAndScrolls) {
  Finding long_one = kDoubt;
  for (int i = 0; i < 60; ++i) long_one.sentence += " and more words";
  open({long_one});
  EXPECT_LE(panel().ContentSize.x, panel().WorkRect.GetWidth() + 1) << "no text ends outside";
  EXPECT_GT(panel().ScrollMax.y, 0);
  EXPECT_GE(layout().settings.height, 80);
}

TEST_F(FindingsGroup, PointingAtARowHighlightsItsTracks) {
  Finding finding = kDoubt;
  const Inspection inspection = made_inspection();
  finding.tracks = {inspection.tracks->ids[2], inspection.tracks->ids[7]};
  open({finding});
  EXPECT_TRUE(highlight_of(state_).picked.empty());
  point_at(40, layout().verdict.bottom() - 40);
  EXPECT_EQ(state_.hover.finding, finding.key);
  EXPECT_THAT(highlight_of(state_).picked, ElementsAre(2, 7));
  EXPECT_TRUE(state_.selection.tracks.empty());
  point_at(40, layout().settings.y + 40);
  EXPECT_TRUE(highlight_of(state_).picked.empty());
}

TEST_F(FindingsGroup, SecondMatchOfASelectedTrackIsAnArrowInTheReferenceFrame) {
  Inspection inspection = with_findings({});
  const int column = 40;
  const Eigen::Vector2d period_px(60, 45);
  Tracks tracks = *inspection.tracks;
  tracks.repetition =
      Repetition{period_px.replicate(1, tracks.track_count()), std::vector(30, 0.0)};
  inspection.findings = {{.key = "repeated-texture",
                          .level = Level::weak,
                          .tracks = {tracks.ids[column]},
                          .frames = {tracks.start, tracks.start + 3},
                          .view = "image"}};
  inspection.tracks = std::make_shared<const Tracks>(tracks);
  state_.view.toggles.tracks = state_.view.toggles.legend = false;
  WindowTest::open(inspection);
  const auto colored = [&](double share) {
    draw_times(3);
    const Eigen::Vector2d at =
        to_screen(map_image(inspection.recording->camera, screen_rect(layout().image), {}, false),
                  tracks.raw_px[0].col(column) + share * period_px);
    const cv::Rect around(static_cast<int>(at.x()) - 8, static_cast<int>(at.y()) - 8, 17, 17);
    return count_pixels(context_.read_bgr()(around), color_of(Role::warning), 70);
  };
  EXPECT_EQ(colored(1), 0);
  run_line(state_, "finding repeated-texture");
  EXPECT_GT(colored(0.5), 0);
  EXPECT_GT(3 * colored(1), 2 * colored(0.5)) << "the head beside half of the line";
  EXPECT_EQ(colored(1.5), 0);
  run_line(state_, "frame " + std::to_string(tracks.start + 3));
  EXPECT_EQ(colored(0.5), 0);
}

TEST_F(FindingsGroup, DoubtfulPrincipalPointIsACrossInTheImage) {
  const auto colored = [&](std::vector<Finding> findings) {
    open(std::move(findings));
    return count_pixels(view("image", cv::Size(640, 480)), color_of(Role::warning));
  };
  const int without = colored({});
  EXPECT_GT(colored({kDoubt}), without + 60);
  Finding ignored = kDoubt;
  ignored.ignored = true;
  EXPECT_EQ(colored({ignored}), without);
}

}  // namespace
}  // namespace gpo
