// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/live/live_window.h"

#include "engine/diagnosis/limits.h"
#include "engine/inspection/inspector.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

/// Returns the settings without chosen points and tracks.
Settings settings_of_live(Settings settings, int frames) {
  for (const Setting& setting : settings_table())
    if (setting.by_hand) setting.set(settings, setting.get(Settings{}));
  settings.exclude.clear();
  settings.start = 0;
  settings.frames = frames;
  return settings;
}

bool is_ready(const Inspection& inspection) {
  const Initialization& found = *inspection.initialization;
  return found.ok && found.verdict && found.verdict->readiness == Readiness::ready;
}

LiveImages images_of_window(const std::vector<LiveImage>& window) {
  return LiveBuffer(0, 0).images(window);
}

/// Returns the largest translation from the reference frame [plane distance]; nullopt if unknown.
std::optional<double> baseline_of(const Inspection& inspection) {
  const Initialization& found = *inspection.initialization;
  auto baseline = found.verdict ? found.verdict->largest_translation : std::nullopt;
  if (found.ok)
    for (const Pose& camera : found.cameras)
      baseline = std::max(baseline.value_or(0), camera.p_wc.norm() / found.plane.distance);
  return baseline;
}

/// Counts the remaining frames: frame 0, 2, 4, ... and the last one.
void leave_out_every_second(LiveTask& task) {
  ++task.halvings;
  task.solved = (task.solved + 1) / 2;  // windows that end within the inspected ones
  if (task.ready_frames > 0) task.ready_frames = task.ready_frames / 2 + 1;  // not shorter in time
}

}  // namespace

LiveWindow::LiveWindow(LiveOrigin origin, const LiveWindowOptions& options)
    : origin_(std::move(origin)), options_(options), buffer_(options.seconds, options.most_bytes) {}

std::string LiveWindow::why_restart(const LiveImage& image, Tracking tracking) const {
  if (images_.empty()) return "the first image";
  if (image.segment != images_.back().segment) return "the size of the images changed";
  if (tracking != tracking_) return "another tracker was chosen";
  if (!tracker_) return "on request";
  const Tracks& tracks = tracker_->tracks();
  const int of = tracks.track_count();
  const auto seen = tracks.raw_px.back().colwise().sum().array().isFinite().count();
  if (seen < options_.least_tracks || static_cast<double>(seen) < options_.least_share * of)
    return fmt::format("{} of {} tracks are left", seen, of);
  return "";
}

bool LiveWindow::add(const LiveImage& image, Tracking tracking) {
  cv::Mat gray;
  cv::cvtColor(image.bgr, gray, cv::COLOR_BGR2GRAY);
  buffer_.add(image);
  const std::string why = why_restart(image, tracking);
  if (!why.empty()) {
    images_ = {image};
    const int number = found_.window + 1;
    found_ = LiveTask();
    found_.window = number;
    why_anew_ = why;
    tracking_ = tracking;
    tracker_.emplace(live_recording(origin_, images_of_window(images_)).camera, tracking);
    tracker_->add(gray);
    return true;
  }
  if (frames() == options_.most_frames) drop_every_second();
  images_.push_back(image);
  tracker_->add(gray);
  return false;
}

void LiveWindow::drop_every_second() {
  tracker_->drop_every_second();
  std::vector<LiveImage> kept;
  for (std::size_t i = 0; i < images_.size(); ++i)
    if (i % 2 == 0 || i + 1 == images_.size()) kept.push_back(images_[i]);
  images_ = std::move(kept);
  leave_out_every_second(found_);
}

void LiveWindow::note(const LiveTask& noted) {
  if (noted.window != found_.window) return;
  LiveTask task = noted;
  while (task.halvings < found_.halvings) leave_out_every_second(task);
  found_.solved = std::max(found_.solved, task.solved);
  if (found_.ready_frames == 0) found_.ready_frames = task.ready_frames;
}

LiveTask LiveWindow::task() const {
  LiveTask task = found_;
  task.arrived_ns = images_.back().arrived_ns;
  task.recording =
      std::make_shared<const Recording>(live_recording(origin_, images_of_window(images_)));
  if (tracker_) task.tracks = std::make_shared<const Tracks>(tracker_->tracks());
  return task;
}

LiveWindow::Frozen LiveWindow::frozen() const {
  const LiveImages live = buffer_.images(images_);
  Frozen frozen{std::make_shared<const Recording>(live_recording(origin_, live)), {}};
  const auto& times_ns = live.timestamps_ns;
  const auto first = std::ranges::lower_bound(times_ns, images_.front().timestamp_ns);
  frozen.window = {static_cast<int>(first - times_ns.begin()),
                   static_cast<int>(times_ns.end() - first)};
  return frozen;
}

std::optional<LiveAnswer> inspect(LiveTask task,
                                  const Settings& settings,
                                  const std::stop_token& stop) {
  const int frames = task.recording->frame_count();
  if (frames < 2 || !task.tracks) return LiveAnswer{std::move(task), nullptr, "move the camera"};
  Inspector inspector(task.recording, task.tracks);
  LiveAnswer answer;
  answer.inspection = inspector.inspect(settings_of_live(settings, frames), stop);
  if (!answer.inspection) return std::nullopt;
  if (is_ready(*answer.inspection) && task.ready_frames == 0) {
    task.ready_frames = frames;
    for (int shorter = std::max(2, task.solved + 1); shorter < frames; ++shorter) {
      const auto earlier = inspector.inspect(settings_of_live(settings, shorter), stop);
      if (!earlier) return std::nullopt;
      if (!is_ready(*earlier)) continue;
      task.ready_frames = shorter;
      break;
    }
  }
  task.solved = frames;
  answer.missing = missing_for_ready(*answer.inspection);
  answer.task = std::move(task);
  return answer;
}

std::string missing_for_ready(const Inspection& inspection) {
  if (is_ready(inspection)) return "";
  const Initialization& found = *inspection.initialization;
  std::string why = found.ok && found.verdict ? found.verdict->reason : found.reason;
  const auto baseline = baseline_of(inspection);
  if (!baseline) return why;
  const double sigma_deg = normal_sigma_deg(inspection).value_or(0);
  const double needed = std::max(kReadyTranslation, *baseline * sigma_deg / kWeakSigma_deg);
  if (needed > *baseline)
    return fmt::format("move sideways: baseline {:.2g} d, needs about {:.2g} d", *baseline, needed);
  if (inspection.recording->camera_source == CameraSource::guess && found.ok)
    return "the camera is a guess: freeze with Space, then calibrate it from the plane";
  return why;
}

}  // namespace gpo
