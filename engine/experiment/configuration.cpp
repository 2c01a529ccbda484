// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/experiment/experiment.h"
#include "engine/files/text_file.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr const char* kAblations =
    "gpo+no-ransac,gpo+gyro,gpo+averaging,gpo+five-point,gpo+direct,gpo+truth,ba+ransac";

using Change = Configuration::Change;

std::vector<const Setting*> comparable_settings() {
  std::vector<const Setting*> comparable;
  for (const Setting& setting : settings_table())
    if (!setting.words.empty()) comparable.push_back(&setting);
  // std::ranges::stable_partition does not compile with Clang 14.
  std::stable_partition(comparable.begin(), comparable.end(), [](const Setting* setting) {
    return setting->first_in_key;
  });
  return comparable;
}

const SettingWord& word_of(const Change& change) {
  return *std::ranges::find(find_setting(change.setting).words,
                            change.value,
                            [](const SettingWord& word) { return std::string(word.value); });
}

std::vector<std::string> keys_of(const MethodTable& methods) {
  std::vector<std::string> keys;
  for (const MethodChoice& method : methods.all()) keys.push_back(method.key());
  return keys;
}

[[noreturn]] void refuse_methods(const std::string& message) {
  throw SettingError("methods", message);
}

std::vector<Change> preset_changes(Preset preset, const MethodChoice& method) {
  const auto used = [&](Preset of) {
    Settings settings = with_preset({}, of);
    settings.options.method = method;
    return as_used(std::move(settings));
  };
  const Settings requested = used(preset);
  const Settings other = used(preset == Preset::best ? Preset::paper : Preset::best);
  std::vector<Change> changes;
  for (const Setting* setting : comparable_settings()) {
    const std::string value = value_text(setting->get(requested));
    if (is_read(*setting, method) && value != value_text(setting->get(other)))
      changes.push_back({setting->key, value});
  }
  return changes;
}

std::vector<Change> changes_of(const std::string& word,
                               const std::string& text,
                               const MethodChoice& method) {
  for (const Preset preset : {Preset::best, Preset::paper})
    if (word == to_string(preset)) return preset_changes(preset, method);
  std::vector<std::string> known;
  for (const Setting* setting : comparable_settings())
    for (const SettingWord& one : setting->words) {
      if (one.word == word) return {Change{setting->key, one.value}};
      known.emplace_back(one.word);
    }
  refuse_methods(fmt::format(
      "'{}': unknown setting '{}', expected one of {}", text, word, fmt::join(known, ", ")));
}

void check_read(const Configuration& configuration, const std::string& text) {
  const Settings used = as_used(apply(configuration, {}));
  for (const Change& change : configuration.changes) {
    const Setting& setting = find_setting(change.setting);
    if (!is_read(setting, configuration.method))
      refuse_methods(fmt::format(
          "'{}': {} does not read '{}'", text, configuration.method.key(), change.setting));
    if (value_text(setting.get(used)) != change.value)
      refuse_methods(fmt::format("'{}': {} does not take '{}' for '{}'",
                                 text,
                                 configuration.method.key(),
                                 change.value,
                                 change.setting));
  }
}

std::vector<Change> in_order(const std::vector<Change>& changes) {
  std::vector<Change> ordered;
  for (const Setting* setting : comparable_settings()) {
    const auto found = std::ranges::find(changes, setting->key, &Change::setting);
    if (found != changes.end()) ordered.push_back(*found);
  }
  return ordered;
}

std::uint32_t mixed(std::uint32_t a, std::uint32_t b) {
  std::uint32_t sum = 0;
  for (const int shift : {0, 8, 16})
    sum |= (((a >> shift & 0xFF) + 5 * (b >> shift & 0xFF)) / 6) << shift;
  return sum;
}

}  // namespace

bool Configuration::names(const std::string& setting) const {
  return std::ranges::find(changes, setting, &Change::setting) != changes.end();
}

Configuration parse_configuration(const std::string& text, const MethodTable& methods) {
  const std::vector<std::string> parts = split(text, '+');
  const std::string key = parts.empty() ? "" : parts.front();
  if (!methods.contains(key))
    refuse_methods(fmt::format(
        "unknown method '{}', expected all or some of {}", key, fmt::join(keys_of(methods), ", ")));
  const MethodChoice method = methods.find(key);
  Configuration configuration{.method = method};
  for (std::size_t i = 1; i < parts.size(); ++i) {
    for (Change& change : changes_of(parts[i], text, method)) {
      if (configuration.names(change.setting))
        refuse_methods(fmt::format("'{}' sets '{}' twice", text, change.setting));
      configuration.changes.push_back(std::move(change));
    }
  }
  check_read(configuration, text);
  configuration.changes = in_order(configuration.changes);
  return configuration;
}

