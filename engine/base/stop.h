// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <stop_token>
#include <string>

namespace gpo {

/// Thrown by `check_stop`. No std::exception, so that nothing reports a stop as a failure.
struct Stopped {
  std::string remains = "nothing was written";  ///< for people
};

/// How the work of a thread is stopped.
struct StopWatch {
  std::stop_token stop = {};
  std::function<void()> at_check = {};  ///< called by each `check_stop`; thread-safe
};

/// While it exists, reading, decoding, computing and writing on this thread and on those that
/// `in_parallel` starts throw Stopped soon after `watch` requests it; null: never. An inner scope
/// replaces an outer one.
class StopScope {
 public:
  explicit StopScope(const StopWatch* watch);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  const StopWatch* outer_;
};

/// Returns the watch of this thread's innermost scope; null if there is none.
const StopWatch* current_watch();
/// Returns the token of this thread's innermost scope, which never stops if there is none.
std::stop_token current_stop();

/// Throws Stopped if this thread's scope requests a stop. Takes a few nanoseconds: call it for each
/// line, message and image.
void check_stop();

}  // namespace gpo
