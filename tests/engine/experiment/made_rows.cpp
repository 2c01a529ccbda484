// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/experiment/made_rows.h"

namespace gpo::test {

Row made_row(const std::string& configuration,
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

std::string csv_without_times(std::vector<Row> rows) {
  for (Row& row : rows) {
    for (auto* time : {&row.track_ms,
                       &row.ransac_ms,
                       &row.rotations_ms,
                       &row.initialize_ms,
                       &row.optimize_ms,
                       &row.total_ms})
      time->reset();
    row.jobs.reset();
    row.processor.clear();
  }
  return to_csv(rows);
}

}  // namespace gpo::test
