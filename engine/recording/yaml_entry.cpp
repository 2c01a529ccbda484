// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/yaml_entry.h"

#include "engine/error.h"
#include "engine/recording/text_file.h"

#include <fmt/format.h>

namespace gpo {

namespace {

std::string shown(const YAML::Node& node) {
  if (node.IsScalar()) return fmt::format("\"{}\"", node.Scalar());
  if (node.IsSequence()) return fmt::format("a list of {}", node.size());
  if (node.IsMap()) return "a map";
  return "nothing";
}

void append_numbers(const YamlEntry& entry, const YAML::Node& node, std::vector<double>& result) {
  if (node.IsSequence()) {
    for (const auto& item : node) append_numbers(entry, item, result);
    return;
  }
  const auto value = node.IsScalar() ? parse_number(node.Scalar()) : std::nullopt;
  if (!value) yaml_fail({entry.file, entry.key, node}, shown(node), "finite numbers");
  result.push_back(*value);
}

}  // namespace

YamlEntry load_yaml(const std::filesystem::path& file) {
  std::string content = read_file(file);
  // OpenCV's directive is not YAML's, and yaml-cpp stumbles over it; the line count must stay.
  if (content.starts_with("%YAML:")) content[0] = '#';
  try {
    return {file, "", YAML::Load(content)};
  } catch (const YAML::Exception& error) {
    throw InputError(file.string() + ":" + std::to_string(error.mark.line + 1) + ": found " +
                     error.msg + ", expected YAML");
  }
}

void yaml_fail(const YamlEntry& entry, const std::string& found, const std::string& expected) {
  std::string place = entry.file.string();
  if (const auto mark = entry.node.Mark(); !mark.is_null()) {
    place += fmt::format(":{}", mark.line + 1);
  }
  if (!entry.key.empty()) place += fmt::format(": key `{}`", entry.key);
  throw InputError(place + ": found " + found + ", expected " + expected);
}

std::optional<YamlEntry> find(const YamlEntry& map, const std::string& key) {
  if (!map.node.IsMap()) yaml_fail(map, shown(map.node), "keys and values");
  const YAML::Node node = map.node[key];
  if (!node) return std::nullopt;
  return YamlEntry{map.file, map.key.empty() ? key : map.key + "." + key, node};
}

YamlEntry at(const YamlEntry& map, const std::string& key, const std::string& expected) {
  if (auto entry = find(map, key)) return *entry;
  const std::string full = map.key.empty() ? key : map.key + "." + key;
  throw InputError(map.file.string() + ": key `" + full + "`: found nothing, expected " + expected);
}

std::string text(const YamlEntry& entry, const std::string& expected) {
  if (!entry.node.IsScalar()) yaml_fail(entry, shown(entry.node), expected);
  return entry.node.Scalar();
}

double number(const YamlEntry& entry) {
  const auto value = entry.node.IsScalar() ? parse_number(entry.node.Scalar()) : std::nullopt;
  if (!value) yaml_fail(entry, shown(entry.node), "a finite number");
  return *value;
}

int integer(const YamlEntry& entry, const std::string& expected) {
  const auto value = entry.node.IsScalar() ? parse_integer(entry.node.Scalar()) : std::nullopt;
  constexpr int kMost = 1'000'000;
  if (!value || *value < -kMost || *value > kMost) yaml_fail(entry, shown(entry.node), expected);
  return static_cast<int>(*value);
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
  if (result.size() != count) {
    yaml_fail(entry, std::to_string(result.size()) + " numbers", expected);
  }
  return result;
}

}  // namespace gpo
