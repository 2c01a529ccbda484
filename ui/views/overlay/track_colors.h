// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/view_toggles.h"
#include "ui/views/overlay/overlay.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace gpo {

/// The tracks of a window in colors that tell a number of theirs. Immutable.
struct TrackColors {
  Coloring coloring = Coloring::residual;
  std::vector<std::optional<double>> values;  ///< by column; nothing: it has none
  double low = 0, high = 0;  ///< 5 % of the values are below and above: a few would take all colors

  /// Of a column; gray where its value is not known.
  std::uint32_t rgb(int column) const;
};

/// Null for `Coloring::plane`, whose colors come from the window.
std::shared_ptr<const TrackColors> track_colors(const Inspection& inspection, Coloring coloring);

/// The colors' ends with their values and units.
std::vector<LegendRow> legend_rows(const TrackColors& colors);

}  // namespace gpo
