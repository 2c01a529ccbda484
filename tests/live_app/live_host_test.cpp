// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/live_host.h"

#include "app/recordings/recordings.h"
#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/test_folder.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/work/writers.h"
#include "ui/workbench_window.h"

#include <atomic>
#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

using testing::HasSubstr;

const std::shared_ptr<const Recording>& played() {
  static const auto recording = open_recording(GPO_SOURCE_DIR "/sequences/desk");
  return recording;
}

/// The workbench without its drawing. A source of the desk's images shows as many as are released.
class LiveHostTest : public testing::Test {
 protected:
  LiveHostTest() {
    state_.files.asks = true;
    link_.reader = std::make_unique<FileReader>();
    live_.hooks.source = [this](const std::string& address) {
      ++opened_;
      if (is_live_address(address) && !address.starts_with("udp://")) return SourceAddress{address};
      return SourceAddress{"sequences/desk", played()};
    };
    live_.hooks.camera_of = [](const SourceAddress& address, const std::string&, cv::Size) {
      return std::optional(LiveCamera{address.recording->camera, address.recording->camera_source});
    };
    live_.hooks.clock = {.now_ns = [this] { return kBegin_ns + later_ns_; },
                         .wait_until =
                             [this](std::int64_t time_ns, const std::stop_token& stop) {
                               while (time_ns > kBegin_ns + shown_ns_ && !stop.stop_requested())
                                 std::this_thread::sleep_for(std::chrono::milliseconds(1));
                             }};
  }
  ~LiveHostTest() override { shown_ns_ = std::numeric_limits<std::int64_t>::max() / 2; }

