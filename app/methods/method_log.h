// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace gpo {

/// What the user's own methods say: on standard error at once, and kept for the window's log. Told
/// on any thread.
class MethodLog {
 public:
  /// All in all so many lines are shown.
  void add(const std::string& name, const std::string& line);
  /// What came since the last call.
  std::vector<std::string> take();
  /// Called on the thread that tells, each time.
  void on_change(std::function<void()> changed);

 private:
  std::mutex mutex_;
  std::vector<std::string> lines_;
  std::function<void()> changed_;
  int count_ = 0;
};

}  // namespace gpo
