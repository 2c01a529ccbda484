// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/workbench/work/worker_link.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::ElementsAre;

class CalibrationLinkTest : public test::WorkerLinkTest {};

TEST_F(CalibrationLinkTest, CalibrationKeepsFrameAndBookmarks) {
  open_and_settle("bare.mp4");
  apply(state_, GoToFrame{7});
  state_.document.bookmarks = {{7, "here"}};
  run_and_settle("calibrate");
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::self_calibrated);
  EXPECT_EQ(state_.view.frame, 7);
  EXPECT_THAT(state_.document.bookmarks, ElementsAre(Bookmark{7, "here"}));
  ASSERT_NE(state_.results.inspection, nullptr);
}

TEST_F(CalibrationLinkTest, CalibrationIsAcceptedOrDiscarded) {
  open_and_settle("bare.mp4");
  EXPECT_EQ(state_.results.calibration, nullptr);
  run_and_settle("calibrate");
  ASSERT_TRUE(state_.results.calibration);
  EXPECT_EQ(state_.results.calibration->report, "f 500 px");
  EXPECT_EQ(state_.view.panes.drawer, find_pane("camera"));
  run_and_settle("undo-calibration");
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::guess);
  EXPECT_EQ(state_.results.calibration, nullptr);
  run("undo-calibration");
  EXPECT_EQ(state_.messages.text, "no calibration is to be discarded");
  run_and_settle("calibrate");
  run_and_settle("accept-calibration");
  EXPECT_EQ(state_.results.calibration, nullptr);
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::self_calibrated);
}

TEST_F(CalibrationLinkTest, DoesNotRepeatADiscardedCalibration) {
  link_.calibrates = true;
  open_and_settle("bare.mp4");
  run_and_settle("undo-calibration");
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::guess);
}

TEST_F(CalibrationLinkTest, CanceledCalibrationKeepsTheGuessedCamera) {
  open_and_settle("bare.mp4");
  hold_ = true;
  run_once("calibrate");
  EXPECT_TRUE(link_.worker.busy);
  state_.requests.cancel = true;
  synchronize();
  EXPECT_EQ(state_.messages.text, "Calibration canceled, nothing was saved");
  hold_ = false;
  settle();
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::guess);
}

TEST_F(CalibrationLinkTest, CalibratesOpenedRecordingsWithGuessedCameraOnRequest) {
  link_.calibrates = true;
  open_and_settle("bare.mp4");
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::self_calibrated);
}

TEST_F(CalibrationLinkTest, RefusesToCalibrateWithoutImages) {
  open_and_settle("desk");
  run("calibrate");
  EXPECT_FALSE(state_.requests.calibrate);
  EXPECT_THAT(state_.messages.text, testing::HasSubstr("calibrate: the recording has no images"));
}

}  // namespace
}  // namespace gpo
