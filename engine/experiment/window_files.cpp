// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/window_files.h"

#include "engine/base/error.h"
#include "engine/files/json_text.h"
#include "engine/files/output_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

fs::path definition_file(const fs::path& folder) { return folder / "experiment.json"; }

fs::path window_file(const fs::path& folder, const std::string& name, int start, int frames) {
  return folder / "windows" / fmt::format("{}-{}-{}.json", name, start, frames);
}

/// The first key in which two definitions differ.
std::string difference(const ordered_json& a, const ordered_json& b) {
  for (const auto& [key, value] : a.items()) {
    if (b.at(key) != value) return key;
  }
  return "nothing";
}

bool belongs(const std::vector<Row>& rows, const Experiment& experiment) {
  if (rows.size() != experiment.configurations.size()) return false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].configuration != key_of(experiment.configurations[i])) return false;
  }
  return true;
}

/// "desk from frame 10 (12 windows), ...", at most a line of them.
std::string list_of(const std::vector<std::string>& missing) {
  constexpr std::size_t kMostNamed = 8;
  const auto named = std::min(missing.size(), kMostNamed);
  std::string list = fmt::format("{}", fmt::join(missing.begin(), missing.begin() + named, ", "));
  if (missing.size() > named) list += fmt::format(" and {} more", missing.size() - named);
  return list;
}

}  // namespace

void begin_experiment(const fs::path& folder, const Experiment& experiment) {
  if (!fs::exists(definition_file(folder))) {
    make_folder(folder / "windows");
    write_file(definition_file(folder), json_text(to_json(experiment), 2));
    return;
  }
  const Experiment there = read_experiment(folder);
  if (there == experiment) return;
  throw InputError(
      fmt::format("{}: is of another experiment (`{}` differs), expected the same or another "
                  "--output",
                  definition_file(folder).string(),
                  difference(to_json(there), to_json(experiment))));
}

Experiment read_experiment(const fs::path& folder) {
  const fs::path file = definition_file(folder);
  const ordered_json json = read_json(file);
  if (json.is_discarded()) {
    throw InputError(
        fmt::format("{}: is not the definition of an experiment (no JSON)", file.string()));
  }
  try {
    return experiment_from_json(json);
  } catch (const ordered_json::exception& error) {
    throw InputError(fmt::format(
        "{}: is not the definition of an experiment ({})", file.string(), error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

void save_window(const fs::path& folder, std::span<const Row> rows) {
  ordered_json json = ordered_json::array();
  for (const Row& row : rows) json.push_back(to_json(row));
  const Settings& window = rows.front().settings;
  write_file(window_file(folder, rows.front().recording, window.start, window.frames),
             json_text(json, 1));
}

std::optional<std::vector<Row>> load_window(const fs::path& folder,
                                            const Experiment& experiment,
                                            const ExperimentTask& task,
                                            int frames) {
  const std::string& name = experiment.recordings[task.recording].name;
  const fs::path file = window_file(folder, name, task.start, frames);
  if (!fs::exists(file)) return std::nullopt;
  try {
    std::vector<Row> rows;
    for (const ordered_json& row : read_json(file)) {
      rows.push_back(row_from_json(row));
    }
    return belongs(rows, experiment) ? std::optional(std::move(rows)) : std::nullopt;
  } catch (const ordered_json::exception&) {
    return std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

std::vector<Row> collect_rows(const Experiment& experiment, std::span<const fs::path> folders) {
  std::vector<Row> rows;
  std::vector<std::string> missing;
  int missing_count = 0;
  const std::vector<ExperimentTask> tasks = tasks_of(experiment);
  for (const ExperimentTask& task : tasks) {
    int missing_here = 0;
    for (const int frames : task.lengths) {
      std::optional<std::vector<Row>> window;
      for (auto folder = folders.begin(); !window && folder != folders.end(); ++folder) {
        window = load_window(*folder, experiment, task, frames);
      }
      if (window) rows.insert(rows.end(), window->begin(), window->end());
      if (!window) ++missing_here;
    }
    if (missing_here == 0) continue;
    missing_count += missing_here;
    missing.push_back(
        fmt::format("{} from frame {}", experiment.recordings[task.recording].name, task.start));
  }
  if (missing.empty()) return rows;
  throw InputError(fmt::format("--merge: {} of {} windows are missing ({}); finish them first",
                               missing_count,
                               window_count(tasks),
                               list_of(missing)));
}

Experiment merge_experiments(std::span<const fs::path> folders, const fs::path& output) {
  Experiment experiment = read_experiment(folders.front());
  for (const fs::path& folder : folders) {
    const Experiment other = read_experiment(folder);
    if (other == experiment) continue;
    throw InputError(fmt::format("--merge: {} and {} are of different experiments (`{}` differs)",
                                 folders.front().string(),
                                 folder.string(),
                                 difference(to_json(experiment), to_json(other))));
  }
  const std::vector<Row> rows = collect_rows(experiment, folders);
  begin_experiment(output, experiment);
  const std::size_t configurations = experiment.configurations.size();
  for (std::size_t i = 0; i < rows.size(); i += configurations) {
    save_window(output, std::span(rows).subspan(i, configurations));
  }
  return experiment;
}

}  // namespace gpo
