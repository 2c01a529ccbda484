// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/configuration.h"

#include "engine/base/error.h"
#include "engine/frontend/tracking.h"
#include "engine/initializers/methods.h"
#include "engine/window/window.h"

#include <algorithm>
#include <array>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

/// A setting that differs from the default: how it is written, told and drawn.
struct Variation {
  const char* key;
  const char* title;  ///< after the method's
  std::uint32_t rgb;  ///< 0xRRGGBB, none of the methods' own
};

constexpr std::array kVariations{
    Variation{"ransac", "with RANSAC", 0x882255},
    Variation{"no-ransac", "without RANSAC", 0xBB3355},
    Variation{"gyro", "with gyroscope", 0x117733},
    Variation{"gyro-calibrated", "with calibrated gyroscope", 0x3344AA},
    Variation{"averaging", "with averaged rotations", 0xAA7711},
    Variation{"truth", "with true rotations", 0x666666},
    Variation{"anchored", "with anchored tracks", 0x44AA99},
    Variation{"per-frame", "with inliers frame by frame", 0x661100},
    Variation{"consistent", "with consistent inliers", 0x999933},
};

/// The paper's; beside them each method as it is.
constexpr std::array kAblations{
    "gpo+no-ransac", "gpo+gyro-calibrated", "gpo+averaging", "gpo+truth", "ba+ransac"};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

bool is_method(const std::string& key) {
  return std::ranges::any_of(methods(), [&](const Method& m) { return m.key == key; });
}

bool is_source(const std::string& key) {
  return std::ranges::any_of(rotation_source_keys(), [&](const char* k) { return k == key; });
}

template <Choice E>
bool is_key_of(const std::string& key) {
  return std::ranges::any_of(ChoiceKeys<E>::keys, [&](const char* k) { return k == key; });
}

std::string known_methods() {
  std::vector<std::string> keys;
  for (const Method& method : methods()) keys.push_back(method.key);
  return fmt::format("{}", fmt::join(keys, ", "));
}

void set(Configuration& configuration, const std::string& setting, const std::string& text) {
  const auto once = [&](auto& value, auto untouched, auto chosen) {
    if (value != untouched)
      throw InputError(fmt::format("--methods: '{}' sets one thing twice", text));
    value = chosen;
  };
  if (setting == "ransac" || setting == "no-ransac") {
    once(configuration.ransac, std::nullopt, setting == "ransac");
  } else if (is_source(setting)) {
    once(configuration.rotations, RotationSource::automatic, rotation_source(setting));
  } else if (is_key_of<Tracking>(setting)) {
    once(configuration.tracking, Tracking::frame_to_frame, choice<Tracking>(setting));
  } else if (is_key_of<Inliers>(setting)) {
    once(configuration.inliers, std::nullopt, choice<Inliers>(setting));
  } else {
    throw InputError(fmt::format(
        "--methods: '{}': unknown setting '{}', expected one of ransac, no-ransac, {}, {}, {}",
        text,
        setting,
        fmt::join(rotation_source_keys(), ", "),
        fmt::join(ChoiceKeys<Tracking>::keys, ", "),
        fmt::join(ChoiceKeys<Inliers>::keys, ", ")));
  }
}

std::vector<std::string> all_keys() {
  std::vector<std::string> keys;
  for (const Method& method : methods()) keys.push_back(method.key);
  keys.insert(keys.end(), kAblations.begin(), kAblations.end());
  return keys;
}

std::vector<Variation> variations(const Configuration& configuration) {
  std::vector<std::string> keys;
  if (configuration.ransac) keys.emplace_back(*configuration.ransac ? "ransac" : "no-ransac");
  if (configuration.rotations != RotationSource::automatic) {
    keys.emplace_back(to_string(configuration.rotations));
  }
  if (configuration.tracking != Tracking::frame_to_frame) {
    keys.emplace_back(to_string(configuration.tracking));
  }
  if (configuration.inliers) keys.emplace_back(to_string(*configuration.inliers));
  std::vector<Variation> found;
  found.reserve(keys.size());
  for (const std::string& key : keys) {
    found.push_back(*std::ranges::find(kVariations, key, &Variation::key));
  }
  return found;
}

/// `b` with a touch of `a`, so that the same setting of two methods is told apart.
std::uint32_t mixed(std::uint32_t a, std::uint32_t b) {
  std::uint32_t sum = 0;
  for (const int shift : {0, 8, 16}) {
    sum |= (((a >> shift & 0xFF) + 5 * (b >> shift & 0xFF)) / 6) << shift;
  }
  return sum;
}

/// Without what only says what is so by default.
Configuration without_repeated_defaults(Configuration configuration) {
  const Settings by_default{.method = configuration.method};
  if (configuration.ransac == uses_ransac(by_default)) configuration.ransac.reset();
  if (configuration.inliers == inliers_used(by_default)) configuration.inliers.reset();
  return configuration;
}

}  // namespace

Configuration parse_configuration(const std::string& text) {
  const std::vector<std::string> parts = split(text, '+');
  if (parts.empty() || !is_method(parts.front())) {
    throw InputError(fmt::format("--methods: unknown method '{}', expected all, or some of {}",
                                 parts.empty() ? "" : parts.front(),
                                 known_methods()));
  }
  Configuration configuration{.method = parts.front()};
  for (std::size_t i = 1; i < parts.size(); ++i) set(configuration, parts[i], text);
  return without_repeated_defaults(configuration);
}

std::vector<Configuration> parse_configurations(const std::string& text) {
  std::vector<Configuration> configurations;
  const auto add = [&](const std::string& key) {
    const Configuration configuration = parse_configuration(key);
    const bool had = std::ranges::find(configurations, configuration) != configurations.end();
    if (!had) configurations.push_back(configuration);
  };
  for (const std::string& key : split(text, ',')) {
    if (key == "all") {
      std::ranges::for_each(all_keys(), add);
    } else {
      add(key);
    }
  }
  if (configurations.empty()) parse_configuration("");
  return configurations;
}

std::string key_of(const Configuration& configuration) {
  std::string key = configuration.method;
  for (const Variation& variation : variations(configuration))
    key += fmt::format("+{}", variation.key);
  return key;
}

std::string title_of(const Configuration& configuration) {
  std::string title = find_method(configuration.method).title;
  for (const Variation& variation : variations(configuration))
    title += fmt::format(" {}", variation.title);
  return title;
}

std::uint32_t color_of(const Configuration& configuration) {
  std::uint32_t rgb = find_method(configuration.method).rgb;
  for (const Variation& variation : variations(configuration)) rgb = mixed(rgb, variation.rgb);
  return rgb;
}

Configuration configuration_of(const Settings& settings) {
  return without_repeated_defaults(
      {settings.method, settings.ransac, settings.rotations, settings.tracking, settings.inliers});
}

Settings apply(const Configuration& configuration, Settings settings) {
  settings.method = configuration.method;
  settings.ransac = configuration.ransac;
  settings.rotations = configuration.rotations;
  settings.tracking = configuration.tracking;
  settings.inliers = configuration.inliers;
  return settings;
}

}  // namespace gpo
