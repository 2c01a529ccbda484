// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/row.h"

#include "engine/base/error.h"
#include "engine/experiment/experiment.h"
#include "engine/files/csv_table.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/inspection/report/report.h"
#include "engine/pipeline/method_defaults.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using nlohmann::ordered_json;
constexpr const char* kBegin = "recording,configuration,";  // start of results.csv

template <class Value>
ordered_json json_of(const Value& value) {
  if constexpr (IsSettingColumn<Value>) {
    const bool read = is_read(value.setting, value.settings.options.method);
    return read ? value_json(value.setting.get(value.settings)) : ordered_json(nullptr);
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return value;
  } else {
    return value ? ordered_json(*value) : ordered_json(nullptr);
  }
}

template <class Number>
std::optional<Number> number_of(const std::string& text) {
  constexpr bool kReal = std::is_floating_point_v<Number>;
  if (text.empty()) return std::nullopt;
  if constexpr (kReal) {
    if (const auto value = parse_number(text)) return value;
  } else if (const auto value = parse_integer(text)) {
    if (std::in_range<Number>(*value)) return static_cast<Number>(*value);
  }
  throw InputError(
      fmt::format("found '{}', expected {}", text, kReal ? "a number" : "an integer in its range"));
}

void read_setting_cell(Settings& settings,
                       const Setting& setting,
                       const std::string& cell,
                       const MethodTable& methods) {
  if (cell.empty()) {
    setting.set(settings, setting.get(Settings{}));
  } else if (setting.kind != SettingKind::on_off) {
    set_value(settings, setting, value_from(setting, cell, methods), methods);
  } else if (cell == "true" || cell == "false") {
    setting.set(settings, cell == "true");
  } else {
    refuse_setting(setting.key, "found '{}', expected true or false", cell);
  }
}

template <class Value>
void read_value(const std::string& text, const MethodTable& methods, Value& value) {
  if constexpr (IsSettingColumn<Value>) {
    read_setting_cell(value.settings, value.setting, text, methods);
  } else if constexpr (std::is_same_v<Value, std::string>) {
    value = text;
  } else {
    value = number_of<typename Value::value_type>(text);
  }
}

template <class Value>
std::string value_cell(const Value& value) {
  if constexpr (IsSettingColumn<Value>) {
    return setting_cell(value.settings, value.setting);
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return csv_quoted(value);
  } else {
    return value ? fmt::format("{}", *value) : "";
  }
}

Row row_from(const MethodTable& methods,
             const std::function<std::optional<std::string>(const char* name)>& cell_of) {
  Row row;
  visit_row(row, [&](const char* name, auto& value) {
    const auto cell = cell_of(name);
    if (!cell) return;
    try {
      read_value(*cell, methods, value);
    } catch (const SettingError&) {
      throw;  // its message names the column
    } catch (const InputError& error) {
      refuse(name, "{}", error.what());
    }
  });
  return row;
}

Row row_of_line(const std::vector<std::string>& cells,
                const std::vector<std::string>& names,
                const MethodTable& methods) {
  Row row = row_from(methods, [&](const char* name) -> std::optional<std::string> {
    const auto column = std::ranges::find(names, name);
    if (column == names.end()) return std::nullopt;
    return cells[column - names.begin()];
  });
  if (row.status != "ok" && row.status != "failed")
    refuse("status", "found '{}', expected ok or failed", row.status);
  const std::string key = key_of(parse_configuration(row.configuration, methods));
  if (key != row.configuration)
    refuse("configuration", "found '{}', expected '{}'", row.configuration, key);
  return row;
}

}  // namespace

std::string setting_cell(const Settings& settings, const Setting& setting) {
  const SettingValue value = setting.get(settings);
  const bool unset = std::holds_alternative<std::monostate>(value);
  if (unset || !is_read(setting, settings.options.method)) return "";
  const bool* on = std::get_if<bool>(&value);
  return on == nullptr ? value_text(value) : *on ? "true" : "false";
}

Row refused_row(const std::string& recording, const Settings& settings, const std::string& reason) {
  Row row;
  row.recording = recording;
  row.configuration = key_of(configuration_of(settings));
  row.settings = settings;
  row.settings.options.ransac = uses_ransac(settings.options);
  row.settings.options.inliers = inliers_used(settings.options);
  row.settings.options.gravity = gravity_used(settings.options);
  row.status = "failed";
  row.reason = reason;
  return row;
}

