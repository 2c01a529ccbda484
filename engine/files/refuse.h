// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/error.h"
#include "engine/files/paths.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace gpo {

/// Throws InputError "PLACE: REASON"; the place is a file, and maybe something in it.
template <class... Args>
[[noreturn]] void refuse(const fs::path& place,
                         fmt::format_string<Args...> format,
                         Args&&... args) {
  throw InputError(place.string() + ": " + fmt::format(format, std::forward<Args>(args)...));
}

template <class... Args>
[[noreturn]] void refuse_setting(const std::string& setting,
                                 fmt::format_string<Args...> format,
                                 Args&&... args) {
  throw SettingError(setting, fmt::format(format, std::forward<Args>(args)...));
}

[[noreturn]] inline void fail_at(const fs::path& place,
                                 std::string_view found,
                                 std::string_view expected) {
  refuse(place, "found {}, expected {}", found, expected);
}

inline std::string place_in(const fs::path& file, int line) {
  return fmt::format("{}:{}", file.string(), line);
}

}  // namespace gpo
