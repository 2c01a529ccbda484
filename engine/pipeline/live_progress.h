// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/live.h"

#include <memory>
#include <string>

namespace gpo {

/// Result of a window that was solved live.
struct LiveOutcome {
  std::shared_ptr<const WindowResult> result;  ///< null if there was an error
  std::string error = {};

  bool is_ready() const { return result && result->is_ready(); }
  std::string why_not_ready() const { return result ? result->why_not_ready() : error; }
};

/// The answer so far, from the windows solved one after the other.
struct LiveProgress {
  LiveStatus status = {};
  std::shared_ptr<const WindowResult> first = nullptr;  ///< the answer that was ready first

  /// Returns whether a longer window may be ready or improve the answer.
  bool worth_solving(int length) const;
  void take(int length, LiveOutcome outcome);
};

}  // namespace gpo
