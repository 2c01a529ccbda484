// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

namespace gpo {

struct JobStatus {
  bool busy = false;       ///< a job runs or waits
  std::string stage = {};  ///< "tracking"; empty if idle
  int done = 0;
  int of = 0;              ///< 0: unknown
  std::string error = {};  ///< why the last job failed, one line; empty if it did not
};

/// A thread that runs one job at a time, so that the screen never waits.
///
/// The owner keeps its requests and results as members that `lock()` guards, and this object as its
/// last member. A request that replaces the previous one is
///
///     const auto lock = job_.lock();
///     job_.cancel();
///     request_ = ...;
///     job_.wake();
///
/// and `next` takes it from there. The thread starts with the first request. The destructor stops
/// the running job, runs no other and waits for the thread.
class BackgroundJob {
 public:
  enum class Priority { normal, low };  ///< low: also for the threads that a job starts

  /// Runs without the lock, in a StopScope of the token, and returns soon after the token is
  /// stopped. An exception becomes the error of the status unless the job was stopped.
  using Job = std::function<void(const std::stop_token&)>;
  /// Takes the next job from the owner's requests; null if there is none. Called with the lock.
  using Next = std::function<Job()>;

  /// `changed` is called without the lock on the job's thread: after each job, unless a stopped one
  /// is followed by another, and by `report` and `notify`.
  explicit BackgroundJob(Next next,
                         std::function<void()> changed = {},
                         Priority priority = Priority::normal);
  ~BackgroundJob();
  BackgroundJob(const BackgroundJob&) = delete;
  BackgroundJob& operator=(const BackgroundJob&) = delete;

  [[nodiscard]] std::unique_lock<std::mutex> lock() const { return std::unique_lock(mutex_); }

  // For the owner, with the lock.

  /// Makes the thread ask `next`; clears the error of the last job.
  void wake();
  /// Stops the running job; its reports and results no longer count.
  void cancel();
  bool running() const { return running_; }
  bool busy() const { return running_ || woken_; }
  JobStatus status() const;
  void wait_until_idle(std::unique_lock<std::mutex>& lock);

  // For a running job, without the lock; `stop` is its token.

  /// Applies `change` to the owner's results with the lock. Returns false, without that, if the job
  /// was stopped.
  template <class Change>
  bool publish(const std::stop_token& stop, Change&& change) {
    const std::lock_guard lock(mutex_);
    if (stop.stop_requested()) return false;
    std::forward<Change>(change)();
    return true;
  }
  void report(const std::stop_token& stop, const std::string& stage, int done, int of);
  void notify() const {
    if (changed_) changed_();
  }

 private:
  void run(const std::stop_token& stop);
  /// Takes the next job and a token for it; null if there is none.
  Job take();

  Next next_;
  std::function<void()> changed_;
  Priority priority_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::condition_variable idle_;
  bool woken_ = false;    ///< `next` may have something
  bool running_ = false;  ///< a job has been taken and is not done
  std::stop_source run_;  ///< stops that job
  JobStatus status_;      ///< `busy` aside
  std::jthread thread_;   ///< last, so that it ends first
};

}  // namespace gpo
