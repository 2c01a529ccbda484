// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/runner.h"

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/stop.h"
#include "engine/experiment/recording_tables.h"
#include "engine/files/output_file.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/inspection/inspector.h"

#include <fstream>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/utsname.h>

namespace gpo {
namespace {

using nlohmann::ordered_json;

constexpr const char* kTimeOffsets = "time_offsets.csv";

fs::path definition_file(const fs::path& folder) { return folder / "experiment.json"; }

fs::path window_file(const fs::path& folder, const std::string& name, int start, int frames) {
  return folder / "windows" / fmt::format("{}-{}-{}.json", name, start, frames);
}

std::vector<std::string> differences_from(const Experiment& experiment,
                                          const ExperimentRecording& recording,
                                          const ordered_json& window) {
  std::vector<std::string> differs;
  if (window.at("program") != experiment.program) differs.emplace_back("build of the program");
  const auto content = window.at("content").get<RecordingContent>();
  for (const std::string& part : differing_parts(content, recording.content))
    differs.push_back(fmt::format("{} of {}", part, recording.name));
  return differs;
}

/// Reads the rows of the experiment's methods, except of those with another command or files.
void read_rows(const Experiment& experiment,
               const ExperimentRecording& recording,
               const ordered_json& json,
               WindowFile& window) {
  const auto identities = identities_on(experiment, recording), saved = commands_in(json);
  const auto identity_in = [](const auto& all, const std::string& key) {
    const auto found = all.find(key);
    return found == all.end() ? "" : found->second;
  };
  const MethodTable methods = methods_of(experiment);
  for (const ordered_json& row : json.at("rows")) {
    const auto configuration = std::ranges::find(
        experiment.configurations, row.at("configuration").get<std::string>(), &key_of);
    if (configuration == experiment.configurations.end()) continue;
    const std::string& method = configuration->method.key();
    if (identity_in(saved, method) != identity_in(identities, method)) {
      window.differs = {"command or files of a method"};
      continue;
    }
    window.rows[configuration - experiment.configurations.begin()] = row_from_json(row, methods);
  }
}

std::string list_of(const std::vector<std::string>& missing) {
  constexpr std::size_t kMaxNamed = 8;
  const auto named = std::min(missing.size(), kMaxNamed);
  std::string list = fmt::format("{}", fmt::join(missing.begin(), missing.begin() + named, ", "));
  if (missing.size() > named) list += fmt::format(" and {} more", missing.size() - named);
  return list;
}

std::optional<std::vector<Row>> find_window(const Experiment& experiment,
                                            std::span<const fs::path> folders,
                                            const ExperimentTask& task,
                                            int frames) {
  std::string other;
  for (const fs::path& folder : folders) {
    WindowFile window = load_window(folder, experiment, task, frames);
    if (window.complete()) {
      std::vector<Row> rows;
      for (std::optional<Row>& row : window.rows) rows.push_back(std::move(*row));
      return rows;
    }
    if (window.differs.empty() || !other.empty()) continue;
    const std::string& name = experiment.recordings[task.recording].name;
    other = fmt::format("{}: belongs to another experiment than experiment.json ({})",
                        window_file(folder, name, task.start, frames).string(),
                        differ_text(window.differs));
  }
  if (!other.empty()) throw SettingError("merge", other);
  return std::nullopt;
}

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || !line.starts_with("model name")) continue;
    return std::string(trimmed(std::string_view(line).substr(colon + 1)));
  }
  utsname system{};
  return uname(&system) == 0 ? system.machine : "unknown";
}

void forget_images(const Recording& recording) {
  if (recording.images) recording.images->forget();
}

struct Pass {
  std::vector<ExperimentTask> tasks;
  int jobs = 1;
  bool timed = false;  ///< each window decodes its images anew
};

