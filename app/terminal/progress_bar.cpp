// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/terminal/progress_bar.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace gpo {

namespace {

constexpr int kBarLength = 20;

}  // namespace

bool progress_is_watched() { return isatty(fileno(stderr)) != 0; }

ProgressBar::~ProgressBar() {
  if (begun_) std::fputc('\n', stderr);
}

void ProgressBar::show(int done, int of) {
  if (!progress_is_watched()) {
    if (report_timer_.due(ReportTimer::Clock::now())) fmt::print(stderr, "{}: {}/{} frames\n", title_, done, of);
    return;
  }
  const int filled = kBarLength * done / of;
  const std::string bar = std::string(filled, '#') + std::string(kBarLength - filled, '.');
  fmt::print(stderr, "\r{} [{}] {}/{} frames", title_, bar, done, of);
  std::fflush(stderr);
  begun_ = true;
}

}  // namespace gpo