Row make_row(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  Row row = refused_row(inspection.recording->name, inspection.settings, result.reason);
  row.settings = settings_used(inspection);
  row.status = result.ok ? "ok" : "failed";
  row.tracks = inspection.window->track_count();
  row.inliers = inspection.window->inlier_count(0);
  row.lost = lost_count(*inspection.window, inspection.window->frame_count() - 1);
  if (result.ok) row.rms_px = result.rms_px;
  row.iterations = result.solver.iterations;
  row.unknowns = result.solver.unknowns;
  row.residuals = result.solver.residuals;
  row.initial_cost = result.solver.initial_cost;
  row.final_cost = result.solver.final_cost;
  row.termination = to_string(result.solver.termination);
  if (const auto& errors = inspection.evaluation) {
    row.alignment = errors->alignment == Alignment::ok ? "ok" : "degenerate";
    row.scale = errors->scale;
    row.ate_m = errors->ate_m;
    row.pne_deg = errors->pne_deg;
    row.pne_aligned_deg = errors->pne_aligned_deg;
    row.pde_m = errors->pde_m;
    row.pne_bound_deg = errors->pne_bound_deg;
    row.scale_ratio = errors->scale_ratio;
    row.path_error_m = errors->path_error_m;
    row.path_error_percent = errors->path_error_percent;
    row.scale_error_percent = errors->scale_error_percent;
    row.gravity_error_deg = errors->gravity_error_deg;
  }
  const Timing& timing = inspection.timing;
  row.track_ms = timing.track;
  row.ransac_ms = timing.ransac;
  row.rotations_ms = timing.rotations;
  row.initialize_ms = timing.initialize;
  row.optimize_ms = timing.optimize;
  row.total_ms = timing.total;
  return row;
}

std::string to_csv(std::span<const Row> rows) {
  std::vector<std::string> names;
  const Row empty;
  visit_row(empty, [&](const std::string& name, const auto&) { names.push_back(name); });
  std::string text = fmt::format("{}\n", fmt::join(names, ","));
  for (const Row& row : rows) {
    std::vector<std::string> cells;
    visit_row(row, [&](const char*, const auto& value) { cells.push_back(value_cell(value)); });
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

ordered_json to_json(const Row& row) {
  ordered_json json;
  visit_row(row, [&](const char* name, const auto& value) { json[name] = json_of(value); });
  return json;
}

Row row_from_json(const ordered_json& json, const MethodTable& methods) {
  return row_from(methods, [&](const char* name) -> std::optional<std::string> {
    const ordered_json& value = json.at(name);
    if (value.is_null()) return "";
    return value.is_string() ? value.get<std::string>() : value.dump();
  });
}

bool is_results(const fs::path& file) {
  if (file.extension() != ".csv" || !is_file(file)) return false;
  std::string begin(std::char_traits<char>::length(kBegin), ' ');
  std::ifstream(file).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == kBegin;
}

std::vector<Row> read_results(const fs::path& file, const MethodTable& methods) {
  std::vector<std::string> names;
  std::vector<Row> rows;
  read_quoted_csv(file, [&](int line, const std::vector<std::string>& cells) {
    const auto fail = [&](const std::string& why) { refuse(place_in(file, line), "{}", why); };
    if (names.empty()) {
      names = cells;
      for (const char* needed : {"recording", "configuration", "start", "frames", "status"})
        if (std::ranges::find(names, needed) == names.end())
          fail(fmt::format("no column is called {}", needed));
      return;
    }
    if (rows.size() == limits().results)
      refuse_size(place_in(file, line), fmt::format("more than {} rows", rows.size()), "fewer");
    if (cells.size() == 1 && cells[0].empty()) return;
    if (cells.size() != names.size())
      fail(fmt::format(
          "found {}, expected {} as in the header", counted(cells.size(), "cell"), names.size()));
    try {
      rows.push_back(row_of_line(cells, names, methods));
    } catch (const InputError& error) {
      fail(error.what());
    }
  });
  if (rows.empty()) refuse(file, "found no rows of results");
  return rows;
}

}  // namespace gpo
