// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/live_session.h"

#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/recording/layouts/write_recording.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Length of a window up to which the reason for its start is shown.
constexpr int kFramesAfterStart = 20;

/// Makes a window of a live source that of the settings, also after `undo`.
void fit_to_live(Document& document, int frames) {
  const auto fit = [frames](UndoStep& step) {
    step.settings.start = 0;
    step.settings.frames = frames;
  };
  fit(document);
  std::ranges::for_each(document.undo, fit);
  std::ranges::for_each(document.redo, fit);
}

}  // namespace

LiveSession::LiveSession(SourceAddress address,
                         const LiveSessionOptions& options,
                         const std::function<void()>& changed)
    : address_(std::move(address)),
      camera_of_(options.camera_of),
      changed_(changed),
      capture_(address_, options.capture, changed),
      window_({.address = address_.text, .device = ""}, options.window),
      job_([this] { return next(); }, changed) {
  tracker_ = std::jthread([this](const std::stop_token& stop) { track(stop); });
}

LiveSession::~LiveSession() = default;

void LiveSession::want(const Settings& settings) {
  const auto lock = job_.lock();
  settings_ = settings;
}

void LiveSession::start_anew() {
  const auto lock = job_.lock();
  anew_ = true;
}

LiveView LiveSession::view() const {
  const CaptureStatus capture = capture_.status();
  const auto lock = job_.lock();
  LiveView view = view_;
  view.address = address_.text;
  view.capture = capture;
  if (!error_.empty()) {
    view.capture.message = error_;
  } else if (const std::string error = job_.status().error; !error.empty()) {
    view.capture.message = error;
  }
  return view;
}

void LiveSession::track(const std::stop_token& stop) {
  try {
    while (const auto image = capture_.take(stop)) add(*image);
  } catch (const std::exception& error) {
    const auto lock = job_.lock();
    error_ = message_of(error);
  }
  if (changed_) changed_();
}

void LiveSession::add(const LiveImage& image) {
  Tracking tracking;
  bool anew;
  {
    const auto lock = job_.lock();
    tracking = settings_.tracking;
    anew = std::exchange(anew_, false);
  }
  const std::lock_guard alone(tracking_mutex_);
  if (image.bgr.size() != size_) {
    size_ = image.bgr.size();
    const std::string device = capture_.status().device;
    window_.set_origin({.address = address_.text,
                        .device = device,
                        .camera = camera_of_ ? camera_of_(address_, device, size_) : std::nullopt});
  }
  if (anew) window_.start_anew();
  const bool began = window_.add(image, tracking);
  LiveTask task = window_.task();
  const auto lock = job_.lock();
  if (began) {
    job_.cancel();
    view_.why_anew = window_.why_anew();
  }
  task_ = std::move(task);
  job_.wake();
}

BackgroundJob::Job LiveSession::next() {
  if (!task_) return nullptr;
  return
      [this, task = *std::exchange(task_, {}), settings = settings_](const std::stop_token& stop) {
        auto answer = inspect(task, settings, stop);
        if (!answer) return;
        // So that the window draws the image without waiting for it.
        answer->task.recording->images->bgr(answer->task.recording->frame_count() - 1);
        {
          const std::lock_guard alone(tracking_mutex_);
          window_.note(answer->task);
        }
        job_.publish(
            stop, [&] { view_.answer = std::make_shared<const LiveAnswer>(std::move(*answer)); });
      };
}

std::optional<LiveWindow::Frozen> LiveSession::freeze() {
  tracker_.request_stop();
  if (tracker_.joinable()) tracker_.join();
  const std::lock_guard alone(tracking_mutex_);
  if (window_.frames() == 0) return std::nullopt;
  return window_.frozen();
}

void replace_recording(WorkbenchState& state, const FrameSpan& window) {
  Document& document = state.document;
  if (document.recording && document.recording->layout != kLiveLayout)
    document.earlier[document.recording->path] = document.settings;
  document.recording.reset();
  document.settings.start = window.start;
  document.settings.frames = window.frames;
}

void show_live(WorkbenchState& state, const LiveView& view) {
  const bool shown = state.live && state.live->answer;
  const int window_before = shown ? state.live->answer->task.window : 0;
  state.live = view;
  if (view.answer && view.answer->task.recording != state.document.recording) {
    const auto& recording = view.answer->task.recording;
    if (window_before == 0) {
      replace_recording(state, {0, recording->frame_count()});
      apply_recording(state, recording);
    }
    if (view.answer->task.window != window_before) {
      state.selection = {};
      state.hover = {};
    }
    state.document.recording = recording;
    state.results.inspection =
        with_cube(view.answer->inspection, state.document.cube_ray, state.document.other_cube_rays);
    state.view.frame = recording->frame_count() - 1;
    state.view.time_span = {};
  }
  if (view.answer) fit_to_live(state.document, state.frame_count());
}

std::string progress_text(const LiveView& view) {
  if (!view.capture.message.empty()) return view.capture.message;
  if (!view.answer) return "waiting for an image";
  const LiveTask& task = view.answer->task;
  const std::string& missing = view.answer->missing;
  std::string text =
      missing.empty() ? "ready from " + counted(task.ready_frames, "frame") + " on" : missing;
  if (task.window > 1 && task.recording->frame_count() < kFramesAfterStart)
    text += fmt::format(" (new window: {})", view.why_anew);
  return text;
}

std::string counts_text(const LiveView& view) {
  const CaptureStatus& capture = view.capture;
  if (capture.size.empty()) return "";
  std::string text = fmt::format("{}x{} \u00b7 {} \u00b7 {} dropped",
                                 capture.size.width,
                                 capture.size.height,
                                 counted(capture.captured, "image"),
                                 capture.dropped);
  if (capture.broken > 0) text += fmt::format(", {} damaged", capture.broken);
  if (view.delay_s) text += fmt::format(" \u00b7 shown after {:.0f} ms", 1e3 * *view.delay_s);
  return text;
}

}  // namespace gpo
