// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/limits.h"

#include "engine/base/error.h"

#include <fmt/format.h>

namespace gpo {

std::string Limit::message() const { return fmt::format("{:g}, expected {}", value, range.text); }

void check_limits(const char* owner, std::span<const Limit> limits) {
  for (const Limit& limit : limits)
    if (!limit.holds())
      throw InputError(fmt::format("{}: {} {}", owner, limit.name, limit.message()));
}

void check_options(std::span<const Limit> limits) {
  for (const Limit& limit : limits)
    if (!limit.holds()) throw SettingError(limit.name, limit.message());
}

}  // namespace gpo
