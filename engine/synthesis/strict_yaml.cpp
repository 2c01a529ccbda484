// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/strict_yaml.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

std::string expectation(const char* what, const Bounds& range) {
  std::string text = what;
  if (!range.unit.empty()) text += fmt::format(" [{}]", range.unit);
  if (std::isfinite(range.low) && std::isfinite(range.high))
    return text + fmt::format(" from {} to {}", range.low, range.high);
  return std::isfinite(range.low) ? text + fmt::format(" of at least {}", range.low) : text;
}

double number_within(const YamlEntry& entry, const Bounds& range) {
  const std::string expected = expectation("a number", range);
  const double value = number(entry, expected);
  if (value < range.low || value > range.high) yaml_fail(entry, expected);
  return value;
}

}  // namespace

StrictMap::StrictMap(YamlEntry map) : map_(std::move(map)) {
  if (!map_.node.IsMap()) yaml_fail(map_, "keys and values");
  std::set<std::string> keys;
  for (const auto& entry : map_.node) {
    const auto key = entry.first.as<std::string>("");
    if (!keys.insert(key).second)
      yaml_fail(below(map_, key, entry.first), "a second time", "each key once");
  }
}

void StrictMap::fail(const std::string& key,
                     const std::string& found,
                     const std::string& expected) const {
  yaml_fail(at(map_, key, expected), found, expected);
}

bool StrictMap::has(const std::string& key) {
  requested_.insert(key);
  return find(map_, key).has_value();
}

YamlEntry StrictMap::take(const std::string& key, const std::string& expected) {
  requested_.insert(key);
  return at(map_, key, expected);
}

double StrictMap::number(const std::string& key,
                         const Bounds& range,
                         std::optional<double> otherwise) {
  if (otherwise && !has(key)) return *otherwise;
  return number_within(take(key, expectation("a number", range)), range);
}

std::int64_t StrictMap::read_integer(const std::string& key,
                                     const Bounds& range,
                                     std::optional<std::int64_t> otherwise) {
  if (otherwise && !has(key)) return *otherwise;
  const std::string expected = expectation("a whole number", range);
  const YamlEntry entry = take(key, expected);
  const std::int64_t value = gpo::integer(entry, expected);
  const auto rounded = static_cast<double>(value);
  if (rounded < range.low || rounded > range.high) yaml_fail(entry, expected);
  return value;
}

std::string StrictMap::choice(const std::string& key,
                              const std::vector<std::string>& choices,
                              const std::optional<std::string>& otherwise) {
  if (otherwise && !has(key)) return *otherwise;
  const std::string expected = fmt::format("one of {}", fmt::join(choices, ", "));
  const YamlEntry entry = take(key, expected);
  std::string chosen = text(entry, expected);
  if (std::ranges::find(choices, chosen) == choices.end()) yaml_fail(entry, expected);
  return chosen;
}

std::vector<double> StrictMap::numbers(const std::string& key,
                                       const Bounds& range,
                                       int least,
                                       int most) {
  const std::string count =
      least == most ? std::to_string(least) : fmt::format("{} to {}", least, most);
  const std::string expected = fmt::format("a list of {} numbers", count);
  const YamlEntry list = take(key, expected);
  const int size = static_cast<int>(list.node.size());
  if (!list.node.IsSequence() || size < least || size > most) yaml_fail(list, expected);
  std::vector<double> values;
  for (const auto& node : list.node)
    values.push_back(number_within({list.file, list.key, node}, range));
  return values;
}

std::vector<StrictMap> StrictMap::maps(const std::string& key) {
  if (!has(key)) return {};
  constexpr std::size_t kMost = 200;
  const std::string expected = fmt::format("a list of at most {}", kMost);
  const YamlEntry list = take(key, expected);
  if (!list.node.IsSequence() || list.node.size() > kMost) yaml_fail(list, expected);
  std::vector<StrictMap> maps;
  for (std::size_t i = 0; i < list.node.size(); ++i)
    maps.emplace_back(YamlEntry{list.file, fmt::format("{}[{}]", list.key, i), list.node[i]});
  return maps;
}

void StrictMap::finish() const {
  for (const auto& entry : map_.node) {
    const auto key = entry.first.as<std::string>("");
    if (!requested_.contains(key))
      yaml_fail(below(map_, key, entry.first),
                "an unknown key",
                fmt::format("one of {}", fmt::join(requested_, ", ")));
  }
}

}  // namespace gpo
