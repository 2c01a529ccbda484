// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/internal/background_job.h"

#include "engine/base/error.h"
#include "engine/base/stop.h"

#include <exception>

#include <sys/resource.h>

namespace gpo {
namespace {

/// A job of low priority gets the processor time that the window and other jobs leave.
constexpr int kNiceness = 10;

std::string error_of(const BackgroundJob::Job& job, const std::stop_token& stop) {
  const StopWatch watch{.stop = stop};
  const StopScope scope(&watch);
  try {
    if (!stop.stop_requested()) job(stop);
    return "";
  } catch (const Stopped&) {
    return "";
  } catch (const std::exception& error) {
    return message_of(error);
  }
}

}  // namespace

BackgroundJob::BackgroundJob(Next next, std::function<void()> changed, Priority priority)
    : next_(std::move(next)), changed_(std::move(changed)), priority_(priority) {}

BackgroundJob::~BackgroundJob() {
  thread_.request_stop();
  {
    const auto lock = this->lock();
    cancel();
  }
  if (thread_.joinable()) thread_.join();
}

void BackgroundJob::wake() {
  woken_ = true;
  status_.error.clear();
  if (!thread_.joinable())
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  wake_.notify_one();
}

void BackgroundJob::cancel() {
  run_.request_stop();
  woken_ = false;
}

JobStatus BackgroundJob::status() const {
  if (!busy()) return {.error = status_.error};
  JobStatus status = status_;
  status.busy = true;
  return status;
}

void BackgroundJob::wait_until_idle(std::unique_lock<std::mutex>& lock) {
  idle_.wait(lock, [this] { return !busy(); });
}

void BackgroundJob::report(const std::stop_token& stop,
                           const std::string& stage,
                           int done,
                           int of) {
  const auto change = [&] { status_ = {.stage = stage, .done = done, .of = of}; };
  if (publish(stop, change)) notify();
}

BackgroundJob::Job BackgroundJob::take() {
  woken_ = false;
  Job job = next_();
  running_ = job != nullptr;
  if (running_) {
    run_ = std::stop_source();
  } else {
    idle_.notify_all();
  }
  return job;
}

void BackgroundJob::run(const std::stop_token& stop) {
  // On Linux this applies to this thread and the threads that it starts.
  if (priority_ == Priority::low) setpriority(PRIO_PROCESS, 0, kNiceness);
  std::unique_lock lock(mutex_);
  while (wake_.wait(lock, stop, [this] { return woken_; }) && !stop.stop_requested()) {
    // The next job is taken before this one is announced as done, so that the status is idle when
    // the last result arrives.
    for (Job job = take(); job != nullptr && !stop.stop_requested();) {
      const std::stop_token run = run_.get_token();
      lock.unlock();
      const std::string error = error_of(job, run);
      job = nullptr;  // its destructor may take a while
      lock.lock();
      const bool stopped = run.stop_requested();
      if (!stopped) status_ = {.error = error};
      job = take();
      if (stopped && job != nullptr) continue;
      lock.unlock();
      notify();
      lock.lock();
    }
  }
}

}  // namespace gpo
