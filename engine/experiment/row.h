// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/inspection/settings/settings_table.h"

#include <functional>
#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

namespace gpo {

/// Of the fields of a row: whether one may be empty.
template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

/// One configuration on one window: a line of results.csv. What is unknown is empty.
struct Row {
  std::string recording;      ///< name
  std::string configuration;  ///< key
  Settings settings;          ///< as used: RANSAC, inliers, rotations are what the defaults came to
  std::string status;         ///< ok | failed
  std::string reason;         ///< of a failure
  std::optional<int> tracks, inliers;
  std::optional<double> rms_px;
  std::optional<int> iterations, unknowns, residuals;
  std::optional<double> initial_cost, final_cost;  ///< half the summed squares [px^2]
  std::string termination;
  std::string alignment;  ///< ok | degenerate; empty without ground truth
  std::optional<double> scale, ate_m, pne_deg, pne_aligned_deg, pde_m, pne_bound_deg;
  std::optional<double> scale_error_percent, gravity_error_deg;  ///< of an accelerometer's
  std::optional<double> track_ms, ransac_ms, rotations_ms, initialize_ms, optimize_ms, total_ms;
  std::optional<int> jobs;  ///< windows that were computed at once when these were measured
  std::string processor;    ///< on which

  bool ok() const { return status == "ok"; }
};

/// A setting of a row as a column of its own; empty where the row's method does not read it.
template <class S>
struct SettingColumn {
  S& settings;
  const Setting& setting;
};
template <class S>
SettingColumn(S&, const Setting&) -> SettingColumn<S>;  // clang 14 makes none for aggregates

template <class T>
concept OfASetting = requires(T column) {
  column.setting;
};

/// Its cell in results.csv: as scripts write the value, but true and false for on and off.
std::string setting_cell(const Settings& settings, const Setting& setting);
/// Reads it; empty is the default. Throws SettingError.
void read_setting_cell(Settings& settings,
                       const Setting& setting,
                       const std::string& cell,
                       const MethodTable& methods = {});

/// The one declaration of the columns, in their order: `visit(name, value&)`. Times, and on what
/// they were measured, are the last, because all others are the same in every run.
template <class R, class Visitor>
void visit_row(R& row, Visitor&& visit) {
  visit("recording", row.recording);
  visit("configuration", row.configuration);
  for (const Setting& setting : settings_table()) {
    // Tracks are excluded by hand, in one window: experiments do not.
    if (setting.kind == SettingKind::ids) continue;
    SettingColumn column{row.settings, setting};
    visit(setting.key.c_str(), column);
  }
  visit("status", row.status);
  visit("reason", row.reason);
  visit("tracks", row.tracks);
  visit("inlier_tracks", row.inliers);
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

/// What an inspection came to, under the configuration that its settings come to.
Row make_row(const Inspection& inspection);
/// A window that the settings cannot be tried on, e.g. without a gyroscope.
Row refused_row(const std::string& recording, const Settings& settings, const std::string& reason);

/// Header and lines of results.csv. Numbers have all the digits they need to be read back.
std::string to_csv(std::span<const Row> rows);

/// From its cells, by the names of the columns; a column without one is unknown. Throws InputError
/// that names the column.
Row row_from(const MethodTable& methods,
             const std::function<std::optional<std::string>(const char* name)>& cell_of);

nlohmann::ordered_json to_json(const Row& row);
/// Throws nlohmann::json::exception or InputError for anything but what `to_json` wrote.
Row row_from_json(const nlohmann::ordered_json& json, const MethodTable& methods = {});

}  // namespace gpo
