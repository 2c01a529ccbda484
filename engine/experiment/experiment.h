// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings_table.h"

#include <nlohmann/json.hpp>

namespace gpo {

/// A method and the settings that it changes, written METHOD[+WORD...]: `gpo_joint+huber`.
struct Configuration {
  struct Change {
    std::string setting;  ///< key
    std::string value;    ///< syntax of `setting_text`
    bool operator==(const Change&) const = default;
  };
  MethodChoice method = "";
  std::vector<Change> changes = {};  ///< each setting once, in the order of their words

  bool names(const std::string& setting) const;
  bool operator==(const Configuration&) const = default;
};

/// Throws SettingError "methods: ..." for unknown words and options that the method does not read.
Configuration parse_configuration(const std::string& text, const MethodTable& methods = {});

/// Parses a list; `all`: each method and ablation. Drops repeated ones. Throws SettingError.
std::vector<Configuration> parse_configurations(const std::string& text,
                                                const MethodTable& methods = {});

std::string configuration_syntax();

std::string key_of(const Configuration& configuration);
std::string title_of(const Configuration& configuration);
std::uint32_t color_of(const Configuration& configuration);

Settings apply(const Configuration& configuration, Settings settings);

/// Returns the shortest configuration that turns `from` into these settings, as they are used.
Configuration configuration_of(const Settings& settings, Settings from = {});

/// Returns the settings, but the default of each setting that any configuration names.
Settings base_of(std::span<const Configuration> list, Settings settings);

struct FigurePlan {
  std::string name;  ///< base name of its files
  std::string title;
  std::vector<Configuration> configurations;
};

/// Returns the paper's figures of at least two of these, and one of all if these lack any.
std::vector<FigurePlan> figure_plans(const std::vector<Configuration>& configurations);

constexpr int kPaperFrames = 30;  ///< window length of the running times in the paper

struct Range {
  int first = 0;
  std::optional<int> last;  ///< nullopt: `end`, which depends on the recording
  int step = 1;

  bool operator==(const Range&) const = default;
};

/// Parses `A`, `A:B`, `A:B:STEP` and lists of these; B may be `end`. Throws InputError.
std::vector<Range> parse_ranges(const std::string& text, const std::string& name);

std::vector<int> numbers_in(const std::vector<Range>& ranges, int end);

struct ExperimentRecording {
  std::string name;  ///< unique
  fs::path path;     ///< given by the user; not part of the content
  int frames = 0;
  std::vector<int> starts = {};
  RecordingContent content = {};  ///< everything that the results depend on

  bool operator==(const ExperimentRecording&) const = default;
};

struct Experiment {
  std::vector<ExperimentRecording> recordings;
  std::vector<int> lengths;  ///< window lengths, ascending [frames]
  std::vector<Configuration> configurations;
  std::uint64_t seed = 1;
  std::string program = {};                          ///< version
  std::map<std::string, std::string> commands = {};  ///< identities of the user's methods, by key

  bool operator==(const Experiment&) const = default;
};

MethodTable methods_of(const Experiment& experiment);

/// If nothing differs, results are equal except for running times, wherever the files are.
struct ExperimentDifferences {
  std::vector<std::string> plan;     ///< different requests: "lengths", "methods"
  std::vector<std::string> content;  ///< same request, different input: "fx of desk"
};
ExperimentDifferences differences(const Experiment& a, const Experiment& b);

std::string differ_text(const std::vector<std::string>& names);

struct ExperimentRequest {
  std::vector<Configuration> configurations;
  std::vector<Range> lengths;
  std::vector<Range> starts;  ///< `end`: the last start that fits the longest window
  std::uint64_t seed = 1;
};

/// Throws InputError if two recordings have the same name, no window fits or an image is missing.
Experiment plan_experiment(std::span<const std::shared_ptr<const Recording>> recordings,
                           const ExperimentRequest& request);

std::vector<std::string> notes_of(const Experiment& experiment);

struct ExperimentTask {
  std::size_t recording = 0;  ///< index
  int start = 0;
  std::vector<int> lengths;  ///< that fit, ascending; at least one
};

std::vector<ExperimentTask> tasks_of(const Experiment& experiment);

std::vector<ExperimentTask> windows_where(
    std::vector<ExperimentTask> tasks,
    const std::function<bool(const ExperimentTask& task, int frames)>& keep);

/// Part K of N, written `K/N`. The parts are consecutive and differ by at most one window.
struct Shard {
  int index = 1;  ///< from 1
  int count = 1;
};
Shard parse_shard(const std::string& text);
std::vector<ExperimentTask> tasks_of(const Experiment& experiment, const Shard& shard);

int window_count(std::span<const ExperimentTask> tasks);

/// The length for running times: 30 frames, else the longest shorter length, else the shortest.
int timed_length(const std::vector<int>& lengths);

nlohmann::ordered_json to_json(const Experiment& experiment);
std::map<std::string, std::string> commands_in(const nlohmann::ordered_json& json);
/// Reads the output of `to_json`. Throws nlohmann::json::exception or InputError.
Experiment experiment_from_json(const nlohmann::ordered_json& json,
                                const MethodTable& methods = {});

}  // namespace gpo