class Run {
 public:
  Run(const Experiment& experiment,
      std::span<const std::shared_ptr<const Recording>> recordings,
      const fs::path& folder,
      const RunOptions& options)
      : experiment_(experiment), recordings_(recordings), folder_(folder), options_(options) {
    const auto all = tasks_of(experiment, options.shard);
    const auto tasks = windows_where(all, [&](const ExperimentTask& task, int frames) {
      const WindowFile window = load_window(folder, experiment, task, frames);
      progress_.kept += static_cast<int>(
          std::ranges::count_if(window.rows, [](const auto& row) { return row.has_value(); }));
      return !window.complete();
    });
    const auto results = window_count(all) * std::ssize(experiment.configurations);
    if (options.note && progress_.kept > 0 && progress_.kept < results)
      options.note(fmt::format("{}: has {} of {} results; the others are computed",
                               folder.string(),
                               progress_.kept,
                               results));
    const int timed = timed_length(experiment.lengths);
    const auto with_length = [&](bool equal) {
      return windows_where(
          tasks, [&](const ExperimentTask&, int frames) { return (frames == timed) == equal; });
    };
    passes_ = {{with_length(false), options.jobs, false},
               {with_length(true), options.timing_jobs, true}};
    progress_.of = window_count(all);
    progress_.done = progress_.of - window_count(tasks);
    for (const ExperimentTask& task : tasks)
      frames_ += std::accumulate(task.lengths.begin(), task.lengths.end(), 0.0);
    progress_.share = tasks.empty() ? 1 : 0;
    if (options_.progress) options_.progress(progress_);
  }

  bool finish() {
    const std::stop_callback forward(options_.stop, [this] { stop_.request_stop(); });
    const StopWatch watch{.stop = stop_.get_token()};
    const StopScope scope(&watch);
    try {
      run_passes();
    } catch (const Stopped&) {
      return false;  // the finished windows are saved
    }
    return progress_.done == progress_.of;
  }

 private:
  void run_passes() {
    for (const Pass& pass : passes_) {
      left_.assign(recordings_.size(), 0);
      for (const ExperimentTask& task : pass.tasks) ++left_[task.recording];
      in_parallel(static_cast<int>(pass.tasks.size()), pass.jobs, [&](int i) {
        if (!stop_.stop_requested()) work(pass.tasks[i], pass);
      });
    }
  }
  void work(const ExperimentTask& task, const Pass& pass) {
    try {
      compute(task, pass);
    } catch (...) {
      stop_.request_stop();
      throw;
    }
    // Many recordings may be open, so finished ones must not hold images.
    const std::scoped_lock lock(mutex_);
    if (--left_[task.recording] == 0) forget_images(*recordings_[task.recording]);
  }

  void compute(const ExperimentTask& task, const Pass& pass) {
    const auto& recording = recordings_[task.recording];
    if (pass.timed) forget_images(*recording);
    Inspector inspector(recording);
    // The longest window comes first: the Inspector caches its tracks for the others.
    for (auto length = task.lengths.rbegin(); length != task.lengths.rend(); ++length) {
      const int frames = *length;
      WindowFile window = load_window(folder_, experiment_, task, frames);
      std::vector<Row> rows;
      int computed = 0;
      for (std::size_t i = 0; i < window.rows.size(); ++i) {
        std::optional<Row>& row = window.rows[i];
        if (!row) {
          row = compute_row(inspector, experiment_.configurations[i], task, frames);
          if (stop_.stop_requested() || !row) return;
          row->jobs = pass.jobs;
          row->processor = processor_;
          ++computed;
        }
        rows.push_back(std::move(*row));
      }
      save_window(folder_, experiment_, rows);
      const std::scoped_lock lock(mutex_);
      ++progress_.done;
      progress_.computed += computed;
      progress_.share += frames / frames_;
      if (options_.progress) options_.progress(progress_);
    }
  }

  /// Returns nullopt if stopped.
  std::optional<Row> compute_row(Inspector& inspector,
                                 const Configuration& configuration,
                                 const ExperimentTask& task,
                                 int frames) {
    const Settings settings =
        apply(configuration,
              {.start = task.start, .frames = frames, .options = {.seed = experiment_.seed}});
    try {
      const auto inspection = inspector.inspect(settings, stop_.get_token());
      return inspection ? std::optional(make_row(*inspection)) : std::nullopt;
    } catch (const InputError& error) {
      return refused_row(recordings_[task.recording]->name, settings, error.what());
    }
  }

