// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/terminal/progress.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace gpo {

Interrupt::Interrupt() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, &mask_before_);
  waiter_ = std::jthread([this](const std::stop_token& end) {
    constexpr timespec kTimeout{0, 20'000'000};  // 20 ms
    while (!end.stop_requested())
      if (sigtimedwait(&signals_, nullptr, &kTimeout) > 0) source_.request_stop();
  });
}

Interrupt::~Interrupt() {
  waiter_.request_stop();
  waiter_.join();
  pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
}

void Interrupt::check(const std::string& remains) const {
  if (source_.stop_requested()) throw Interrupted("stopped; " + remains);
}

bool progress_is_watched() { return isatty(fileno(stderr)) != 0; }

ProgressBar::~ProgressBar() {
  if (begun_) std::fputc('\n', stderr);
}

void ProgressBar::operator()(int done, int of) {
  if (!progress_is_watched()) {
    if (report_timer_.due(ReportTimer::Clock::now())) fmt::print(stderr, "{}: {}/{} frames\n", title_, done, of);
    return;
  }
  constexpr int kLength = 20;
  const int filled = kLength * done / of;
  const std::string bar = std::string(filled, '#') + std::string(kLength - filled, '.');
  fmt::print(stderr, "\r{} [{}] {}/{} frames", title_, bar, done, of);
  std::fflush(stderr);
  begun_ = true;
}

}  // namespace gpo
