// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// A difference between two settings: a method, and the values that it names by their words in
/// `settings_table`. Written METHOD[+WORD...]: `gpo`, `gpo+no-ransac`, `gpo_joint+huber`. What it
/// does not name is as in the settings that it is applied to.
struct Configuration {
  struct Change {
    std::string setting;  ///< key
    std::string value;    ///< as `setting_text` writes it
    bool operator==(const Change&) const = default;
  };
  MethodChoice method = "";
  std::vector<Change> changes = {};  ///< each setting once, in the order of their words

  bool names(const std::string& setting) const;
  bool operator==(const Configuration&) const = default;
};

/// Reads one. Throws SettingError "methods: ..." that names what was found and what is known, also
/// for an option that the method does not read.
Configuration parse_configuration(const std::string& text, const MethodTable& methods = {});

/// Reads a list with commas; of those that come to the same by default, the first. `all` stands for
/// every method and the paper's ablations. Throws SettingError.
std::vector<Configuration> parse_configurations(const std::string& text,
                                                const MethodTable& methods = {});

/// METHOD[+WORD1|WORD2][+WORD3...], for help: all words, those of one setting together.
std::string configuration_syntax();

/// As it is written on the command line and in files.
std::string key_of(const Configuration& configuration);
/// For people: "GPO without RANSAC".
std::string title_of(const Configuration& configuration);
/// The method's color, or for an ablation one of its own; 0xRRGGBB.
std::uint32_t color_of(const Configuration& configuration);

/// The settings with the method and all that the configuration names.
Settings apply(const Configuration& configuration, Settings settings);

/// How these settings, as they are used, differ from others in what configurations name: the
/// shortest configuration that comes to them from there. From the defaults: what a result is
/// called.
Configuration configuration_of(const Settings& settings, Settings from = {});

/// What all of a list are applied to: the settings, but what any of them names is by default, since
/// it is what they are compared by. So `gpo,gpo+no-ransac` is one with and one without RANSAC,
/// whatever the settings say of it, and both are tracked as the settings say.
Settings base_of(std::span<const Configuration> list, Settings settings);

}  // namespace gpo
