// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/choice.h"

#include "engine/base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {

void refuse_choice(const char* name, const std::string& key, std::span<const char* const> known) {
  throw SettingError(
      name, fmt::format("unknown value '{}', expected one of {}", key, fmt::join(known, ", ")));
}

}  // namespace gpo
