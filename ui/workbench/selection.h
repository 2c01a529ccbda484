// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gpo {

/// Tracks that the user has picked out, by their ids.
struct Selection {
  std::vector<std::int64_t> tracks;   ///< ascending
  std::optional<std::int64_t> focus;  ///< of `tracks`: whose life is shown; the last one picked

  bool contains(std::int64_t track) const;
  bool operator==(const Selection&) const = default;
};

/// The tracks picked in place of the others; the last of `tracks` is in focus.
Selection selected(std::span<const std::int64_t> tracks);
/// `track` beside the others; or without it, where it is picked already.
Selection toggled(Selection selection, std::int64_t track);
/// `tracks` beside the others.
Selection extended(const Selection& selection, std::span<const std::int64_t> tracks);
/// Those of `all` that are not picked.
Selection inverted(const Selection& selection, std::span<const std::int64_t> all);

/// What the mouse rests on, in any view.
struct Hover {
  std::optional<std::int64_t> track = std::nullopt;
  std::optional<int> camera = std::nullopt;  ///< frame, counts in the recording

  bool operator==(const Hover&) const = default;
};

}  // namespace gpo
