// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/live_host.h"

#include "engine/base/error.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/live/sources.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Time for which a source that broke off is connected again.
constexpr double kGiveUp_s = 60;

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

/// Returns whether something was requested that ends the display of live images.
bool ends_live(WorkbenchState& state) {
  const bool freezes = std::exchange(state.requests.freeze, false);
  const bool plays = std::exchange(state.view.playing, false);
  const bool cancels = std::exchange(state.requests.cancel, false);
  return freezes || plays || cancels || state.requests.open || state.requests.open_example;
}

/// Refuses requests that need the images at rest.
void refuse_while_live(WorkbenchState& state) {
  const bool calibrates = std::exchange(state.requests.calibrate, false);
  const bool finds_start = std::exchange(state.requests.find_start, false);
  if (calibrates || finds_start)
    say(state, "Freeze the images with Space first", Severity::warning);
}

/// Closes the open recording, whose settings are kept for the next time, and sets the window of the
/// one that is shown next.
void replace_recording(WorkbenchState& state, const FrameSpan& window) {
  Document& document = state.document;
  if (document.recording && document.recording->layout != kLiveLayout)
    document.earlier[document.recording->path] = document.settings;
  document.recording.reset();
  document.settings.start = window.start;
  document.settings.frames = window.frames;
}

}  // namespace

LiveSession::LiveSession(SourceAddress address,
                         const LiveHooks& hooks,
                         double seconds,
                         const std::function<void()>& changed)
    : address_(std::move(address)),
      camera_of_(hooks.camera_of),
      changed_(changed),
      capture_(address_, {.give_up_s = kGiveUp_s, .clock = hooks.clock}, changed),
      window_({.address = address_.text, .device = ""}, {.seconds = seconds}),
      job_([this] { return next(); }, changed) {
  tracker_ = std::jthread([this](const std::stop_token& stop) { track(stop); });
}

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

bool LiveHost::synchronize(WorkbenchState& state, WorkerLink& link, Worker& worker) {
  if (const auto address = std::exchange(state.requests.live, {}))
    open(state, link, worker, *address);
  if (!session_) {
    state.requests.freeze = false;
    report_frozen(state);
    return waits_for_frozen(state, worker);
  }
  LiveView view = session_->view();
  if (!delays_s_.empty()) view.delay_s = median({delays_s_.begin(), delays_s_.end()});
  show_live(state, view);
  if (ends_live(state) || view.capture.is_over()) {
    freeze(state, link, worker);
    return waits_for_frozen(state, worker);
  }
  if (std::exchange(state.requests.compute, false)) session_->start_anew();
  refuse_while_live(state);
  session_->want(state.document.settings);
  return true;
}

void LiveHost::note_shown(const WorkbenchState& state) {
  constexpr std::size_t kMost = 61;
  if (!state.live || !state.live->answer) return;
  const std::int64_t arrived_ns = state.live->answer->task.arrived_ns;
  if (std::exchange(noted_ns_, arrived_ns) == arrived_ns) return;
  delays_s_.push_back(1e-9 * static_cast<double>(hooks.clock.now_ns() - arrived_ns));
  if (delays_s_.size() > kMost) delays_s_.pop_front();
}

void LiveHost::open(WorkbenchState& state,
                    WorkerLink& link,
                    Worker& worker,
                    const std::string& address) {
  try {
    if (!hooks.source)
      throw InputError(address + ": only a user at the window opens cameras and streams");
    const SourceAddress source = hooks.source(address);
    if (source.recording && !source.recording->images)
      throw InputError(address + ": has no images to play");
    session_.reset();
    state.live.reset();
    worker.cancel(state.document.recording);
    link.worker = link.survey = link.scan = {};
    link.loading = link.calibrating = link.finding_start = false;
    frozen_.reset();
    reported_.reset();
    delays_s_.clear();
    session_ =
        std::make_unique<LiveSession>(source, hooks, state.view.toggles.live_seconds, changed_);
    state.view.playing = false;
    address_ = address;
  } catch (const InputError& error) {
    say(state, error.what(), Severity::error);
  }
}

/// Makes the last seconds of the live source an ordinary recording.
void LiveHost::freeze(WorkbenchState& state, WorkerLink& link, Worker& worker) {
  const auto frozen = session_->freeze();
  const LiveView last = session_->view();
  session_.reset();
  state.live.reset();
  end_ = last.capture;
  // A video that ended has nothing to continue with; Space plays what is frozen.
  const bool over = end_.state == CaptureState::ended && !is_live_address(address_);
  if (frozen) state.live_source = over ? "" : address_;
  if (!end_.is_over()) end_.message.clear();
  if (!frozen) {
    const bool failed = end_.state == CaptureState::failed;
    const std::string none = last.address + ": there was no image yet";
    return say(state,
               end_.message.empty() ? none : end_.message,
               failed ? Severity::error : Severity::warning);
  }
  window_ = frozen->window;
  frozen_ = reported_ = frozen->recording;
  link.opening.clear();
  link.worker = {.busy = true};  // at least until it is published
  worker.show(hooks.opened(frozen_));
}

void LiveHost::report_frozen(WorkbenchState& state) {
  if (!reported_ || state.document.recording != reported_) return;
  const std::string why = end_.message.empty() ? "" : end_.message + ". ";
  say(state,
      fmt::format("{}Frozen: {}. Space {}, save-recording saves the recording",
                  why,
                  counted(reported_->frame_count(), "frame"),
                  is_frozen(state) ? "continues" : "plays"),
      end_.state == CaptureState::failed ? Severity::error : Severity::note);
  reported_.reset();
}

bool LiveHost::waits_for_frozen(WorkbenchState& state, const Worker& worker) {
  if (!frozen_ || worker.latest().recording != frozen_) return frozen_ != nullptr;
  replace_recording(state, window_);
  frozen_.reset();
  return false;
}

}  // namespace gpo
