// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace gpo {

/// Called with a stage's name, the steps done and their number (0: unknown): "tracking 41/60".
using Progress = std::function<void(const std::string& stage, int done, int of)>;

}  // namespace gpo
