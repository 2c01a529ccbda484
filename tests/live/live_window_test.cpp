// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/live/live_window.h"

#include "engine/inspection/inspector.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/live/sender.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr, testing::StartsWith;

std::shared_ptr<const Recording> desk() {
  return open_recording(fs::path(GPO_SOURCE_DIR) / "sequences" / "desk");
}

LiveOrigin origin_of(const Recording& recording) {
  return {.address = "desk",
          .device = "",
          .camera = LiveCamera{recording.camera, recording.camera_source, ""}};
}

LiveImage image_of(const Recording& recording, int frame) {
  return {recording.images->bgr(frame), recording.timestamps_ns[frame]};
}

bool ready(const Inspection& inspection) {
  const Initialization& found = *inspection.initialization;
  return found.ok && found.verdict->readiness == Readiness::ready;
}

TEST(LiveWindow, IsReadyAtTheSameFrameAsTheSavedBuffer) {
  const auto recording = desk();
  LiveWindow live(origin_of(*recording));
  std::optional<LiveAnswer> answer;
  int frame = 0;
  for (; frame < recording->frame_count() && (!answer || answer->task.ready_frames == 0); ++frame) {
    EXPECT_EQ(live.add(image_of(*recording, frame), Tracking::anchored), frame == 0);
    answer = inspect(live.task(), {});
    ASSERT_TRUE(answer);
    live.note(answer->task);
    EXPECT_EQ(answer->missing.empty(), answer->task.ready_frames > 0) << answer->missing;
  }
  ASSERT_GT(answer->task.ready_frames, 0);
  const LiveWindow::Frozen frozen = live.frozen();
  EXPECT_EQ(frozen.window, (FrameSpan{0, frame}));
  EXPECT_EQ(frozen.recording->layout, kLiveLayout);
  EXPECT_EQ(frozen.recording->timestamps_ns.front(), recording->timestamps_ns.front());
  Inspector inspector(frozen.recording);
  const auto at = [&](int frames) {
    Settings settings;
    settings.frames = frames;
    return inspector.inspect(settings);
  };
  const auto last = at(frame);
  EXPECT_TRUE(ready(*last));
  EXPECT_FALSE(ready(*at(frame - 1)));
  EXPECT_EQ(last->initialization->plane.normal, answer->inspection->initialization->plane.normal);
}

TEST(LiveWindow, FindsTheFirstReadyLengthAmongSkippedOnes) {
  const auto recording = desk();
  LiveWindow every(origin_of(*recording)), last(origin_of(*recording));
  int ready_frames = 0;
  for (int frame = 0; frame < 30; ++frame) {
    every.add(image_of(*recording, frame), Tracking::anchored);
    last.add(image_of(*recording, frame), Tracking::anchored);
    if (ready_frames == 0) ready_frames = inspect(every.task(), {})->task.ready_frames;
  }
  ASSERT_GT(ready_frames, 0);
  EXPECT_EQ(inspect(last.task(), {})->task.ready_frames, ready_frames);
}

TEST(LiveWindow, CountsReadyFramesAlsoAfterLeavingOutFrames) {
  const auto recording = desk();
  LiveWindow every(origin_of(*recording), {.most_frames = 12});
  LiveWindow last(origin_of(*recording), {.most_frames = 12});
  std::int64_t ready_ns = 0;
  for (int frame = 0; frame < 30; ++frame) {
    every.add(image_of(*recording, frame), Tracking::anchored);
    last.add(image_of(*recording, frame), Tracking::anchored);
    every.note(inspect(every.task(), {})->task);
    const LiveTask task = every.task();
    if (task.ready_frames == 0) continue;
    const auto& times_ns = task.recording->timestamps_ns;
    if (ready_ns == 0) ready_ns = times_ns[task.ready_frames - 1];
    EXPECT_GE(times_ns[task.ready_frames - 1], ready_ns) << frame;
    EXPECT_LT(times_ns[task.ready_frames - 2], ready_ns) << frame;
  }
  const LiveTask task = last.task();
  const int ready_frames = inspect(task, {})->task.ready_frames;
  ASSERT_GT(ready_frames, 1);
  EXPECT_LT(ready_frames, last.frames());
  Inspector inspector(task.recording, task.tracks);
  for (int frames = 2; frames <= ready_frames; ++frames) {
    Settings settings;
    settings.frames = frames;
    EXPECT_EQ(ready(*inspector.inspect(settings)), frames == ready_frames) << frames;
  }
}

TEST(LiveWindow, TakesAnswersFromBeforeFramesWereLeftOut) {
  const auto recording = desk();
  LiveWindow live(origin_of(*recording), {.most_frames = 8});
  for (int frame = 0; frame < 8; ++frame) live.add(image_of(*recording, frame), Tracking::anchored);
  const LiveTask early = inspect(live.task(), {})->task;
  ASSERT_EQ(early.solved, 8);
  ASSERT_GT(early.ready_frames, 0);
  live.add(image_of(*recording, 8), Tracking::anchored);
  live.note(early);
  EXPECT_EQ(live.task().solved, 4);
  EXPECT_EQ(live.task().ready_frames, early.ready_frames / 2 + 1);
}