  void pump() {
    synchronize(state_, writer_);
    if (!live_.synchronize(state_, link_, worker_))
      synchronize(state_, link_, worker_, survey_, scan_);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  template <class Condition>
  void pump_until(const Condition& condition) {
    while (!condition()) pump();
  }
  /// Releases the images up to this one and waits until it is shown with its result.
  void show_until(int frame) {
    const auto& times_ns = played()->timestamps_ns;
    for (int i = std::max(0, shown_ + 1); i <= frame; ++i) {
      shown_ns_ = times_ns[i] - times_ns[0];
      pump_until([&] {
        return state_.live && state_.live->answer &&
               state_.live->answer->task.recording->timestamps_ns.back() == times_ns[i];
      });
      shown_ = i;
    }
  }
  void settle() {
    pump();
    pump_until([&] { return !link_.busy() && !writer_.busy(); });
    pump();
  }
  void open_live() {
    shown_ = -1;
    run_line(state_, "live udp://127.0.0.1:5000");
  }

  static constexpr std::int64_t kBegin_ns = 1'700'000'000'000'000'000;
  std::atomic<std::int64_t> shown_ns_ = 0;  ///< time up to which images are released
  std::atomic<std::int64_t> later_ns_ = 0;  ///< ahead of `kBegin_ns`
  int shown_ = -1;
  std::atomic<int> opened_ = 0;
  WorkbenchState state_;
  WorkerLink link_;
  Survey survey_;
  Scan scan_;
  RecordingWriter writer_;
  Worker worker_{[](const auto& path, const auto&...) {
    return Worker::with_inspector(open_recording(path));
  }};
  LiveHost live_{{}};
};

TEST_F(LiveHostTest, MeasuresTheDelayOfShownImages) {
  open_live();
  show_until(1);
  EXPECT_THAT(counts_text(*state_.live), Not(HasSubstr("shown after")));
  for (const std::int64_t late_ms : {40, 45, 300}) {
    later_ns_ += 1'000'000'000;
    show_until(shown_ + 1);
    later_ns_ += late_ms * 1'000'000;
    live_.note_shown(state_);
    later_ns_ += 999'000'000;
    live_.note_shown(state_);  // the same image
  }
  pump();
  EXPECT_THAT(counts_text(*state_.live), HasSubstr("0 dropped \u00b7 shown after 45 ms"));
}

TEST_F(LiveHostTest, IsDrawnIntoPicturesInFullDetail) {
  open_live();
  show_until(20);
  const cv::Size size(400, 300);
  const auto& inspection = state_.results.inspection;
  EXPECT_EQ(cv::norm(snapshot_live("scene", *state_.live, state_.document.settings, size),
                     snapshot_pane("scene", inspection, state_.view.frame, size),
                     cv::NORM_INF),
            0);
}

TEST_F(LiveHostTest, ShowsAGrowingWindowAndFreezesIt) {
  open_live();
  show_until(20);
  EXPECT_EQ(state_.frame_count(), 21);
  EXPECT_EQ(state_.view.frame, 20);
  EXPECT_EQ(state_.document.settings.frames, 21);
  EXPECT_THAT(counts_text(*state_.live), HasSubstr(" images \u00b7 0 dropped"));
  ASSERT_TRUE(state_.results.inspection);
  const Eigen::Vector3d normal = state_.results.inspection->initialization->plane.normal;
  run_line(state_, "freeze");
  settle();
  EXPECT_FALSE(state_.live);
  EXPECT_TRUE(is_frozen(state_));
  EXPECT_EQ(state_.frame_count(), 21);
  EXPECT_EQ(state_.document.settings.frames, 21);
  ASSERT_TRUE(state_.results.inspection);
  EXPECT_EQ(state_.results.inspection->initialization->plane.normal, normal);
  run_line(state_, "first");
  EXPECT_EQ(state_.view.frame, 0);
}

TEST_F(LiveHostTest, ContinuesAfterFreezing) {
  open_live();
  show_until(2);
  run_line(state_, "compute");
  pump();
  show_until(5);
  EXPECT_EQ(action_of_character(U' ', &state_)->name, "freeze");
  run_line(state_, "freeze");
  settle();
  EXPECT_EQ(action_of_character(U' ', &state_)->name, "freeze");
  shown_ = -1;
  shown_ns_ = 0;
  run_line(state_, "freeze");
  show_until(1);
  EXPECT_EQ(opened_, 2);
  EXPECT_EQ(state_.frame_count(), 2);
  EXPECT_THAT(state_.messages.text, testing::Not(HasSubstr("outside")));
}

TEST_F(LiveHostTest, ContinuesTheFrozenSourceAfterAnotherFailed) {
  open_live();
  show_until(1);
  run_line(state_, "freeze");
  settle();
  run_line(state_, "live camera:63");
  pump();
  pump_until([&] { return !state_.live; });
  EXPECT_TRUE(is_frozen(state_));
  EXPECT_EQ(state_.live_source, "udp://127.0.0.1:5000");
}

TEST_F(LiveHostTest, StartsAnewOnRequest) {
  open_live();
  show_until(3);
  run_line(state_, "compute");
  pump();
  show_until(4);
  EXPECT_EQ(state_.frame_count(), 1);
  EXPECT_THAT(progress_text(*state_.live), HasSubstr("(new window: on request)"));
}

TEST_F(LiveHostTest, ReportsAMissingCameraInOneLine) {
  run_line(state_, "open " GPO_SOURCE_DIR "/sequences/desk");
  settle();
  const auto before = state_.document.recording;
  ASSERT_TRUE(before);
  run_line(state_, "live camera:63");
  pump();
  pump_until([&] { return !state_.live; });
  EXPECT_THAT(state_.messages.text, HasSubstr("camera:63: no such camera"));
  EXPECT_EQ(state_.messages.severity, Severity::error);
  EXPECT_EQ(state_.document.recording, before);
  settle();
  run_line(state_, "first");
  EXPECT_EQ(state_.view.frame, 0);
}

TEST_F(LiveHostTest, FreezesWhenTheSourceEnds) {
  open_live();
  show_until(1);
  shown_ns_ = 3'600'000'000'000;
  pump_until([&] { return !state_.live; });
  settle();
  EXPECT_THAT(state_.messages.text, HasSubstr("sequences/desk: ended after "));
  EXPECT_THAT(state_.messages.text, HasSubstr(". Frozen: "));
  EXPECT_TRUE(is_frozen(state_));
}

TEST_F(LiveHostTest, PlaysAVideoThatEnded) {
  state_.requests.live = "desk.mp4";
  show_until(1);
  shown_ns_ = 3'600'000'000'000;
  pump_until([&] { return !state_.live; });
  settle();
  EXPECT_THAT(state_.messages.text, HasSubstr(". Space plays, save-recording"));
  EXPECT_EQ(action_of_character(U' ', &state_)->name, "play");
}

TEST_F(LiveHostTest, OpensARecordingInPlaceOfTheSource) {
  open_live();
  show_until(1);
  run_line(state_, "open " GPO_SOURCE_DIR "/sequences/desk");
  pump_until([&] {
    return state_.document.recording && state_.document.recording->layout != kLiveLayout;
  });
  settle();
  EXPECT_FALSE(state_.live);
  EXPECT_FALSE(is_frozen(state_));
  EXPECT_EQ(action_of_character(U' ', &state_)->name, "play");
}

TEST_F(LiveHostTest, SavesWhatWasFrozenWithItsTimes) {
  const TestFolder folder;
  open_live();
  show_until(3);
  const std::string line = "save-recording " + (folder.path() / "saved.mcap").string();
  EXPECT_THROW(run_line(state_, line), InputError) << "while it is live";
  run_line(state_, "freeze");
  settle();
  EXPECT_THROW(run_line(state_, "save-session a.json"), InputError);
  run_line(state_, line);
  settle();
  EXPECT_EQ(state_.messages.text, "saved " + (folder.path() / "saved.mcap").string());
  run_line(state_, line);
  settle();
  EXPECT_THAT(state_.messages.text, HasSubstr("saved.mcap"));
  EXPECT_EQ(state_.messages.severity, Severity::error) << "it exists";
  const auto saved = open_recording(folder.path() / "saved.mcap");
  EXPECT_EQ(saved->timestamps_ns, state_.document.recording->timestamps_ns);
}

/// Returns frames of the desk in half size, which take less time to calibrate, as if frozen.
Recording small_frozen() {
  Recording frozen = *played();
  const auto images = frozen.images;
  frozen.images = std::make_shared<const FrameCache>(frozen.frame_count(), [images](int frame) {
    cv::Mat half;
    cv::resize(images->bgr(frame), half, {}, 0.5, 0.5, cv::INTER_AREA);
    return half;
  });
  frozen.camera = camera_of_view(frozen.camera.width / 2, frozen.camera.height / 2);
  frozen.camera_source = CameraSource::self_calibrated;
  frozen.gyroscope.reset();
  frozen.layout = kLiveLayout;
  frozen.name = "camera:0";
  return frozen;
}

TEST(LiveCalibration, IsDiscardedFromTheCacheOfItsDevice) {
  const TestFolder folder;
  setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
  const auto frozen = std::make_shared<const Recording>(small_frozen());
  const std::string key =
      fmt::format("camera:0 {}x{}", frozen->camera.width, frozen->camera.height);
  const std::string earlier = "# of another day\n";
  const auto file =
      folder.write(fmt::format("gpo-inspector/cameras/live-{:016x}.yaml", fnv1a(key)), earlier);
  const auto opened = opened_for_window(frozen);
  const auto calibrated = opened.calibrate({}, [](const std::string&, int, int) {});
  EXPECT_NE(read_file(file), earlier);
  calibrated.undo_calibration();
  EXPECT_EQ(read_file(file), earlier);
}

TEST_F(LiveHostTest, OpensNothingForScripts) {
  state_.files.asks = false;
  EXPECT_THROW(run_line(state_, "live camera:0"), InputError);
  EXPECT_THROW(run_line(state_, "live"), InputError);
  EXPECT_THROW(run_line(state_, "freeze"), InputError);
  state_.files.asks = true;
  EXPECT_THROW(run_line(state_, "live a.mp4"), InputError);
  live_.hooks.source = nullptr;
  run_line(state_, "live camera:0");
  pump();
  EXPECT_THAT(state_.messages.text, HasSubstr("camera:0: only a user at the window opens"));
  EXPECT_EQ(opened_, 0);
}

}  // namespace
}  // namespace gpo::test