std::vector<Configuration> parse_configurations(const std::string& text,
                                                const MethodTable& methods) {
  std::vector<Configuration> configurations;
  std::vector<Configuration> resolved;
  const auto add = [&](const std::string& key) {
    const Configuration configuration = parse_configuration(key, methods);
    const Configuration shortest = configuration_of(apply(configuration, {}));
    if (std::ranges::find(resolved, shortest) != resolved.end()) return;
    resolved.push_back(shortest);
    configurations.push_back(configuration);
  };
  for (const std::string& key : split(text, ',')) {
    if (key != "all") {
      add(key);
      continue;
    }
    std::ranges::for_each(keys_of(methods), add);
    std::ranges::for_each(split(kAblations, ','), add);
  }
  if (configurations.empty()) parse_configuration("");
  return configurations;
}

std::string configuration_syntax() {
  std::string syntax = "METHOD";
  for (const Setting* setting : comparable_settings()) {
    std::vector<std::string> words;
    for (const SettingWord& one : setting->words) words.emplace_back(one.word);
    syntax += fmt::format("[+{}]", fmt::join(words, "|"));
  }
  return syntax + "[+best|paper]";
}

std::string key_of(const Configuration& configuration) {
  std::string key = configuration.method;
  for (const Change& change : configuration.changes)
    key += fmt::format("+{}", word_of(change).word);
  return key;
}

std::string title_of(const Configuration& configuration) {
  std::string title = configuration.method.row().title;
  for (const Change& change : configuration.changes)
    title += fmt::format(" {}", word_of(change).title);
  return title;
}

std::uint32_t color_of(const Configuration& configuration) {
  std::uint32_t rgb = configuration.method.row().rgb;
  for (const Change& change : configuration.changes) rgb = mixed(rgb, word_of(change).rgb);
  return rgb;
}

Settings apply(const Configuration& configuration, Settings settings) {
  settings.options.method = configuration.method;
  for (const Change& change : configuration.changes)
    settings = with_setting(std::move(settings), change.setting, change.value);
  return settings;
}

Configuration configuration_of(const Settings& settings, Settings from) {
  from.options.method = settings.options.method;
  const Settings used = as_used(settings);
  const Settings usual = as_used(std::move(from));
  Configuration configuration{.method = settings.options.method};
  for (const Setting* setting : comparable_settings()) {
    const std::string value = value_text(setting->get(used));
    if (value != value_text(setting->get(usual)))
      configuration.changes.push_back({setting->key, value});
  }
  return configuration;
}

Settings base_of(std::span<const Configuration> list, Settings settings) {
  for (const Configuration& configuration : list)
    for (const Change& change : configuration.changes)
      settings = with_default(std::move(settings), change.setting);
  return settings;
}

namespace {

bool is_gpo(const Configuration& c) { return c == Configuration{.method = "gpo"}; }

bool is_of(const Configuration& c, MethodFamily family) {
  return is_gpo(c) || (c.changes.empty() && c.method.row().family == family);
}

bool varies(const Configuration& c, const char* method, const char* setting) {
  const bool only = c.changes.size() == 1 && c.names(setting);
  return c.method == method && (c.changes.empty() || only);
}

struct PaperFigure {
  const char* name;
  const char* title;
  bool (*shows)(const Configuration& configuration);
  bool needs_gpo = false;  ///< its title compares GPO with others
};

constexpr std::array kPaperFigures{
    PaperFigure{.name = "aggregation",
                .title = "GPO and aggregation-based methods",
                .shows = [](const Configuration& c) { return is_of(c, MethodFamily::aggregation); },
                .needs_gpo = true},
    PaperFigure{
        .name = "optimization",
        .title = "GPO and optimization-based methods",
        .shows = [](const Configuration& c) { return is_of(c, MethodFamily::optimization); },
        .needs_gpo = true},
    PaperFigure{.name = "gpo_ransac",
                .title = "GPO with and without RANSAC",
                .shows = [](const Configuration& c) { return varies(c, "gpo", "ransac"); }},
    PaperFigure{.name = "rotation_sources",
                .title = "GPO by the source of its rotations",
                .shows = [](const Configuration& c) { return varies(c, "gpo", "rotations"); }},
    PaperFigure{.name = "ba_ransac",
                .title = "BA with and without RANSAC",
                .shows = [](const Configuration& c) { return varies(c, "ba", "ransac"); }},
};

}  // namespace

std::vector<FigurePlan> figure_plans(const std::vector<Configuration>& configurations) {
  std::vector<FigurePlan> plans;
  std::vector<Configuration> shown;
  for (const PaperFigure& figure : kPaperFigures) {
    FigurePlan plan{figure.name, figure.title, {}};
    std::ranges::copy_if(configurations, std::back_inserter(plan.configurations), figure.shows);
    if (plan.configurations.size() < 2) continue;
    if (figure.needs_gpo && std::ranges::none_of(plan.configurations, is_gpo)) continue;
    shown.insert(shown.end(), plan.configurations.begin(), plan.configurations.end());
    plans.push_back(std::move(plan));
  }
  const bool all_shown = std::ranges::all_of(configurations, [&](const Configuration& c) {
    return std::ranges::find(shown, c) != shown.end();
  });
  if (!all_shown) plans.push_back({"configurations", "All configurations", configurations});
  return plans;
}

}  // namespace gpo