TEST(LiveWindow, SaysWhatIsMissing) {
  const auto recording = desk();
  LiveWindow still(origin_of(*recording));
  for (int i = 0; i < 5; ++i) {
    LiveImage image = image_of(*recording, 0);
    image.timestamp_ns += i;
    still.add(image, Tracking::anchored);
  }
  EXPECT_THAT(inspect(still.task(), {})->missing, HasSubstr("move the camera sideways"));
  LiveWindow short_path(origin_of(*recording));
  for (int i = 0; i < 4; ++i) short_path.add(image_of(*recording, i), Tracking::anchored);
  EXPECT_THAT(inspect(short_path.task(), {})->missing, StartsWith("move sideways: baseline "));
}

TEST(LiveWindow, StartsAnewWhenTracksAreLost) {
  const auto recording = desk();
  LiveWindow live(origin_of(*recording));
  live.add(image_of(*recording, 0), Tracking::anchored);
  const cv::Size size = recording->images->bgr(0).size();
  live.start_anew();
  EXPECT_TRUE(live.add({recording->images->bgr(1), 1'000'000'000'000'000'001}, Tracking::anchored));
  EXPECT_EQ(live.why_anew(), "on request");
  live.add({cv::Mat::zeros(size, CV_8UC3), 1'000'000'000'000'000'002}, Tracking::anchored);
  EXPECT_TRUE(live.add({recording->images->bgr(2), 1'000'000'000'000'000'003}, Tracking::anchored));
  EXPECT_THAT(live.why_anew(), HasSubstr(" tracks are left"));
  EXPECT_EQ(live.frames(), 1);
}

TEST(LiveWindow, StaysBoundedAndKeepsItsReferenceFrame) {
  const auto recording = desk();
  LiveWindow live(origin_of(*recording), {.most_frames = 8});
  for (int frame = 0; frame < 30; ++frame) {
    live.add(image_of(*recording, frame), Tracking::anchored);
    EXPECT_LE(live.frames(), 8);
  }
  const LiveTask task = live.task();
  EXPECT_EQ(task.halvings, 8);
  EXPECT_EQ(task.recording->timestamps_ns.front(), recording->timestamps_ns.front());
  EXPECT_EQ(task.recording->timestamps_ns.back(), recording->timestamps_ns[29]);
  EXPECT_EQ(task.tracks->frame_count(), live.frames());
  EXPECT_TRUE(ready(*inspect(task, {})->inspection));
}

TEST(LiveWindow, FreezesItsWindowAlsoBeyondTheBuffer) {
  const auto recording = desk();
  LiveWindow live(origin_of(*recording), {.seconds = 0.5});
  for (int frame = 0; frame < 30; ++frame)
    live.add(image_of(*recording, frame), Tracking::anchored);
  const LiveWindow::Frozen frozen = live.frozen();
  EXPECT_EQ(frozen.window, (FrameSpan{0, 30}));
  EXPECT_EQ(frozen.recording->timestamps_ns,
            std::vector(recording->timestamps_ns.begin(), recording->timestamps_ns.begin() + 30));
  live.start_anew();
  live.add(image_of(*recording, 30), Tracking::anchored);
  const LiveWindow::Frozen later = live.frozen();
  const int last = later.recording->frame_count() - 1;
  EXPECT_EQ(later.window, (FrameSpan{last, 1}));
  const auto span_ns = later.recording->timestamps_ns[last] - later.recording->timestamps_ns[0];
  EXPECT_LE(span_ns, 500'000'000);
  EXPECT_GT(span_ns, 400'000'000);
}

TEST(LiveWindow, StartsAnewWhenTheSizeChanges) {
  const auto recording = desk();
  LiveWindow live(origin_of(*recording));
  live.add(image_of(*recording, 0), Tracking::anchored);
  live.add(image_of(*recording, 1), Tracking::anchored);
  LiveImage smaller = image_of(*recording, 2);
  smaller.bgr = smaller.bgr(cv::Rect(0, 0, 320, 240)).clone();
  smaller.segment = 1;
  EXPECT_TRUE(live.add(smaller, Tracking::anchored));
  EXPECT_EQ(live.why_anew(), "the size of the images changed");
  EXPECT_EQ(live.frames(), 1);
  EXPECT_EQ(live.frozen().recording->frame_count(), 1);
  EXPECT_EQ(live.frozen().recording->camera.width, 320);
  EXPECT_EQ(live.frozen().recording->camera_source, CameraSource::guess);
}

}  // namespace
}  // namespace gpo::test
