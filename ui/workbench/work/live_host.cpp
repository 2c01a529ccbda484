// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/live_host.h"

#include "engine/base/error.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/live/sources.h"

#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

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

}  // namespace

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
  constexpr double kGiveUp_s = 60;
  try {
    if (!hooks.source)
      throw InputError(address + ": only a user at the window opens cameras and streams");
    const SourceAddress source = hooks.source(address);
    if (source.recording && !source.recording->images)
      throw InputError(address + ": has no images to play");
    session_.reset();
    state.live.reset();
    worker.cancel();
    link.worker = link.survey = link.scan = {};
    link.loading = link.calibrating = link.finding_start = false;
    frozen_.reset();
    reported_.reset();
    delays_s_.clear();
    LiveSessionOptions options{.camera_of = hooks.camera_of};
    options.capture.give_up_s = kGiveUp_s;
    options.capture.clock = hooks.clock;
    options.window.seconds = state.view.toggles.live_seconds;
    session_ = std::make_unique<LiveSession>(source, options, changed_);
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
