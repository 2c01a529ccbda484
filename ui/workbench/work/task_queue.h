// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "engine/inspection/inspector.h"

#include <deque>
#include <functional>
#include <utility>
#include <vector>

namespace gpo {

/// Returns a copy of a value that the job changes.
template <class T>
T locked(const BackgroundJob& job, const T& value) {
  const auto lock = job.lock();
  return value;
}

inline JobStatus locked_status(const BackgroundJob& job) {
  const auto lock = job.lock();
  return job.status();
}

/// Runs tasks in the background, one after the other, and keeps their results. Thread-safe.
template <class Result>
class TaskQueue {
 public:
  using Task = std::function<Result(const Progress&)>;

  /// `changed` is called on the queue's thread as a task advances and when it has finished.
  explicit TaskQueue(std::function<void()> changed = {})
      : job_([this] { return next(); }, std::move(changed)) {}

  void add(Task task) {
    const auto lock = job_.lock();
    tasks_.push_back(std::move(task));
    job_.wake();
  }
  /// Drops all tasks that are not finished.
  void cancel() {
    const auto lock = job_.lock();
    job_.cancel();
    tasks_.clear();
  }
  JobStatus status() const { return locked_status(job_); }
  /// Returns whether a task is not finished, or its result has not been taken.
  bool busy() const {
    const auto lock = job_.lock();
    return job_.busy() || !results_.empty();
  }
  /// Returns the results of the tasks that were finished since the last call.
  std::vector<Result> take() {
    const auto lock = job_.lock();
    return std::exchange(results_, {});
  }

 private:
  BackgroundJob::Job next() {
    if (tasks_.empty()) return nullptr;
    Task task = std::move(tasks_.front());
    tasks_.pop_front();
    return [this, task = std::move(task)](const std::stop_token& stop) {
      Result result = task([this, stop](const std::string& stage, int done, int of) {
        job_.report(stop, stage, done, of);
      });
      job_.publish(stop, [&] { results_.push_back(std::move(result)); });
    };
  }

  std::deque<Task> tasks_;
  std::vector<Result> results_;
  BackgroundJob job_;
};

}  // namespace gpo
