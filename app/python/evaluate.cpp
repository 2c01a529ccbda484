// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/python/bindings.h"
#include "engine/base/error.h"
#include "engine/experiment/row.h"
#include "engine/experiment/runner.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <limits>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// Column of the table: `integer` becomes `real`, with NaN, if a value is unknown.
enum class Column { text, real, integer };

template <class T>
Column column_of(const T& value) {
  if constexpr (std::is_same_v<T, std::optional<double>>) return Column::real;
  if constexpr (std::is_same_v<T, std::optional<int>>)
    return value ? Column::integer : Column::real;
  if constexpr (IsSettingColumn<T>) {
    const SettingKind kind = value.setting.kind;
    if (kind == SettingKind::number) return Column::real;
    if (kind == SettingKind::whole)
      return setting_cell(value.settings, value.setting).empty() ? Column::real : Column::integer;
  }
  return Column::text;
}

template <class T>
py::object cell_of(const T& value, Column column) {
  if constexpr (std::is_same_v<T, std::string>) {
    return py::str(value);
  } else if constexpr (IsSettingColumn<T>) {
    const std::string text = setting_cell(value.settings, value.setting);
    if (column == Column::text) return py::str(text);
    if (column == Column::integer) return py::int_(parse_integer(text).value());
    return py::float_(parse_number(text).value_or(std::numeric_limits<double>::quiet_NaN()));
  } else {
    if (column == Column::integer) return py::int_(static_cast<std::int64_t>(*value));
    return py::float_(value ? static_cast<double>(*value) : std::nan(""));
  }
}

/// Returns a structured array with the columns of results.csv.
py::object table_of(const std::vector<Row>& rows) {
  std::vector<Column> columns;
  for (const Row& row : rows) {
    std::size_t k = 0;
    visit_row(row, [&](const char*, const auto& value) {
      const Column column = column_of(value);
      if (k == columns.size()) columns.push_back(column);
      columns[k] = std::min(columns[k], column);
      ++k;
    });
  }
  py::list types, lines;
  visit_row(rows.front(), [&](const char* name, const auto&) {
    constexpr std::array kTypes{"O", "f8", "i8"};
    types.append(py::make_tuple(name, kTypes[static_cast<std::size_t>(columns[types.size()])]));
  });
  for (const Row& row : rows) {
    py::list line;
    visit_row(row, [&](const char*, const auto& value) {
      line.append(cell_of(value, columns[line.size()]));
    });
    lines.append(py::tuple(line));
  }
  return py::module_::import("numpy").attr("array")(lines, py::arg("dtype") = types);
}

