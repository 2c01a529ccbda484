// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <utility>

namespace gpo {

inline double milliseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

/// A stage's last result, kept until its inputs change.
template <class Key, class Value>
struct Cached {
  std::optional<Key> key;
  Value value{};
  double milliseconds = 0;

  /// Recomputes where `wanted` differs; `compute` returns nothing where it was stopped.
  template <class Compute>
  bool update(const Key& wanted, Compute&& compute) {
    if (key == wanted) return true;
    key.reset();
    const auto begin = std::chrono::steady_clock::now();
    auto computed = compute();
    if (!computed) return false;
    value = std::move(*computed);
    milliseconds = milliseconds_since(begin);
    key = wanted;
    return true;
  }
};

}  // namespace gpo
