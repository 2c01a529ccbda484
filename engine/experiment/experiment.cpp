// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/experiment.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using nlohmann::ordered_json;

/// Of the files of an experiment; other programs' are refused.
constexpr int kFormat = 1;

/// From a start so many frames fit; empty where none does.
std::vector<int> fitting(const std::vector<int>& lengths, int frames) {
  std::vector<int> fit;
  std::ranges::copy_if(lengths, std::back_inserter(fit), [&](int n) { return n <= frames; });
  return fit;
}

ExperimentRecording plan_recording(const Recording& recording,
                                   const std::vector<int>& lengths,
                                   const std::vector<Range>& starts) {
  const int frames = recording.frame_count();
  const std::vector<int> fit = fitting(lengths, frames);
  ExperimentRecording planned{recording.name, recording.path, frames, {}};
  if (fit.empty()) return planned;
  planned.starts = numbers_in(starts, frames - fit.back());
  std::erase_if(planned.starts, [&](int start) { return start + fit.front() > frames; });
  return planned;
}

void check_names(const std::vector<ExperimentRecording>& recordings) {
  for (auto it = recordings.begin(); it != recordings.end(); ++it) {
    const auto other = std::find_if(
        recordings.begin(), it, [&](const ExperimentRecording& r) { return r.name == it->name; });
    if (other == it) continue;
    throw InputError(
        fmt::format("{} and {}: two recordings have the name '{}', which the results go by",
                    other->path.string(),
                    it->path.string(),
                    it->name));
  }
}

}  // namespace

Experiment plan_experiment(std::span<const std::shared_ptr<const Recording>> recordings,
                           const ExperimentRequest& request) {
  Experiment experiment;
  for (const Configuration& one : request.configurations)
    experiment.configurations.push_back(configuration_of(apply(one, {})));
  experiment.seed = request.seed;
  int most_frames = 0;
  for (const auto& recording : recordings) {
    most_frames = std::max(most_frames, recording->frame_count());
  }
  experiment.lengths = numbers_in(request.lengths, most_frames);
  if (experiment.lengths.empty() || experiment.lengths.front() < 2) {
    throw InputError("--lengths: a window has at least 2 frames");
  }
  for (const auto& recording : recordings) {
    experiment.recordings.push_back(plan_recording(*recording, experiment.lengths, request.starts));
  }
  check_names(experiment.recordings);
  if (tasks_of(experiment).empty()) {
    throw InputError(fmt::format(
        "--lengths, --starts: no window fits, {}",
        most_frames == 0 ? "there is no recording"
                         : fmt::format("the longest recording has {} frames", most_frames)));
  }
  return experiment;
}

std::vector<std::string> notes_of(const Experiment& experiment) {
  std::vector<std::string> notes;
  for (const ExperimentRecording& recording : experiment.recordings) {
    const auto first_long = std::ranges::upper_bound(experiment.lengths, recording.frames);
    if (first_long == experiment.lengths.end()) continue;
    notes.push_back(fmt::format("{}: {} frames, too short for windows of {} frames",
                                recording.name,
                                recording.frames,
                                fmt::join(first_long, experiment.lengths.end(), ", ")));
  }
  return notes;
}

std::vector<ExperimentTask> tasks_of(const Experiment& experiment) {
  std::vector<ExperimentTask> tasks;
  for (std::size_t r = 0; r < experiment.recordings.size(); ++r) {
    const ExperimentRecording& recording = experiment.recordings[r];
    for (const int start : recording.starts) {
      tasks.push_back({r, start, fitting(experiment.lengths, recording.frames - start)});
    }
  }
  return tasks;
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  char rest = 0;
  const int read = std::sscanf(text.c_str(), "%d/%d%c", &shard.index, &shard.count, &rest);
  if (read != 2 || shard.index < 1 || shard.index > shard.count) {
    throw InputError(fmt::format("--shard: '{}', expected K/N with K from 1 to N, e.g. 2/8", text));
  }
  return shard;
}

std::vector<ExperimentTask> tasks_of(const Experiment& experiment, const Shard& shard) {
  std::vector<ExperimentTask> share;
  const std::vector<ExperimentTask> tasks = tasks_of(experiment);
  for (std::size_t i = shard.index - 1; i < tasks.size(); i += shard.count) {
    share.push_back(tasks[i]);
  }
  return share;
}

int window_count(std::span<const ExperimentTask> tasks) {
  return std::accumulate(tasks.begin(), tasks.end(), 0, [](int sum, const ExperimentTask& task) {
    return sum + static_cast<int>(task.lengths.size());
  });
}

ordered_json to_json(const Experiment& experiment) {
  ordered_json recordings = ordered_json::array();
  for (const ExperimentRecording& recording : experiment.recordings) {
    recordings.push_back({{"name", recording.name},
                          {"path", recording.path.string()},
                          {"frames", recording.frames},
                          {"starts", recording.starts}});
  }
  ordered_json configurations = ordered_json::array();
  for (const Configuration& configuration : experiment.configurations) {
    configurations.push_back(key_of(configuration));
  }
  return {{"format", kFormat},
          {"recordings", std::move(recordings)},
          {"lengths", experiment.lengths},
          {"configurations", std::move(configurations)},
          {"seed", experiment.seed}};
}

Experiment experiment_from_json(const ordered_json& json) {
  if (json.at("format") != kFormat) throw InputError("key `format`: of another program version");
  Experiment experiment;
  for (const ordered_json& recording : json.at("recordings")) {
    experiment.recordings.push_back({recording.at("name").get<std::string>(),
                                     recording.at("path").get<std::string>(),
                                     recording.at("frames").get<int>(),
                                     recording.at("starts").get<std::vector<int>>()});
  }
  experiment.lengths = json.at("lengths").get<std::vector<int>>();
  for (const ordered_json& key : json.at("configurations")) {
    experiment.configurations.push_back(parse_configuration(key.get<std::string>()));
  }
  experiment.seed = json.at("seed").get<std::uint64_t>();
  return experiment;
}

}  // namespace gpo
