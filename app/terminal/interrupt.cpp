// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/terminal/interrupt.h"

namespace gpo {

Interrupt::Interrupt() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, &mask_before_);
  waiter_ = std::jthread([this](const std::stop_token& end) { wait(end); });
}

Interrupt::~Interrupt() {
  waiter_.request_stop();
  waiter_.join();
  pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
}

void Interrupt::check(const std::string& what_is_left) const {
  if (source_.stop_requested()) throw Interrupted("stopped; " + what_is_left);
}

void Interrupt::wait(const std::stop_token& end) {
  constexpr timespec kPatience{0, 20'000'000};  // 20 ms, after which it looks for its own end
  while (!end.stop_requested()) {
    if (sigtimedwait(&signals_, nullptr, &kPatience) > 0) source_.request_stop();
  }
}

}  // namespace gpo
