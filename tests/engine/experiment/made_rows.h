// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/row.h"

#include <optional>
#include <string>
#include <vector>

namespace gpo::test {

/// Returns a solved window with this error, or a failed one for nullopt.
inline Row made_row(const std::string& configuration,
                    int start,
                    int frames,
                    std::optional<double> pne_deg) {
  Row row;
  row.recording = "made";
  row.configuration = configuration;
  row.settings.start = start;
  row.settings.frames = frames;
  row.status = pne_deg ? "ok" : "failed";
  row.reason = pne_deg ? "" : "no parallax, \"none\"";
  row.pne_deg = pne_deg;
  if (!pne_deg) return row;
  row.pne_bound_deg = *pne_deg / 10;
  row.ate_m = *pne_deg / 100;
  row.track_ms = 20;
  row.ransac_ms = 10;
  row.rotations_ms = 1;
  row.initialize_ms = 5;
  row.optimize_ms = 4;
  row.total_ms = 36;
  return row;
}

/// Returns results.csv without running times, which differ from run to run.
inline std::string csv_without_times(std::vector<Row> rows) {
  for (Row& row : rows) {
    row.track_ms = row.ransac_ms = row.rotations_ms = std::nullopt;
    row.initialize_ms = row.optimize_ms = row.total_ms = std::nullopt;
    row.jobs.reset();
    row.processor.clear();
  }
  return to_csv(rows);
}

}  // namespace gpo::test
