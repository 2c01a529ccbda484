// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings_table.h"

#include <nlohmann/json.hpp>

namespace gpo {

struct Inspection;

/// A method and the settings that it changes, written METHOD[+WORD...] with the words of
/// `settings_table`: `gpo`, `gpo+no-ransac`, `gpo_joint+huber`.
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

/// Parses one configuration. Throws SettingError "methods: ..." for unknown words and for options
/// that the method does not read.
Configuration parse_configuration(const std::string& text, const MethodTable& methods = {});

/// Parses a list with commas; `all` stands for every method and the paper's ablations. Drops
/// configurations that equal an earlier one by default. Throws SettingError.
std::vector<Configuration> parse_configurations(const std::string& text,
                                                const MethodTable& methods = {});

/// Returns METHOD[+WORD1|WORD2][+WORD3...] for help texts, with the words of each setting.
std::string configuration_syntax();

/// Returns the configuration as written on the command line and in files.
std::string key_of(const Configuration& configuration);
/// Returns a title for people: "GPO without RANSAC".
std::string title_of(const Configuration& configuration);
/// Returns the method's color, mixed with that of each change; 0xRRGGBB.
std::uint32_t color_of(const Configuration& configuration);

Settings apply(const Configuration& configuration, Settings settings);

/// Returns the shortest configuration that turns `from` into these settings, as they are used.
Configuration configuration_of(const Settings& settings, Settings from = {});

/// Returns the common base of a comparison: the settings, but the default of each setting that any
/// configuration names. `gpo,gpo+no-ransac` so compares with and without RANSAC, whatever the
/// settings.
Settings base_of(std::span<const Configuration> list, Settings settings);

/// The result of one compared configuration.
struct Compared {
  Configuration configuration;  ///< names it
  Settings settings;
  std::shared_ptr<const Inspection> inspection = {};  ///< null: not computed yet
  std::string error = {};  ///< reason of failure, one line; empty: it is being computed
};

/// The comparison that a figure shows.
struct FigurePlan {
  std::string name;  ///< base name of its files
  std::string title;
  std::vector<Configuration> configurations;
};

/// Returns the paper's figures whose titles fit at least two of the configurations, and one figure
/// of all configurations if any is missing in these.
std::vector<FigurePlan> figure_plans(const std::vector<Configuration>& configurations);

constexpr int kPaperFrames = 30;  ///< window length of the running times in the paper

/// Integers from `first` to `last`, both included, in steps.
struct Range {
  int first = 0;
  std::optional<int> last;  ///< nullopt: `end`, which depends on the recording
  int step = 1;

  bool operator==(const Range&) const = default;
};

/// Parses `A`, `A:B`, `A:B:STEP`, and lists of these with commas; B may be `end`. Throws an
/// InputError that starts with `name`.
std::vector<Range> parse_ranges(const std::string& text, const std::string& name);

/// Returns the integers of all ranges, ascending and unique.
std::vector<int> numbers_in(const std::vector<Range>& ranges, int end);

/// A recording of an experiment and the starts of its windows.
struct ExperimentRecording {
  std::string name;  ///< unique
  fs::path path;     ///< given by the user; not part of the content
  int frames = 0;
  std::vector<int> starts = {};
  RecordingContent content = {};  ///< everything that the results depend on

  bool operator==(const ExperimentRecording&) const = default;
};

/// The plan of a comparison: recordings x starts x lengths x configurations, and everything else
/// that the results depend on.
struct Experiment {
  std::vector<ExperimentRecording> recordings;
  std::vector<int> lengths;  ///< window lengths, ascending [frames]
  std::vector<Configuration> configurations;
  std::uint64_t seed = 1;
  std::string program = {};                          ///< version and build id
  std::map<std::string, std::string> commands = {};  ///< identities of the user's methods, by key

  bool operator==(const Experiment&) const = default;
};

MethodTable methods_of(const Experiment& experiment);

/// Returns version and build id of this program: programs of one version may differ.
std::string program_identity();

/// Returns the identities of the user's methods on a recording, by key.
std::map<std::string, std::string> identities_on(const Experiment& experiment,
                                                 const ExperimentRecording& recording);

/// The names of what differs between two experiments. If there are none, their results are equal
/// except for running times, wherever the recordings are stored.
struct ExperimentDifferences {
  std::vector<std::string> plan;     ///< different requests: "lengths", "methods"
  std::vector<std::string> content;  ///< same request, different input: "fx of desk"
};
/// `may_add`: `b` is a later experiment in the folder of `a` and may add methods, lengths, starts
/// and recordings. `plan` then names what it lacks.
ExperimentDifferences differences(const Experiment& a, const Experiment& b, bool may_add = false);

/// Returns "`lengths` differs" or "`lengths`, `methods` differ".
std::string differ_text(const std::vector<std::string>& names);

struct ExperimentRequest {
  std::vector<Configuration> configurations;
  std::vector<Range> lengths;
  std::vector<Range> starts;  ///< `end`: the last start that fits the longest window
  std::uint64_t seed = 1;
};

/// Throws InputError if two recordings have the same name, no window fits or an image file is
/// missing.
Experiment plan_experiment(std::span<const std::shared_ptr<const Recording>> recordings,
                           const ExperimentRequest& request);

/// Returns notes like "NAME: 40 frames, too short for windows of 45, 50, 55, 60 frames".
std::vector<std::string> notes_of(const Experiment& experiment);

/// The windows from one start, which share their tracks and are computed together.
struct ExperimentTask {
  std::size_t recording = 0;  ///< index
  int start = 0;
  std::vector<int> lengths;  ///< that fit, ascending; at least one
};

/// Returns the tasks in the order of the results.
std::vector<ExperimentTask> tasks_of(const Experiment& experiment);

/// Returns the windows for which `keep(task, frames)` holds; drops tasks without any.
std::vector<ExperimentTask> windows_where(
    std::vector<ExperimentTask> tasks,
    const std::function<bool(const ExperimentTask& task, int frames)>& keep);

/// Part K of N, written `K/N`. The parts are consecutive and differ by at most one window.
struct Shard {
  int index = 1;  ///< from 1
  int count = 1;
};
/// Throws SettingError.
Shard parse_shard(const std::string& text);
std::vector<ExperimentTask> tasks_of(const Experiment& experiment, const Shard& shard);

int window_count(std::span<const ExperimentTask> tasks);

/// Returns the length of the windows whose running times are compared: 30 frames as in the paper,
/// else the longest shorter length, else the shortest; 0 if there is none. `lengths`: ascending.
int timed_length(const std::vector<int>& lengths);

nlohmann::ordered_json to_json(const Experiment& experiment);
/// Reads `commands` of an experiment's or a window's file. Throws nlohmann::json::exception.
std::map<std::string, std::string> commands_in(const nlohmann::ordered_json& json);
/// Reads the output of `to_json`. Throws nlohmann::json::exception or InputError.
Experiment experiment_from_json(const nlohmann::ordered_json& json,
                                const MethodTable& methods = {});

}  // namespace gpo