  const Experiment& experiment_;
  std::span<const std::shared_ptr<const Recording>> recordings_;
  const fs::path& folder_;
  const RunOptions& options_;
  const std::string processor_ = processor_name();
  std::vector<Pass> passes_;
  double frames_ = 0;  ///< in all windows of this run
  std::stop_source stop_;
  std::mutex mutex_;
  std::vector<int> left_;  ///< unfinished tasks of the pass, by recording
  ExperimentProgress progress_;
};

}  // namespace

bool run_experiment(const Experiment& experiment,
                    std::span<const std::shared_ptr<const Recording>> recordings,
                    const fs::path& folder,
                    const RunOptions& options) {
  const std::vector<std::string> differing = begin_experiment(folder, experiment);
  if (!differing.empty() && options.note)
    options.note(fmt::format("{}: {} from the earlier run; the affected windows are recomputed",
                             folder.string(),
                             differ_text(differing)));
  if (!Run(experiment, recordings, folder, options).finish()) return false;
  const Table offsets = time_offset_table(experiment, recordings);
  if (!offsets.lines.empty()) write_file(folder / kTimeOffsets, to_csv(offsets));
  return true;
}

void check_experiment_folder(const fs::path& folder) {
  check_output_folder(folder, "experiment.json");
}

std::vector<std::string> begin_experiment(const fs::path& folder, const Experiment& experiment) {
  ExperimentDifferences found;
  Experiment earlier;
  const bool fresh = !fs::exists(definition_file(folder));
  if (fresh) {
    check_experiment_folder(folder);
    make_folder(folder);
  } else {
    earlier = read_experiment(folder, methods_of(experiment));
    found = differences(earlier, experiment, /*may_add=*/true);
  }
  if (!found.plan.empty())
    refuse(definition_file(folder),
           "belongs to another experiment ({}); choose another --output, or add to its methods, "
           "lengths, starts and recordings",
           differ_text(found.plan));
  // Written first, because it marks the folder as an experiment's.
  if (fresh || !found.content.empty() || !differences(earlier, experiment).plan.empty())
    write_file(definition_file(folder), json_text(to_json(experiment), 2));
  make_folder(folder / "windows");
  return found.content;
}

Experiment read_experiment(const fs::path& folder, const MethodTable& methods) {
  const fs::path file = definition_file(folder);
  const ordered_json json = read_json(file);
  constexpr const char* kOther = "is not the definition of an experiment ({})";
  if (json.is_discarded()) refuse(file, kOther, "invalid JSON");
  try {
    return experiment_from_json(json, methods);
  } catch (const ordered_json::exception& error) {
    refuse(file, kOther, error.what());
  } catch (const InputError& error) {
    refuse(file, "{}", error.what());
  }
}

void save_window(const fs::path& folder, const Experiment& experiment, std::span<const Row> rows) {
  const Row& first = rows.front();
  const auto recording =
      std::ranges::find(experiment.recordings, first.recording, &ExperimentRecording::name);
  ordered_json json = {{"program", experiment.program},
                       {"content", recording->content},
                       {"rows", ordered_json::array()}};
  const auto identities = identities_on(experiment, *recording);
  if (!identities.empty()) json["commands"] = identities;
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
  WindowFile none;
  none.rows.resize(experiment.configurations.size());
  if (!fs::exists(file)) return none;
  try {
    WindowFile window = none;
    const ordered_json json = read_json(file);
    window.differs = differences_from(experiment, recording, json);
    if (window.differs.empty()) read_rows(experiment, recording, json, window);
    return window;
  } catch (const ordered_json::exception&) {
  } catch (const InputError&) {
  }
  return none;
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
  refuse_setting("merge",
                 "{} of {} windows are missing ({}); finish them first",
                 missing_count,
                 window_count(tasks),
                 list_of(missing));
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
    refuse_setting("merge",
                   "{} and {} belong to different experiments ({})",
                   folders.front().string(),
                   folder.string(),
                   differ_text(names));
  }
  const std::vector<Row> rows = collect_rows(experiment, folders);
  begin_experiment(output, experiment);
  const std::size_t configurations = experiment.configurations.size();
  for (std::size_t i = 0; i < rows.size(); i += configurations)
    save_window(output, experiment, std::span(rows).subspan(i, configurations));
  const fs::path offsets = folders.front() / kTimeOffsets;
  if (fs::exists(offsets)) write_file(output / kTimeOffsets, read_file(offsets));
  return experiment;
}

}  // namespace gpo
