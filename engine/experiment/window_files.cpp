// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/window_files.h"

#include "engine/base/error.h"
#include "engine/files/json_text.h"
#include "engine/files/output_file.h"

#include <algorithm>
#include <utility>

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

/// Returns the names of what differs between a window's file and the experiment.
std::vector<std::string> differences_from(const Experiment& experiment,
                                          const ExperimentRecording& recording,
                                          const ordered_json& window) {
  std::vector<std::string> differs;
  if (window.at("program") != experiment.program) differs.emplace_back("version of the program");
  if (commands_in(window) != experiment.commands)
    differs.emplace_back("command or files of a method");
  const auto content = window.at("content").get<RecordingContent>();
  for (const std::string& part : differing_parts(content, recording.content))
    differs.push_back(fmt::format("{} of {}", part, recording.name));
  return differs;
}

/// Returns "desk from frame 10, ...", shortened to one line.
std::string list_of(const std::vector<std::string>& missing) {
  constexpr std::size_t kMaxNamed = 8;
  const auto named = std::min(missing.size(), kMaxNamed);
  std::string list = fmt::format("{}", fmt::join(missing.begin(), missing.begin() + named, ", "));
  if (missing.size() > named) list += fmt::format(" and {} more", missing.size() - named);
  return list;
}

/// Returns the rows from the first folder that has the window. Throws InputError if only windows of
/// another experiment exist.
std::optional<std::vector<Row>> find_window(const Experiment& experiment,
                                            std::span<const fs::path> folders,
                                            const ExperimentTask& task,
                                            int frames) {
  std::string other;
  for (const fs::path& folder : folders) {
    WindowFile window = load_window(folder, experiment, task, frames);
    if (window.rows) return std::move(window.rows);
    if (window.differs.empty() || !other.empty()) continue;
    const std::string& name = experiment.recordings[task.recording].name;
    other = fmt::format("{}: belongs to another experiment than experiment.json ({})",
                        window_file(folder, name, task.start, frames).string(),
                        differ_text(window.differs));
  }
  if (!other.empty()) throw SettingError("merge", other);
  return std::nullopt;
}

}  // namespace

void check_experiment_folder(const fs::path& folder) {
  check_output_folder(folder, "experiment.json");
}

std::vector<std::string> begin_experiment(const fs::path& folder, const Experiment& experiment) {
  ExperimentDifferences found;
  const bool fresh = !fs::exists(definition_file(folder));
  if (fresh) {
    check_experiment_folder(folder);
    make_folder(folder);
  } else {
    found = differences(read_experiment(folder, methods_of(experiment)), experiment);
  }
  if (!found.plan.empty())
    throw InputError(fmt::format("{}: belongs to another experiment ({}); choose another --output",
                                 definition_file(folder).string(),
                                 differ_text(found.plan)));
  // Written first, because it marks the folder as an experiment's.
  if (fresh || !found.content.empty())
    write_file(definition_file(folder), json_text(to_json(experiment), 2));
  make_folder(folder / "windows");
  return found.content;
}

Experiment read_experiment(const fs::path& folder, const MethodTable& methods) {
  const fs::path file = definition_file(folder);
  const ordered_json json = read_json(file);
  const auto fail = [&](const std::string& why) {
    throw InputError(
        fmt::format("{}: is not the definition of an experiment ({})", file.string(), why));
  };
  if (json.is_discarded()) fail("no JSON");
  try {
    return experiment_from_json(json, methods);
  } catch (const ordered_json::exception& error) {
    fail(error.what());
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
  return {};
}

void save_window(const fs::path& folder, const Experiment& experiment, std::span<const Row> rows) {
  const Row& first = rows.front();
  const auto recording =
      std::ranges::find(experiment.recordings, first.recording, &ExperimentRecording::name);
  ordered_json json = {{"program", experiment.program},
                       {"content", recording->content},
                       {"rows", ordered_json::array()}};
  if (!experiment.commands.empty()) json["commands"] = experiment.commands;
  for (const Row& row : rows) json["rows"].push_back(to_json(row));
  write_file(window_file(folder, first.recording, first.settings.start, first.settings.frames),
             json_text(json, 1));
}

WindowFile load_window(const fs::path& folder,
                       const Experiment& experiment,
                       const ExperimentTask& task,
                       int frames) {
  const ExperimentRecording& recording = experiment.recordings[task.recording];
  const fs::path file = window_file(folder, recording.name, task.start, frames);
  if (!fs::exists(file)) return {};
  try {
    const ordered_json json = read_json(file);
    std::vector<std::string> differs = differences_from(experiment, recording, json);
    if (!differs.empty()) return {std::nullopt, std::move(differs)};
    std::vector<Row> rows;
    const MethodTable methods = methods_of(experiment);
    for (const ordered_json& row : json.at("rows")) rows.push_back(row_from_json(row, methods));
    const bool complete =
        std::ranges::equal(rows, experiment.configurations, {}, &Row::configuration, &key_of);
    if (complete) return {std::move(rows), {}};
  } catch (const ordered_json::exception&) {
  } catch (const InputError&) {
  }
  return {};
}

std::vector<Row> collect_rows(const Experiment& experiment, std::span<const fs::path> folders) {
  std::vector<Row> rows;
  std::vector<std::string> missing;
  int missing_count = 0;
  const std::vector<ExperimentTask> tasks = tasks_of(experiment);
  for (const ExperimentTask& task : tasks) {
    int missing_here = 0;
    for (const int frames : task.lengths) {
      const auto window = find_window(experiment, folders, task, frames);
      if (window) rows.insert(rows.end(), window->begin(), window->end());
      if (!window) ++missing_here;
    }
    if (missing_here == 0) continue;
    missing_count += missing_here;
    missing.push_back(
        fmt::format("{} from frame {}", experiment.recordings[task.recording].name, task.start));
  }
  if (missing.empty()) return rows;
  throw SettingError("merge",
                     fmt::format("{} of {} windows are missing ({}); finish them first",
                                 missing_count,
                                 window_count(tasks),
                                 list_of(missing)));
}

Experiment merge_experiments(std::span<const fs::path> folders,
                             const fs::path& output,
                             const MethodTable& methods) {
  Experiment experiment = read_experiment(folders.front(), methods);
  for (const fs::path& folder : folders) {
    ExperimentDifferences found = differences(experiment, read_experiment(folder, methods));
    std::vector<std::string>& names = found.plan;
    names.insert(names.end(), found.content.begin(), found.content.end());
    if (names.empty()) continue;
    throw SettingError("merge",
                       fmt::format("{} and {} belong to different experiments ({})",
                                   folders.front().string(),
                                   folder.string(),
                                   differ_text(names)));
  }
  const std::vector<Row> rows = collect_rows(experiment, folders);
  begin_experiment(output, experiment);
  const std::size_t configurations = experiment.configurations.size();
  for (std::size_t i = 0; i < rows.size(); i += configurations)
    save_window(output, experiment, std::span(rows).subspan(i, configurations));
  return experiment;
}

}  // namespace gpo
