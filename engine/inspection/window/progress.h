// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace gpo {

/// "tracking 41/60": a stage's name, what is done, of how many (0: unknown).
using Progress = std::function<void(const std::string& stage, int done, int of)>;

}  // namespace gpo
