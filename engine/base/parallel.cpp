// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/parallel.h"

#include "engine/base/stop.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace gpo {

void in_parallel(int count, int threads, const std::function<void(int i)>& work) {
  std::atomic<int> next = 0;
  std::exception_ptr error, stopped;
  std::mutex error_mutex;
  const StopWatch* const watch = current_watch();
  const auto take_turns = [&] {
    const StopScope scope(watch);
    try {
      for (int i = next++; i < count; i = next++) {
        check_stop();
        work(i);
      }
    } catch (const Stopped&) {
      const std::lock_guard lock(error_mutex);
      stopped = std::current_exception();
    } catch (...) {
      const std::lock_guard lock(error_mutex);
      error = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (int i = 1; i < std::max(1, threads); ++i) helpers.emplace_back(take_turns);
    take_turns();
  }
  // An error may have stopped the other threads.
  if (error) std::rethrow_exception(error);
  if (stopped) std::rethrow_exception(stopped);
}

}  // namespace gpo
