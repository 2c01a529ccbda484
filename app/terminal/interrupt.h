// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>

namespace gpo {

/// Work that was given up because the user wants that; the message says what is left of it.
struct Interrupted : std::runtime_error {
  explicit Interrupted(const std::string& what_is_left) : std::runtime_error(what_is_left) {}
};

/// While it lives, SIGINT and SIGTERM do not end the program but request a stop. Made before other
/// threads, which inherit that.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return source_.get_token(); }
  /// Throws Interrupted where a stop was requested.
  void check(const std::string& what_is_left) const;

 private:
  void wait(const std::stop_token& end);

  sigset_t signals_{};
  sigset_t mask_before_{};
  std::stop_source source_;
  std::jthread waiter_;  ///< last: it starts when all the others exist
};

}  // namespace gpo
