// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gpo {

/// Ids of the tracks that the user has selected.
struct Selection {
  std::vector<std::int64_t> tracks;   ///< ascending
  std::optional<std::int64_t> focus;  ///< one of `tracks`, shown in detail; the last selected one

  bool contains(std::int64_t track) const;
  bool operator==(const Selection&) const = default;
};

/// Selects only `tracks`; the last one gets the focus.
Selection selected(std::span<const std::int64_t> tracks);
/// Adds `track`, or removes it if it is selected already.
Selection toggled(Selection selection, std::int64_t track);
/// Adds `tracks`.
Selection extended(const Selection& selection, std::span<const std::int64_t> tracks);
/// Selects the tracks of `all` that are not selected.
Selection inverted(const Selection& selection, std::span<const std::int64_t> all);

/// Track or camera under the mouse, in any view.
struct Hover {
  std::optional<std::int64_t> track = std::nullopt;
  std::optional<int> camera = std::nullopt;  ///< frame, counts in the recording

  bool operator==(const Hover&) const = default;
};

}  // namespace gpo
