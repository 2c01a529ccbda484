// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/stop.h"

#include <utility>

namespace gpo {
namespace {

// One for each thread, so that a stop reaches every loop without a parameter in every signature.
thread_local const StopWatch* innermost = nullptr;

}  // namespace

StopScope::StopScope(const StopWatch* watch) : outer_(std::exchange(innermost, watch)) {}
StopScope::~StopScope() { innermost = outer_; }

const StopWatch* current_watch() { return innermost; }

std::stop_token current_stop() {
  return innermost == nullptr ? std::stop_token() : innermost->stop;
}

void check_stop() {
  if (innermost == nullptr) return;
  if (innermost->at_check) innermost->at_check();
  if (innermost->stop.stop_requested()) throw Stopped{};
}

}  // namespace gpo