/// Returns a new folder, which is deleted with the last reference to it.
std::shared_ptr<const fs::path> scratch_folder() {
  std::string name = (fs::temp_directory_path() / "gpo-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw InputError(name + ": cannot be created");
  return {new fs::path(name), [](const fs::path* folder) {
            std::error_code none;
            fs::remove_all(*folder, none);
            delete folder;
          }};
}

/// Returns the changes of settings. Throws InputError if configurations cannot name one.
std::vector<Configuration::Change> changes_of(const py::kwargs& given, const MethodTable& methods) {
  std::vector<Configuration::Change> changes;
  const Settings settings = settings_of(given, methods);
  for (const auto& [key, value] : given) {
    const std::string name = py::str(key);
    if (name == "preset" || value.is_none()) continue;
    const Setting& setting = find_setting(name);
    const std::string text = setting_text(settings, name);
    if (std::ranges::none_of(setting.words, [&](const auto& word) { return word.value == text; }))
      throw InputError(fmt::format(
          "{}: evaluate does not take it; methods, lengths, starts and seed are arguments", name));
    changes.push_back({name, text});
  }
  return changes;
}

/// Returns the methods, each with the settings that it reads and does not name itself.
std::vector<Configuration> configurations_with(const std::vector<Configuration>& plain,
                                               const py::kwargs& given,
                                               const MethodTable& methods) {
  const std::vector<Configuration::Change> common = changes_of(given, methods);
  std::vector<Configuration> all;
  for (Configuration one : plain) {
    const auto add = [&](const Configuration::Change& change) {
      const bool read = is_read(find_setting(change.setting), one.method);
      if (read && !one.names(change.setting)) one.changes.push_back(change);
    };
    std::ranges::for_each(common, add);
    if (given.contains("preset") && !given["preset"].is_none()) {
      const std::string preset = py::str(given["preset"]);
      std::ranges::for_each(parse_configuration(one.method.key() + "+" + preset, methods).changes,
                            add);
    }
    one = parse_configuration(key_of(one), methods);
    if (std::ranges::count(all, one) == 0) all.push_back(one);
  }
  return all;
}

/// Throws InputError for a start by its number from which no window fits in any recording.
void check_starts(const std::vector<Range>& starts, const Experiment& experiment) {
  for (const Range& range : starts) {
    const auto has_it = [&](const auto& recording) {
      return std::ranges::count(recording.starts, range.first) > 0;
    };
    if (range.last == range.first && std::ranges::none_of(experiment.recordings, has_it))
      throw InputError(fmt::format("starts: no window fits from frame {}", range.first));
  }
}

py::object evaluated(const std::vector<RecordingOrPath>& recordings,
                     const py::object& methods,
                     const py::object& lengths,
                     const py::object& starts,
                     std::uint64_t seed,
                     int jobs,
                     const std::optional<fs::path>& output,
                     py::kwargs given) {
  check_within("jobs", jobs, 0, 1024);
  MethodTable table = take_methods(given).table;
  const std::string names = methods_text(methods, table);
  const ExperimentRequest request{
      .configurations = configurations_with(parse_configurations(names, table), given, table),
      .lengths = parse_ranges(setting_text_of(lengths), "lengths"),
      .starts = parse_ranges(setting_text_of(starts), "starts"),
      .seed = seed};
  if (recordings.empty()) throw InputError("evaluate: needs at least one recording");
  if (output) check_experiment_folder(*output);
  std::vector<SharedRecording> all;
  for (const RecordingOrPath& recording : recordings) all.push_back(opened(recording));
  const auto scratch = output ? nullptr : scratch_folder();
  const fs::path folder = output ? *output : *scratch;
  const int threads = jobs > 0 ? jobs : static_cast<int>(std::thread::hardware_concurrency());
  const auto rows = interruptible(
      [all, request, scratch, folder, threads](const std::stop_token& stop) -> std::vector<Row> {
        const Experiment experiment = plan_experiment(all, request);
        check_starts(request.starts, experiment);
        const bool done = run_experiment(experiment, all, folder, {.jobs = threads, .stop = stop});
        if (!done) return {};
        return collect_rows(experiment, std::span(&folder, 1));
      });
  if (output) py::module_::import("gpo._views").attr("_write_evaluation")(folder);
  return table_of(rows);
}

}  // namespace

void bind_evaluate(py::module_& module) {
  module.def(
      "evaluate",
      &evaluated,
      py::arg("recordings"),
      py::arg("methods") = "all",
      py::arg("lengths") = "10:60:10",
      py::arg("starts") = "0:end:10",
      py::arg("seed") = 1,
      py::arg("jobs") = 0,
      py::arg("output") = py::none(),
      "Compares methods on many windows, like `gpo-inspector evaluate`. Returns a structured "
      "array with the columns of results.csv; numbers are int64, or float64 with NaN if one is "
      "unknown. methods: text, or a list of texts and callables; a callable takes the window of "
      "`--method-command` as a dict and returns its answer. method_command, method_timeout, "
      "method_resample and result as on the command line. Other keywords are settings of all "
      "methods that read them. jobs=0: one per processor. output: a folder that keeps the "
      "results and figures; the same call continues after an interruption.");
}

}  // namespace gpo
