// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace gpo {

/// Whether standard error is a terminal: progress is for people who watch, not for logs.
bool progress_is_watched();

/// One line on standard error that is overwritten as work goes on, and ended at the end; nothing
/// where nobody watches.
class ProgressBar {
 public:
  explicit ProgressBar(std::string what) : title_(std::move(what)) {}
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// "WHAT [####....] DONE/OF frames".
  void show(int done, int of);

 private:
  std::string title_;
  bool begun_ = false;
};

}  // namespace gpo
