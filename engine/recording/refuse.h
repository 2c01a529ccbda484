// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/error.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

namespace gpo {

/// Throws an InputError "FILE: REASON"; the reason is formatted from `format` and `args`.
template <class... Args>
[[noreturn]] void refuse(const std::filesystem::path& file,
                         fmt::format_string<Args...> format,
                         Args&&... args) {
  throw InputError(file.string() + ": " + fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace gpo
