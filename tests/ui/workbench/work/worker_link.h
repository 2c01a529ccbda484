// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/error.h"
#include "tests/engine/desk.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/work/worker.h"

#include <atomic>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

namespace gpo::test {

/// The worker only records the requested starts. While `hold_`, its jobs last until stopped, and
/// the recording "slow" is not open.
class WorkerLinkTest : public testing::Test {
 protected:
  WorkerLinkTest() { link_.example = "example"; }
  Worker::Opened open(const std::filesystem::path& path) {
    if (path.filename() == "bad") throw InputError("bad: no such folder");
    while (path.filename() == "slow" && hold_) std::this_thread::yield();
    auto recording = std::make_shared<Recording>();
    if (path == "pictures") *recording = *desk();
    recording->name = path.string();
    if (path == "pictures") return opened(recording);
    for (int i = 0; i < 60; ++i) recording->timestamps_ns.push_back(i * 33'000'000);
    if (path == "long.mkv") return first_frames(recording);
    if (path == "bare.mp4") {
      recording->camera_source = CameraSource::guess;
      recording->images = std::make_shared<const FrameCache>(60, [](int) { return cv::Mat(); });
    }
    return opened(recording);
  }
  /// The first 60 of 900 frames.
  Worker::Opened first_frames(const std::shared_ptr<Recording>& recording) {
    recording->path = "long.mkv";
    recording->complete = false;
    Worker::Opened first = opened(recording);
    first.rest = [this, recording](const std::stop_token& stop, const Progress&) {
      hold(stop);
      auto whole = std::make_shared<Recording>(*recording);
      whole->complete = true;
      for (int i = 60; i < 900; ++i) whole->timestamps_ns.push_back(i * std::int64_t{33'000'000});
      return opened(whole);
    };
    return first;
  }
  Worker::Opened opened(const std::shared_ptr<Recording>& recording) {
    return {
        recording,
        [this, recording](const Settings& settings, const std::stop_token& stop, const Progress&) {
          {
            const std::lock_guard lock(mutex_);
            starts_.push_back(settings.start);
          }
          hold(stop);
          auto inspection = std::make_shared<Inspection>();
          inspection->recording = recording;
          inspection->settings = settings;
          return inspection;
        },
        [this, recording](const std::stop_token& stop, const Progress&) {
          hold(stop);
          if (stop.stop_requested()) return Worker::Opened{};
          Worker::Opened opened = open("desk");
          auto calibrated = std::make_shared<Recording>(*recording);
          calibrated->camera_source = CameraSource::self_calibrated;
          opened.recording = calibrated;
          opened.calibration =
              std::make_shared<const CalibrationResult>(CalibrationResult{recording, "f 500 px"});
          opened.undo_calibration = [this, recording] { return this->opened(recording); };
          return opened;
        }};
  }
  void hold(const std::stop_token& stop) {
    while (hold_ && !stop.stop_requested()) std::this_thread::yield();
  }
  void synchronize() { gpo::synchronize(state_, link_, worker_, survey_, scan_); }
  void run(const char* action) { apply(state_, RunAction{action}); }
  void run_once(const char* action) {
    run(action);
    synchronize();
  }
  void run_and_settle(const char* action) {
    run(action);
    settle();
  }
  void open_and_settle(const std::filesystem::path& path) {
    apply(state_, OpenPath{path});
    settle();
  }
  void settle() {
    do {
      synchronize();
    } while (link_.worker.busy || link_.reading.busy);
    synchronize();
  }
  std::vector<int> starts() {
    const std::lock_guard lock(mutex_);
    return starts_;
  }

  std::atomic<bool> hold_ = false;
  std::mutex mutex_;
  std::vector<int> starts_;
  WorkbenchState state_;
  WorkerLink link_;
  Survey survey_;
  Scan scan_;
  Worker worker_{[this](const std::filesystem::path& path, const auto&...) { return open(path); }};
};

}  // namespace gpo::test
