// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gpo::test {

/// Measures how much memory this process takes at most from here on.
class PeakMemory {
 public:
  PeakMemory();
  /// The largest growth so far [KiB].
  long kib() const;

 private:
  long held_before_kib_;
};

}  // namespace gpo::test
