// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <nlohmann/json.hpp>

namespace gpo {

/// One configuration on one window: a line of results.csv. Unknown values are empty.
struct Row {
  std::string recording;      ///< name
  std::string configuration;  ///< key
  Settings settings;          ///< with resolved defaults
  std::string status;         ///< ok | failed
  std::string reason;         ///< why it failed
  std::optional<int> tracks, inliers, lost;
  std::optional<double> rms_px;
  std::optional<int> iterations, unknowns, residuals;
  std::optional<double> initial_cost, final_cost;  ///< half the sum of squares [px^2]
  std::string termination;
  std::string alignment;  ///< ok | degenerate; empty without ground truth
  std::optional<double> scale, ate_m, pne_deg, pne_aligned_deg, pde_m, pne_bound_deg;
  std::optional<double> scale_ratio, path_error_m, path_error_percent;
  std::optional<double> scale_error_percent, gravity_error_deg;  ///< with an accelerometer
  std::optional<double> track_ms, ransac_ms, rotations_ms, initialize_ms, optimize_ms, total_ms;
  std::optional<int> jobs;  ///< windows computed at once while these times were measured
  std::string processor;    ///< on which these times were measured

  bool ok() const { return status == "ok"; }
};

/// The column of a setting; its cell is empty if the row's method does not read it.
template <class S>
struct SettingColumn {
  S& settings;
  const Setting& setting;
};
template <class S>
SettingColumn(S&, const Setting&) -> SettingColumn<S>;  // clang 14 needs it for aggregates

template <class T>
concept IsSettingColumn = requires(T column) {
  column.setting;
};

/// Returns the setting's cell in results.csv: as in scripts, but true and false for on and off.
std::string setting_cell(const Settings& settings, const Setting& setting);

/// The only declaration of the columns, in their order: `visit(name, value&)`. Times and their
/// conditions come last because only they differ between runs.
template <class R, class Visitor>
void visit_row(R& row, Visitor&& visit) {
  visit("recording", row.recording);
  visit("configuration", row.configuration);
  for (const Setting& setting : settings_table()) {
    if (setting.by_hand) continue;
    SettingColumn column{row.settings, setting};
    visit(setting.key.c_str(), column);
  }
  visit("status", row.status);
  visit("reason", row.reason);
  visit("tracks", row.tracks);
  visit("inlier_tracks", row.inliers);
  visit("lost", row.lost);
  visit("rms_px", row.rms_px);
  visit("iterations", row.iterations);
  visit("unknowns", row.unknowns);
  visit("residuals", row.residuals);
  visit("initial_cost", row.initial_cost);
  visit("final_cost", row.final_cost);
  visit("termination", row.termination);
  visit("alignment", row.alignment);
  visit("scale", row.scale);
  visit("ate_m", row.ate_m);
  visit("pne_deg", row.pne_deg);
  visit("pne_aligned_deg", row.pne_aligned_deg);
  visit("pde_m", row.pde_m);
  visit("pne_bound_deg", row.pne_bound_deg);
  visit("scale_ratio", row.scale_ratio);
  visit("path_error_m", row.path_error_m);
  visit("path_error_percent", row.path_error_percent);
  visit("scale_error_percent", row.scale_error_percent);
  visit("gravity_error_deg", row.gravity_error_deg);
  visit("track_ms", row.track_ms);
  visit("ransac_ms", row.ransac_ms);
  visit("rotations_ms", row.rotations_ms);
  visit("initialize_ms", row.initialize_ms);
  visit("optimize_ms", row.optimize_ms);
  visit("total_ms", row.total_ms);
  visit("jobs", row.jobs);
  visit("processor", row.processor);
}

/// Returns the row of an inspection, labeled with the configuration of its settings.
Row make_row(const Inspection& inspection);
/// Returns a failed row for settings that do not apply to a window, e.g. without a gyroscope.
Row refused_row(const std::string& recording, const Settings& settings, const std::string& reason);

/// Returns results.csv. Numbers have enough digits to be read back exactly.
std::string to_csv(std::span<const Row> rows);

nlohmann::ordered_json to_json(const Row& row);
/// Reads the output of `to_json`. Throws nlohmann::json::exception or InputError.
Row row_from_json(const nlohmann::ordered_json& json, const MethodTable& methods = {});

bool is_results(const fs::path& file);

/// Missing columns are unknown, others are ignored. Throws InputError with file and line.
std::vector<Row> read_results(const fs::path& file, const MethodTable& methods = {});

}  // namespace gpo
