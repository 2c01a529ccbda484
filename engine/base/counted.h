// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <string>

namespace gpo {

/// "1 track", "0 tracks", "7 tracks". `noun` is a singular whose plural ends in s.
template <std::integral Count>
std::string counted(Count count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace gpo
