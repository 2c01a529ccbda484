// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/configuration.h"
#include "engine/experiment/ranges.h"
#include "engine/recording/recording.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace gpo {

/// A recording of an experiment, and where its windows start.
struct ExperimentRecording {
  std::string name;            ///< no two have the same
  std::filesystem::path path;  ///< as it was given
  int frames = 0;
  std::vector<int> starts;

  bool operator==(const ExperimentRecording&) const = default;
};

/// What is compared on what: recordings x starts x lengths x configurations. All that the results
/// depend on; equal experiments have equal results, times aside.
struct Experiment {
  std::vector<ExperimentRecording> recordings;
  std::vector<int> lengths;  ///< of the windows, ascending [frames]
  std::vector<Configuration> configurations;
  std::uint64_t seed = 1;

  bool operator==(const Experiment&) const = default;
};

/// What a user asks for.
struct ExperimentRequest {
  std::vector<Configuration> configurations;
  std::vector<Range> lengths;
  std::vector<Range> starts;  ///< `end`: the last from which the longest window fits
  std::uint64_t seed = 1;
};

/// Throws InputError where two recordings have one name or no window fits.
Experiment plan_experiment(std::span<const std::shared_ptr<const Recording>> recordings,
                           const ExperimentRequest& request);

/// "NAME: 40 frames, too short for windows of 45, 50, 55, 60 frames": windows that are not there.
std::vector<std::string> notes_of(const Experiment& experiment);

/// The windows from one start share their tracks and are computed together.
struct ExperimentTask {
  std::size_t recording = 0;  ///< index
  int start = 0;
  std::vector<int> lengths;  ///< those that fit, ascending; at least one
};

/// In the order of the results.
std::vector<ExperimentTask> tasks_of(const Experiment& experiment);

/// K of N, written `K/N`: every N-th task, from the K-th on.
struct Shard {
  int index = 1;  ///< from 1
  int count = 1;
};
/// Throws InputError.
Shard parse_shard(const std::string& text);
std::vector<ExperimentTask> tasks_of(const Experiment& experiment, const Shard& shard);

int window_count(std::span<const ExperimentTask> tasks);

nlohmann::ordered_json to_json(const Experiment& experiment);
/// Throws nlohmann::json::exception or InputError for anything but what `to_json` wrote.
Experiment experiment_from_json(const nlohmann::ordered_json& json);

}  // namespace gpo
