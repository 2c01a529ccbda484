// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/worker.h"

#include "engine/inspection/inspector.h"
#include "engine/recording/layouts/open_recording.h"

#include <utility>

namespace gpo {

Worker::Opened Worker::open_with_inspector(const std::filesystem::path& path,
                                           const std::stop_token&,
                                           const Progress&) {
  return with_inspector(open_recording(path));
}

Worker::Opened Worker::with_inspector(std::shared_ptr<const Recording> recording) {
  const auto inspector = std::make_shared<Inspector>(recording);
  return {
      std::move(recording),
      [inspector](const Settings& settings, const std::stop_token& stop, const Progress& progress) {
        return inspector->inspect(settings, stop, progress);
      }};
}

Worker::Worker(Open open, std::function<void()> changed)
    : open_(std::move(open)), job_([this] { return next(); }, std::move(changed)) {}

void Worker::open_by(Opening opening) {
  job_.cancel();
  next_opening_ = std::move(opening);
  next_settings_.reset();
  opening_ = true;
  job_.wake();
}

void Worker::open(const std::filesystem::path& path) {
  const auto lock = job_.lock();
  open_by([this, path](const std::stop_token& stop) {
    const Progress report = progress(stop);
    report("opening " + path.filename().string(), 0, 0);
    return open_(path, stop, report);
  });
}

void Worker::calibrate() {
  const auto lock = job_.lock();
  if (!published_.recording || next_opening_ || !calibrate_) return;
  open_by([this, calibrate = calibrate_](const std::stop_token& stop) {
    const Progress report = progress(stop, "calibrating: ");
    report("opening the images", 0, 0);
    return calibrate(stop, report);
  });
}

void Worker::request(const Settings& settings) {
  const auto lock = job_.lock();
  if (!published_.recording) return;
  if (!opening_) job_.cancel();
  next_settings_ = settings;
  job_.wake();
}

void Worker::cancel() {
  const auto lock = job_.lock();
  job_.cancel();
  next_opening_ = nullptr;
  next_settings_.reset();
  opening_ = false;
}

JobStatus Worker::status() const {
  const auto lock = job_.lock();
  return job_.status();
}

Published Worker::latest() const {
  const auto lock = job_.lock();
  return published_;
}

BackgroundJob::Job Worker::next() {
  opening_ = next_opening_ != nullptr;
  if (opening_)
    return [this, opening = std::exchange(next_opening_, nullptr)](const std::stop_token& stop) {
      Opened opened = opening(stop);
      job_.publish(stop, [&] {
        inspect_ = std::move(opened.inspect);
        calibrate_ = std::move(opened.calibrate);
        published_ = {std::move(opened.recording), nullptr, published_.generation + 1};
        next_settings_.reset();
      });
    };
  if (!next_settings_) return nullptr;
  return [this, settings = *std::exchange(next_settings_, {})](const std::stop_token& stop) {
    do_inspect(settings, stop);
  };
}

void Worker::do_inspect(const Settings& settings, const std::stop_token& stop) {
  Inspect inspect;
  if (!job_.publish(stop, [&] { inspect = inspect_; })) return;
  auto inspection = inspect(settings, stop, progress(stop));
  if (!inspection) return;
  job_.publish(stop, [&] {
    published_.inspection = std::move(inspection);
    ++published_.generation;
  });
}

Progress Worker::progress(const std::stop_token& stop, const std::string& prefix) {
  return [this, stop, prefix](const std::string& stage, int done, int of) {
    job_.report(stop, prefix + stage, done, of);
  };
}

}  // namespace gpo
