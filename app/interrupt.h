// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <stop_token>
#include <thread>

namespace gpo {

/// While it lives, SIGINT and SIGTERM do not end the program but request a stop. Made before other
/// threads, which inherit that.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return source_.get_token(); }

 private:
  void wait(const std::stop_token& end);

  sigset_t signals_{};
  sigset_t mask_before_{};
  std::stop_source source_;
  std::jthread waiter_;  ///< last: it starts when all the others exist
};

}  // namespace gpo
