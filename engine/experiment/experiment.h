// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/configuration.h"
#include "engine/recording/content.h"
#include "engine/recording/recording.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace gpo {

constexpr int kPaperFrames = 30;  ///< of the windows whose running times the paper tells

/// Whole numbers from `first` to `last`, both included, every `step`-th.
struct Range {
  int first = 0;
  std::optional<int> last;  ///< nothing: `end`, known once there is a recording
  int step = 1;

  bool operator==(const Range&) const = default;
};

/// Reads `A`, `A:B`, `A:B:STEP`, and lists of these with commas; B may be `end`. `name` is named
/// in the InputError.
std::vector<Range> parse_ranges(const std::string& text, const std::string& name);

/// The numbers in all of the ranges, ascending, each once; `end` stands for `end`.
std::vector<int> numbers_in(const std::vector<Range>& ranges, int end);

/// A recording of an experiment, and where its windows start.
struct ExperimentRecording {
  std::string name;            ///< no two have the same
  std::filesystem::path path;  ///< as it was given; says nothing of what is there
  int frames = 0;
  std::vector<int> starts;
  RecordingContent content = {};  ///< what the results depend on

  bool operator==(const ExperimentRecording&) const = default;
};

/// What is compared on what: recordings x starts x lengths x configurations, and by which program.
/// All that the results depend on.
struct Experiment {
  std::vector<ExperimentRecording> recordings;
  std::vector<int> lengths;  ///< of the windows, ascending [frames]
  std::vector<Configuration> configurations;
  std::uint64_t seed = 1;
  std::string program = {};  ///< its version
  /// Of the user's own methods among them what they are, by their keys.
  std::map<std::string, std::string> commands = {};

  bool operator==(const Experiment&) const = default;
};

/// The methods that its configurations choose from.
MethodTable methods_of(const Experiment& experiment);

/// In what two experiments differ, by names; where they do not, results are the same, times aside,
/// wherever their recordings lie.
struct ExperimentDifferences {
  std::vector<std::string> plan;     ///< they ask for other things: "lengths", "methods"
  std::vector<std::string> content;  ///< they ask the same of other things: "fx of desk"
};
ExperimentDifferences differences(const Experiment& a, const Experiment& b);

/// "`lengths` differs" or "`lengths`, `methods` differ".
std::string differ_text(const std::vector<std::string>& names);

/// What a user asks for.
struct ExperimentRequest {
  std::vector<Configuration> configurations;
  std::vector<Range> lengths;
  std::vector<Range> starts;  ///< `end`: the last from which the longest window fits
  std::uint64_t seed = 1;
};

/// Throws InputError where two recordings have one name, no window fits, or a picture's file has
/// gone.
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

/// K of N, written `K/N`: of the windows in their order an N-th part, the K-th, so that those from
/// one start are together as far as the parts, which differ by one window at most, allow.
struct Shard {
  int index = 1;  ///< from 1
  int count = 1;
};
/// Throws InputError.
Shard parse_shard(const std::string& text);
std::vector<ExperimentTask> tasks_of(const Experiment& experiment, const Shard& shard);

int window_count(std::span<const ExperimentTask> tasks);

/// Of the windows whose running times are compared: the paper's 30 frames, or the longest length
/// below, or where all are longer the shortest. `lengths`: ascending, at least one.
int timed_length(const std::vector<int>& lengths);

nlohmann::ordered_json to_json(const Experiment& experiment);
/// Of an experiment's file, or a window's. Throws nlohmann::json::exception.
std::map<std::string, std::string> commands_in(const nlohmann::ordered_json& json);
/// Throws nlohmann::json::exception or InputError for anything but what `to_json` wrote.
Experiment experiment_from_json(const nlohmann::ordered_json& json,
                                const MethodTable& methods = {});

}  // namespace gpo
