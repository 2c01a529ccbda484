// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/linked_selection.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

class MasksInTheImage : public LinkedSelection {
 protected:
  MasksInTheImage() { apply(state_, GoToFrame{kStart}); }
  ImageMapping mapping() const {
    return map_image(state_.document.recording->camera, image(), state_.view.image_zoom, false);
  }
  Vector2d on_image(double x, double y) const { return to_screen(mapping(), {x, y}); }
  std::string masks() const { return setting_text(state_.document.settings, "mask"); }
  void drag(const Vector2d& from, const Vector2d& to) {
    point_at(from);
    press(true);
    point_at(to);
    press(false);
    draw_times(2);
  }
};

TEST_F(MasksInTheImage, ADraggedRectangleLeavesOutItsTracksInOneUndoStep) {
  run_line(state_, "mask not");
  ASSERT_TRUE(state_.view.drawn_mask);
  drag(on_image(100, 50), on_image(300, 200));
  EXPECT_FALSE(state_.view.drawn_mask) << "one mask at a time";
  const Masks& drawn = state_.document.settings.mask;
  ASSERT_EQ(drawn.areas.size(), 1U);
  EXPECT_EQ(drawn.areas[0].kind, MaskKind::leave_out);
  EXPECT_LT((drawn.areas[0].corners_raw_px[0] - Vector2d(100, 50)).norm(), 2);
  EXPECT_LT((drawn.areas[0].corners_raw_px[1] - Vector2d(300, 200)).norm(), 2);
  EXPECT_THAT(state_.messages.text, HasSubstr("left out; Ctrl+Z undoes it"));
  EXPECT_EQ(state_.view.image_zoom.center, Vector2d(0.5, 0.5)) << "must not pan";
  EXPECT_TRUE(state_.selection.tracks.empty()) << "must not select";
  run_line(state_, "undo");
  EXPECT_EQ(masks(), "none");
  run_line(state_, "redo");
  EXPECT_NE(masks(), "none");
  run_line(state_, "mask off");
  EXPECT_EQ(masks(), "none");
  EXPECT_EQ(refusal(state_, "mask off"), "mask off: there are no masks");
}

TEST_F(MasksInTheImage, ClickedCornersMakeAPolygonThatTheFirstOneCloses) {
  apply(state_, GoToFrame{kFrame});
  run_line(state_, "mask plane");
  EXPECT_EQ(state_.view.frame, kStart) << "masks are drawn in the reference frame";
  draw_times(2);
  click(on_image(60, 60));
  click(on_image(400, 80));
  click(on_image(300, 300));
  EXPECT_EQ(state_.view.drawn_mask->corners_raw_px.size(), 3U);
  EXPECT_EQ(masks(), "none") << "not closed yet";
  click(on_image(60, 60));
  const Masks& drawn = state_.document.settings.mask;
  ASSERT_EQ(drawn.areas.size(), 1U);
  EXPECT_EQ(drawn.areas[0].kind, MaskKind::plane);
  EXPECT_EQ(drawn.areas[0].corners_raw_px.size(), 3U);
}

TEST_F(MasksInTheImage, EscapeCancelsAnUnfinishedMask) {
  run_line(state_, "mask not");
  click(on_image(60, 60));
  EXPECT_EQ(state_.view.drawn_mask->corners_raw_px.size(), 1U);
  close_next(state_);
  EXPECT_FALSE(state_.view.drawn_mask);
  click(on_image(60, 60));
  EXPECT_EQ(masks(), "none");
}

TEST_F(MasksInTheImage, UnfinishedMaskEndsWithItsReferenceFrame) {
  run_line(state_, "mask not");
  click(on_image(60, 60));
  run_line(state_, "start 2");
  EXPECT_FALSE(state_.view.drawn_mask);
}

TEST_F(MasksInTheImage, MenuOfTheImageOffersThem) {
  click(on_image(200, 100), 1);
  EXPECT_EQ(line_of_entry(ContextKind::area, "Leave out an area ..."), "mask not");
  EXPECT_EQ(line_of_entry(ContextKind::area, "Remove all masks"), "") << "there are none";
  run_line(state_, "mask not 10 20 110 90");
  EXPECT_EQ(line_of_entry(ContextKind::area, "Remove all masks"), "mask off");
}

TEST_F(MasksInTheImage, ScriptsAddMasksAndAreRefusedWithAReason) {
  run_line(state_, "mask not 10 20 110 90");
  run_line(state_, "mask plane 0 0 400 0 400 300");
  EXPECT_EQ(masks(), "not:10,20,110,90/plane:0,0,400,0,400,300");
  EXPECT_THAT(refusal(state_, "mask not 10 20"), HasSubstr("(a rectangle)"));
  EXPECT_THAT(refusal(state_, "mask not 10 20 30"), HasSubstr("mask not: expected a number"));
  EXPECT_THAT(refusal(state_, "mask not 10 20 10 90"), HasSubstr("an area of at least one pixel"));
}

TEST_F(MasksInTheImage, BelongToTheirFrameAndVanishWithANoteIfTheWindowStartsElsewhere) {
  run_line(state_, "mask not 10 20 110 90");
  const std::string drawn = masks();
  run_line(state_, fmt::format("set frames {}", state_.document.settings.frames - 1));
  EXPECT_EQ(masks(), drawn) << "the window starts with the same frame";
  run_line(state_, "set start 7");
  EXPECT_EQ(masks(), "none");
  EXPECT_EQ(state_.messages.text,
            "1 mask of frame 5 removed: the window starts elsewhere. Ctrl+Z restores both");
  run_line(state_, "undo");
  EXPECT_EQ(state_.document.settings.start, kStart);
  EXPECT_EQ(masks(), drawn);
}

TEST_F(MasksInTheImage, ReturnWhenADragEndsAtTheirFrame) {
  run_line(state_, "mask not 10 20 110 90");
  const std::string drawn = masks();
  for (const int start : {kStart + 1, kStart + 2, kStart}) {
    Settings dragged = state_.document.settings;
    dragged.start = start;
    apply(state_, ChangeSettings{dragged, true});
    EXPECT_EQ(masks(), start == kStart ? drawn : "none") << start;
  }
  run_line(state_, "undo");
  EXPECT_EQ(masks(), drawn);
  EXPECT_EQ(state_.document.undo.size(), 1U) << "the drag is one step";
}

TEST_F(MasksInTheImage, AreDrawnInTheReferenceFrameOnly) {
  const cv::Size size(640, 480);
  Inspection masked = *inspection_;
  masked.settings = with_setting(masked.settings, "mask", "plane:300,100,600,400");
  const auto changed = [&](int frame) {
    apply(state_, GoToFrame{frame});
    state_.results.inspection = inspection_;
    const cv::Mat before = view("picture", size);
    state_.results.inspection = std::make_shared<const Inspection>(masked);
    cv::Mat difference, gray;
    cv::absdiff(before, view("picture", size), difference);
    cv::extractChannel(difference, gray, 0);
    return cv::countNonZero(gray);
  };
  EXPECT_GT(changed(kStart), 500) << "outline and legend";
  EXPECT_EQ(changed(kFrame), 0);
}

}  // namespace
}  // namespace gpo::test
