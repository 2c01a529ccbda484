// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/yaml_entry.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"

#include <string_view>

#include <fmt/format.h>
#include <tinyxml2.h>

namespace gpo {
namespace {

/// Limits far beyond any calibration or recipe; aliases may expand to more than fits in memory.
constexpr int kMaxNodes = 100'000;
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
void check_extent(const YamlEntry& entry, const YAML::Node& node, int depth, int& count) {
  if (depth > kMaxDepth)
    yaml_fail(entry, "lists or maps without end", fmt::format("at most {} levels", kMaxDepth));
  if (++count > kMaxNodes)
    yaml_fail(entry, "too many values", fmt::format("at most {}", kMaxNodes));
  if (node.IsSequence()) {
    for (const auto& item : node) check_extent(entry, item, depth + 1, count);
  } else if (node.IsMap()) {
    for (const auto& item : node) {
      check_extent(entry, item.first, depth + 1, count);
      check_extent(entry, item.second, depth + 1, count);
    }
  }
}

YAML::Node parsed(const std::filesystem::path& file, const std::string& content) {
  try {
    return YAML::Load(content);
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format(
        "{}:{}: found {}, expected YAML", file.string(), error.mark.line + 1, error.msg));
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

}  // namespace

YamlEntry load_yaml(const std::filesystem::path& file) {
  std::string content = read_file(file, kMaxBytesByHand);
  // yaml-cpp rejects OpenCV's directive. A comment in its place keeps the line numbers.
  if (content.starts_with("%YAML:")) content[0] = '#';
  YamlEntry whole{file, "", parsed(file, content)};
  int count = 0;
  check_extent(whole, whole.node, 0, count);
  return whole;
}

void yaml_fail(const YamlEntry& entry, const std::string& found, const std::string& expected) {
  std::string place = entry.file.string();
  if (const auto mark = entry.node.Mark(); !mark.is_null())
    place += fmt::format(":{}", mark.line + 1);
  if (!entry.key.empty()) place += fmt::format(": key `{}`", entry.key);
  throw InputError(place + ": found " + found + ", expected " + expected);
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

bool is_xml(const std::filesystem::path& file) {
  const std::string content = read_file(file, kMaxBytesByHand);
  std::string_view text = content;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
  return trimmed(text).starts_with('<');
}

YamlEntry load_opencv_xml(const std::filesystem::path& file) {
  const std::string text = read_file(file, kMaxBytesByHand);
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  const XMLElement* root = document.RootElement();
  if (document.Error() || root == nullptr)
    throw InputError(fmt::format("{}:{}: found {}, expected XML",
                                 file.string(),
                                 document.ErrorLineNum(),
                                 document.Error() ? document.ErrorName() : "no element"));
  return {file, "", node_of(*root)};
}

}  // namespace gpo
