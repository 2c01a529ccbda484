// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/worker.h"

#include "engine/base/error.h"
#include "engine/inspection/inspector.h"
#include "engine/recording/layouts/open_recording.h"

#include <exception>
#include <utility>

namespace gpo {

namespace {

/// Runs `work`; what it throws comes back as one line for people, empty where it did not throw.
template <class Work>
std::string error_of(Work&& work) {
  try {
    work();
    return "";
  } catch (const std::exception& error) {
    return message_of(error);
  }
}

}  // namespace

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
    : open_(std::move(open)),
      changed_(std::move(changed)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Worker::~Worker() {
  cancel();
  thread_.request_stop();
  thread_.join();
}

void Worker::open(const std::filesystem::path& path) {
  const std::lock_guard lock(mutex_);
  running_.request_stop();
  next_path_ = path;
  next_calibration_ = false;
  next_settings_.reset();
  opening_ = true;
  status_ = {};
  wake_.notify_one();
}

void Worker::calibrate() {
  const std::lock_guard lock(mutex_);
  if (!published_.recording || next_path_) return;
  running_.request_stop();
  next_calibration_ = true;
  next_settings_.reset();
  opening_ = true;
  status_ = {};
  wake_.notify_one();
}

void Worker::request(const Settings& settings) {
  const std::lock_guard lock(mutex_);
  if (!published_.recording) return;
  if (!opening_) running_.request_stop();
  next_settings_ = settings;
  status_.error.clear();
  wake_.notify_one();
}

void Worker::cancel() {
  const std::lock_guard lock(mutex_);
  running_.request_stop();
  next_path_.reset();
  next_calibration_ = false;
  next_settings_.reset();
  opening_ = false;
  status_ = {false, "", 0, 0, status_.error};
}

WorkerStatus Worker::status() const {
  const std::lock_guard lock(mutex_);
  WorkerStatus status = status_;
  status.busy = active_ || next_path_ || next_calibration_ || next_settings_;
  return status;
}

Published Worker::latest() const {
  const std::lock_guard lock(mutex_);
  return published_;
}

void Worker::run(const std::stop_token& stop) {
  while (true) {
    std::optional<std::filesystem::path> path;
    bool calibration = false;
    std::optional<Settings> settings;
    std::stop_token request_stop;
    {
      std::unique_lock lock(mutex_);
      const auto asked = [this] { return next_path_ || next_calibration_ || next_settings_; };
      if (!wake_.wait(lock, stop, asked)) return;
      path = std::exchange(next_path_, {});
      if (!path) calibration = std::exchange(next_calibration_, false);
      if (!path && !calibration) settings = std::exchange(next_settings_, {});
      running_ = std::stop_source();
      request_stop = running_.get_token();
      active_ = true;
    }
    const std::string error = error_of([&] {
      if (path) return do_open(*path, request_stop);
      if (calibration) return do_calibrate(request_stop);
      do_inspect(*settings, request_stop);
    });
    finish(error, request_stop);
  }
}

void Worker::do_open(const std::filesystem::path& path, const std::stop_token& stop) {
  const Progress progress = [&](const std::string& stage, int done, int of) {
    report(stage, done, of, stop);
  };
  progress("opening " + path.filename().string(), 0, 0);
  publish(open_(path, stop, progress), stop);
}

void Worker::do_calibrate(const std::stop_token& stop) {
  if (!calibrate_) return;
  const Progress progress = [&](const std::string& stage, int done, int of) {
    report("calibrating: " + stage, done, of, stop);
  };
  progress("opening the pictures", 0, 0);
  publish(calibrate_(stop, progress), stop);
}

void Worker::publish(Opened opened, const std::stop_token& stop) {
  const std::lock_guard lock(mutex_);
  if (stop.stop_requested()) return;
  inspect_ = std::move(opened.inspect);
  calibrate_ = std::move(opened.calibrate);
  published_ = {std::move(opened.recording), nullptr, published_.generation + 1};
  next_settings_.reset();
}

void Worker::do_inspect(const Settings& settings, const std::stop_token& stop) {
  const Progress progress = [&](const std::string& stage, int done, int of) {
    report(stage, done, of, stop);
  };
  auto inspection = inspect_(settings, stop, progress);
  const std::lock_guard lock(mutex_);
  if (!inspection || stop.stop_requested()) return;
  published_.inspection = std::move(inspection);
  ++published_.generation;
}

void Worker::report(const std::string& stage, int done, int of, const std::stop_token& stop) {
  {
    const std::lock_guard lock(mutex_);
    if (stop.stop_requested()) return;
    status_ = {true, stage, done, of, ""};
  }
  if (changed_) changed_();
}

void Worker::finish(const std::string& error, const std::stop_token& stop) {
  {
    const std::lock_guard lock(mutex_);
    active_ = false;
    // The error of a request that was stopped is of no interest to anybody.
    if (!stop.stop_requested()) {
      status_ = {false, "", 0, 0, error};
      opening_ = false;
    }
  }
  if (changed_) changed_();
}

}  // namespace gpo
