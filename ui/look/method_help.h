// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace gpo {

/// What a method (key of `methods()`) does and what it takes for granted, in two sentences; of a
/// user's own that it is that.
std::string method_help(const std::string& key);

}  // namespace gpo
