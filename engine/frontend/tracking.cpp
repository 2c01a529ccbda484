// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking.h"

#include "engine/error.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr std::array<const char*, 2> kKeys{"frame-to-frame", "anchored"};

}  // namespace

std::span<const char* const> tracking_keys() { return kKeys; }

const char* to_string(Tracking tracking) { return kKeys[static_cast<std::size_t>(tracking)]; }

Tracking tracking_of(const std::string& key) {
  const auto it = std::ranges::find(kKeys, key);
  if (it != kKeys.end()) return static_cast<Tracking>(it - kKeys.begin());
  throw InputError(fmt::format(
      "--tracking: unknown tracking '{}', expected one of {}", key, fmt::join(kKeys, ", ")));
}

}  // namespace gpo
