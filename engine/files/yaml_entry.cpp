// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/yaml_entry.h"

#include "engine/files/refuse.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/ranges.h>
#include <tinyxml2.h>

namespace gpo {
namespace {

/// Far beyond any calibration or recipe.
constexpr int kMaxDepth = 64;

std::string shown(const YAML::Node& node) {
  if (node.IsScalar()) return fmt::format("\"{}\"", legible(node.Scalar(), 40));
  if (node.IsSequence()) return fmt::format("a list of {}", node.size());
  if (node.IsMap()) return "a map";
  return "no value";
}

void append_numbers(const YamlEntry& entry, const YAML::Node& node, std::vector<double>& result) {
  if (node.IsSequence()) {
    for (const auto& item : node) append_numbers(entry, item, result);
    return;
  }
  result.push_back(number({entry.file, entry.key, node}, "finite numbers"));
}

/// Counts the values in a node with expanded aliases. A recursive alias exceeds the depth.
void check_extent(const YamlEntry& entry, const YAML::Node& node, int depth, std::uint64_t& count) {
  if (depth > kMaxDepth)
    yaml_fail(
        entry, "lists or maps nested too deeply", fmt::format("at most {} levels", kMaxDepth));
  if (++count > limits().yaml_values)
    yaml_fail(entry,
              "too many values",
              fmt::format("at most {}; --limits allows more", limits().yaml_values));
  if (node.IsSequence()) {
    for (const auto& item : node) check_extent(entry, item, depth + 1, count);
  } else if (node.IsMap()) {
    for (const auto& item : node) {
      check_extent(entry, item.first, depth + 1, count);
      check_extent(entry, item.second, depth + 1, count);
    }
  }
}

YAML::Node parsed(const fs::path& file, const std::string& content) {
  try {
    return YAML::Load(content);
  } catch (const YAML::Exception& error) {
    refuse(place_in(file, error.mark.line + 1), "found {}, expected YAML", error.msg);
  }
}

using tinyxml2::XMLElement;

YAML::Node words_of(const XMLElement& element) {
  std::string_view text = element.GetText() != nullptr ? element.GetText() : "";
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
    return YAML::Node(std::string(text.substr(1, text.size() - 2)));
  YAML::Node words(YAML::NodeType::Sequence);
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
    words.push_back(std::string(word));
    text = trimmed(text.substr(word.size()));
  }
  if (words.size() > 1) return words;
  return words.size() == 1 ? YAML::Node(words[0].Scalar()) : YAML::Node();
}

/// Ignores elements deeper than in any calibration, because yaml-cpp's time grows with each level.
YAML::Node node_of(const XMLElement& element, int depth = 0) {
  constexpr int kDeepest = 16;
  const XMLElement* child = element.FirstChildElement();
  if (child == nullptr || depth == kDeepest) return words_of(element);
  YAML::Node node;
  for (; child != nullptr; child = child->NextSiblingElement()) {
    const std::string name = child->Name();
    if (name == "_") {
      if (node.IsMap()) continue;
      node.push_back(node_of(*child, depth + 1));
    } else if (!node.IsSequence()) {
      node.force_insert(name, node_of(*child, depth + 1));
    }
  }
  return node;
}

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

YamlEntry load_yaml(const fs::path& file) {
  std::string content = read_file(file, limits().hand_bytes);
  // yaml-cpp rejects OpenCV's directive. A comment in its place keeps the line numbers.
  if (content.starts_with("%YAML:")) content[0] = '#';
  YamlEntry whole{file, "", parsed(file, content)};
  std::uint64_t count = 0;
  check_extent(whole, whole.node, 0, count);
  return whole;
}

void yaml_fail(const YamlEntry& entry, const std::string& found, const std::string& expected) {
  const auto mark = entry.node.Mark();
  std::string place = mark.is_null() ? entry.file.string() : place_in(entry.file, mark.line + 1);
  if (!entry.key.empty()) place += fmt::format(": key `{}`", entry.key);
  fail_at(place, found, expected);
}

void yaml_fail(const YamlEntry& entry, const std::string& expected) {
  yaml_fail(entry, shown(entry.node), expected);
}

YamlEntry below(const YamlEntry& map, const std::string& key, const YAML::Node& node) {
  return {map.file, map.key.empty() ? key : map.key + "." + key, node};
}

std::optional<YamlEntry> find(const YamlEntry& map, const std::string& key) {
  if (!map.node.IsMap()) yaml_fail(map, "keys and values");
  const YAML::Node node = map.node[key];
  return node ? std::optional(below(map, key, node)) : std::nullopt;
}

YamlEntry at(const YamlEntry& map, const std::string& key, const std::string& expected) {
  if (auto entry = find(map, key)) return *entry;
  // A missing top-level key has no line.
  yaml_fail(below(map, key, map.key.empty() ? YAML::Node() : map.node), "no value", expected);
}

std::string text(const YamlEntry& entry, const std::string& expected) {
  if (!entry.node.IsScalar()) yaml_fail(entry, expected);
  return entry.node.Scalar();
}

double number(const YamlEntry& entry, const std::string& expected) {
  const auto value = entry.node.IsScalar() ? parse_number(entry.node.Scalar()) : std::nullopt;
  if (!value) yaml_fail(entry, expected);
  return *value;
}

std::int64_t integer(const YamlEntry& entry, const std::string& expected) {
  const auto value = entry.node.IsScalar() ? parse_integer(entry.node.Scalar()) : std::nullopt;
  if (!value) yaml_fail(entry, expected);
  return *value;
}

std::vector<double> numbers(const YamlEntry& entry) {
  std::vector<double> result;
  const bool matrix = entry.node.IsMap() && entry.node["data"];
  const YAML::Node data = matrix ? entry.node["data"] : entry.node;
  if (!data.IsSequence()) yaml_fail(entry, shown(data), "a list of numbers");
  append_numbers(entry, data, result);
  return result;
}

std::vector<double> numbers(const YamlEntry& entry,
                            std::size_t count,
                            const std::string& expected) {
  auto result = numbers(entry);
  if (result.size() != count) yaml_fail(entry, counted(result.size(), "number"), expected);
  return result;
}

bool is_xml(const fs::path& file) {
  const std::string content = read_file(file, limits().hand_bytes);
  return trimmed(TextLines(content).rest()).starts_with('<');
}

YamlEntry load_opencv_xml(const fs::path& file) {
  const std::string text = read_file(file, limits().hand_bytes);
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  const XMLElement* root = document.RootElement();
  if (document.Error() || root == nullptr)
    refuse(place_in(file, document.ErrorLineNum()),
           "found {}, expected XML",
           document.Error() ? document.ErrorName() : "no element");
  return {file, "", node_of(*root)};
}

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
