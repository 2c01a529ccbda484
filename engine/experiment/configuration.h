// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings_table.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gpo {

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

/// Returns the text of the command line and of files.
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

/// The comparison that a figure shows.
struct FigurePlan {
  std::string name;  ///< base name of its files
  std::string title;
  std::vector<Configuration> configurations;
};

/// Returns the paper's figures whose titles fit at least two of the configurations, and one figure
/// of all configurations if any is missing in these.
std::vector<FigurePlan> figure_plans(const std::vector<Configuration>& configurations);

}  // namespace gpo
