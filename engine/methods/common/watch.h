// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <stop_token>
#include <utility>

namespace gpo {

/// Who looks on while something is optimized: may stop it, and is told how far it is.
struct Watch {
  std::stop_token stop;
  /// After an iteration, on the same thread: which one, and half the summed squares [px^2].
  std::function<void(int iteration, double cost)> told;

  Watch() = default;
  Watch(std::stop_token stop_by, std::function<void(int, double)> tell = {})
      : stop(std::move(stop_by)), told(std::move(tell)) {}

  bool stop_requested() const { return stop.stop_requested(); }
  void tell(int iteration, double cost) const {
    if (told) told(iteration, cost);
  }
};

}  // namespace gpo
