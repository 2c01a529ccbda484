// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/summary_json.h"

#include "engine/experiment/figure_plan.h"
#include "engine/experiment/summary.h"
#include "engine/files/json_text.h"

#include <algorithm>
#include <set>

namespace gpo {
namespace {

using nlohmann::ordered_json;

ordered_json cells_json(std::span<const Row> rows) {
  ordered_json cells = ordered_json::array();
  for (const Cell& cell : summarize(rows)) {
    ordered_json json = {{"configuration", cell.configuration},
                         {"frames", cell.frames},
                         {"windows", cell.windows},
                         {"ok", cell.ok},
                         {"failed", cell.windows - cell.ok}};
    for (const char* name : kSummaryColumns) {
      const Distribution& d = cell.values.at(name);
      json[name] = {{"count", d.count},
                    {"lower", optional_json(d.lower)},
                    {"median", optional_json(d.median)},
                    {"upper", optional_json(d.upper)}};
    }
    cells.push_back(std::move(json));
  }
  return cells;
}

ordered_json recordings_json(const Experiment& experiment, std::span<const Row> rows) {
  ordered_json recordings = ordered_json::array();
  for (const ExperimentRecording& recording : experiment.recordings) {
    std::vector<Row> own;
    std::ranges::copy_if(rows, std::back_inserter(own), [&](const Row& row) {
      return row.recording == recording.name;
    });
    recordings.push_back({{"recording", recording.name}, {"cells", cells_json(own)}});
  }
  return recordings;
}

ordered_json figures_json(const Experiment& experiment, std::span<const Row> rows) {
  ordered_json figures = ordered_json::array();
  for (const FigurePlan& plan : figure_plans(experiment.configurations)) {
    figures.push_back(
        {{"figure", plan.name},
         {"title", plan.title},
         {"cells", cells_json(on_common_windows(rows_of(rows, plan.configurations)))}});
  }
  return figures;
}

/// How many windows were computed at once, and by which processors.
ordered_json timing_json(std::span<const Row> rows) {
  std::set<int> jobs;
  std::set<std::string> processors;
  for (const Row& row : rows) {
    if (row.jobs) jobs.insert(*row.jobs);
    if (!row.processor.empty()) processors.insert(row.processor);
  }
  return {{"jobs", jobs}, {"processors", processors}};
}

}  // namespace

ordered_json to_json(const Experiment& experiment, std::span<const Row> rows) {
  return {{"experiment", to_json(experiment)},
          {"timing", timing_json(rows)},
          {"all_windows", cells_json(rows)},
          {"by_recording", recordings_json(experiment, rows)},
          {"windows_that_all_solved", figures_json(experiment, rows)}};
}

}  // namespace gpo
