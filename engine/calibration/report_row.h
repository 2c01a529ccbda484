// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <fmt/format.h>

namespace gpo {

/// A line of what `calibrate` prints.
inline std::string row(const std::string& name, const std::string& value) {
  return fmt::format("{:<12}{}\n", name, value);
}

}  // namespace gpo
