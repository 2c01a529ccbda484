// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/scan.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace gpo {
namespace {

/// Scans kept of other settings: a hundred starts are some kilobytes.
constexpr std::size_t kMostScans = 50;

StartScan empty_scan(const Settings& settings, const Recording& recording) {
  const int last = recording.frame_count() - settings.frames;
  const int step = scan_step(recording.frame_count(), settings.frames);
  return {.settings = settings, .step = step, .of = last < 0 ? 0 : last / step + 1, .starts = {}};
}

std::vector<int> starts_left(const StartScan& scan, const Recording& recording) {
  auto starts = starts_to_scan(recording.frame_count(), scan.settings.frames, scan.step);
  std::erase_if(starts, [&](int start) {
    return std::ranges::binary_search(scan.starts, start, {}, &ScannedStart::start);
  });
  return starts;
}

}  // namespace

Scan::Scan(std::function<void()> changed)
    : job_([this] { return next(); }, std::move(changed), BackgroundJob::Priority::low) {}

void Scan::want(std::shared_ptr<const Recording> recording, std::optional<Settings> settings) {
  const auto lock = job_.lock();
  if (settings) settings->start = 0;
  if (!recording) settings.reset();
  if (recording == recording_ && settings == wanted_) return;
  job_.cancel();
  if (recording != recording_) kept_.clear();
  recording_ = std::move(recording);
  wanted_ = std::move(settings);
  latest_ = nullptr;
  if (!wanted_) return;
  const auto found = find(*wanted_);
  if (found == kept_.end()) {
    kept_.push_back(std::make_shared<const StartScan>(empty_scan(*wanted_, *recording_)));
  } else {
    std::rotate(found, found + 1, kept_.end());
  }
  if (kept_.size() > kMostScans) kept_.erase(kept_.begin());
  latest_ = kept_.back();
  job_.wake();
}

Scan::Cached::iterator Scan::find(const Settings& settings) {
  return std::ranges::find_if(kept_, [&](const auto& one) { return one->settings == settings; });
}

SurveyStatus Scan::status() const {
  const auto lock = job_.lock();
  if (!latest_) return {};
  return {static_cast<int>(latest_->starts.size()), latest_->of, "scanning"};
}

std::shared_ptr<const StartScan> Scan::latest() const {
  const auto lock = job_.lock();
  return latest_;
}

/// To the latest one, which is the last of those that are kept.
void Scan::add(ScannedStart found) {
  StartScan scan = *latest_;
  const auto place = std::ranges::lower_bound(scan.starts, found.start, {}, &ScannedStart::start);
  scan.starts.insert(place, std::move(found));
  latest_ = kept_.back() = std::make_shared<const StartScan>(std::move(scan));
}

BackgroundJob::Job Scan::next() {
  if (!latest_ || latest_->finished()) return nullptr;
  return [this,
          recording = recording_,
          settings = *wanted_,
          starts = starts_left(*latest_, *recording_)](const std::stop_token& stop) {
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    scan_starts(recording, settings, {starts, cores, stop}, [&](ScannedStart found) {
      if (job_.publish(stop, [&] { add(std::move(found)); })) job_.notify();
    });
  };
}

}  // namespace gpo
