// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace gpo {

/// Calls `work(i)` for each i below `count` on `threads` threads, in no particular order. Rethrows
/// an exception of `work`. The threads share the caller's StopScope.
void in_parallel(int count, int threads, const std::function<void(int i)>& work);

}  // namespace gpo
