// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/time_offsets.h"

#include "engine/base/error.h"
#include "engine/files/csv_table.h"
#include "engine/inspection/recording_facts.h"

#include <fmt/format.h>

namespace gpo {
namespace {

std::string milliseconds_text(const std::optional<double>& seconds) {
  return seconds ? fmt::format("{:.2f}", 1e3 * *seconds) : "";
}

}  // namespace

Table time_offset_table(const Experiment& experiment,
                        std::span<const std::shared_ptr<const Recording>> recordings) {
  Table table{
      .caption = "Time offsets of results: recording minus result, estimated from rotations",
      .header = {"recording", "method", "offset [ms]", "sigma [ms]", "applied [ms]", "by"},
      .lines = {}};
  for (const auto& recording : recordings) {
    std::optional<RecordingFacts> facts;
    for (const Configuration& one : experiment.configurations) {
      const RecordingMethod* method = recording_method(one.method.row());
      if (method == nullptr) continue;
      if (!facts) facts = recording_facts(*recording);
      try {
        const auto imported = method->describe(*facts);
        if (!imported) continue;
        table.lines.push_back({csv_quoted(recording->name),
                               key_of(one),
                               milliseconds_text(imported->time_offset_s),
                               milliseconds_text(imported->time_offset_sigma_s),
                               milliseconds_text(imported->applied_time_offset_s),
                               imported->clock});
      } catch (const InputError&) {  // its windows fail with this reason
      }
    }
  }
  return table;
}

}  // namespace gpo
