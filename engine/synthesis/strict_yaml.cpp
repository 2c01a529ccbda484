// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/strict_yaml.h"

#include "engine/error.h"

#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

std::string describe(const YAML::Node& node) {
  if (!node.IsDefined()) return "nothing";
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return fmt::format("\"{}\"", node.Scalar());
    case YAML::NodeType::Sequence:
      return fmt::format("a list of {}", node.size());
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "nothing";
  }
}

std::string expectation(const Range& range, bool integer) {
  std::string text = integer ? "a whole number" : "a number";
  if (!range.unit.empty()) text += fmt::format(" [{}]", range.unit);
  if (std::isfinite(range.low) && std::isfinite(range.high)) {
    return text + fmt::format(" from {} to {}", range.low, range.high);
  }
  return std::isfinite(range.low) ? text + fmt::format(" of at least {}", range.low) : text;
}

}  // namespace

StrictMap::StrictMap(std::string file, std::string name, const YAML::Node& node)
    : file_(std::move(file)), name_(std::move(name)), node_(node) {
  if (!node_.IsMap()) {
    throw InputError(fmt::format("{}:{}: {}found {}, expected a map of keys and values",
                                 file_,
                                 node_.Mark().line + 1,
                                 name_.empty() ? "" : name_ + ": ",
                                 describe(node_)));
  }
  std::set<std::string> keys;
  for (const auto& entry : node_) {
    const auto key = entry.first.as<std::string>("");
    if (!keys.insert(key).second) {
      throw InputError(fmt::format("{}:{}: {}{}: found a second time, expected each key once",
                                   file_,
                                   entry.first.Mark().line + 1,
                                   name_.empty() ? "" : name_ + ".",
                                   key));
    }
  }
}

StrictMap StrictMap::open(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) {
    throw InputError(fmt::format("{}: found no readable file, expected a recipe", file.string()));
  }
  try {
    return {file.string(), "", YAML::Load(stream)};
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}: found broken YAML ({}), expected a recipe",
                                 file.string(),
                                 error.mark.line + 1,
                                 error.msg));
  }
}

void StrictMap::fail(const std::string& key,
                     const std::string& found,
                     const std::string& expected) const {
  const YAML::Node value = node_[key];
  const int line = (value.IsDefined() ? value : node_).Mark().line + 1;
  throw InputError(fmt::format("{}:{}: {}{}: found {}, expected {}",
                               file_,
                               line,
                               name_.empty() ? "" : name_ + ".",
                               key,
                               found,
                               expected));
}

bool StrictMap::has(const std::string& key) const {
  return static_cast<const YAML::Node&>(node_)[key].IsDefined();
}

YAML::Node StrictMap::take(const std::string& key, const std::string& expected) {
  asked_.insert(key);
  if (!has(key)) fail(key, "nothing", expected);
  return node_[key];
}

double StrictMap::parse(const YAML::Node& node,
                        const std::string& key,
                        const Range& range,
                        bool integer) const {
  double value = 0;
  const bool read = node.IsScalar() && YAML::convert<double>::decode(node, value);
  const bool whole = !integer || value == std::floor(value);
  if (!read || !whole || !std::isfinite(value) || value < range.low || value > range.high) {
    fail(key, describe(node), expectation(range, integer));
  }
  return value;
}

double StrictMap::number(const std::string& key, const Range& range) {
  return parse(take(key, expectation(range, false)), key, range, false);
}

double StrictMap::number(const std::string& key, const Range& range, double otherwise) {
  asked_.insert(key);
  return has(key) ? number(key, range) : otherwise;
}

std::int64_t StrictMap::integer(const std::string& key, const Range& range) {
  const YAML::Node node = take(key, expectation(range, true));
  parse(node, key, range, true);
  std::int64_t value = 0;  // A double would lose the last digits of a time stamp.
  if (!YAML::convert<std::int64_t>::decode(node, value)) {
    fail(key, describe(node), expectation(range, true));
  }
  return value;
}

std::int64_t StrictMap::integer(const std::string& key,
                                const Range& range,
                                std::int64_t otherwise) {
  asked_.insert(key);
  return has(key) ? integer(key, range) : otherwise;
}

std::string StrictMap::choice(const std::string& key, const std::vector<std::string>& choices) {
  const std::string expected = fmt::format("one of {}", fmt::join(choices, ", "));
  const YAML::Node node = take(key, expected);
  for (const std::string& known : choices) {
    if (node.IsScalar() && node.Scalar() == known) return known;
  }
  fail(key, describe(node), expected);
}

std::vector<double> StrictMap::numbers(const std::string& key,
                                       const Range& range,
                                       int least,
                                       int most) {
  const std::string count =
      least == most ? std::to_string(least) : fmt::format("{} to {}", least, most);
  const std::string expected = fmt::format("a list of {} numbers", count);
  const YAML::Node node = take(key, expected);
  if (!node.IsSequence() || static_cast<int>(node.size()) < least ||
      static_cast<int>(node.size()) > most) {
    fail(key, describe(node), expected);
  }
  std::vector<double> values;
  for (const auto& entry : node) values.push_back(parse(entry, key, range, false));
  return values;
}

StrictMap StrictMap::map(const std::string& key) {
  const YAML::Node node = take(key, "a map");
  return {file_, name_.empty() ? key : name_ + "." + key, node};
}

std::vector<StrictMap> StrictMap::list(const std::string& key) {
  asked_.insert(key);
  if (!has(key)) return {};
  const YAML::Node node = node_[key];
  if (!node.IsSequence()) fail(key, describe(node), "a list");
  std::vector<StrictMap> maps;
  const std::string name = name_.empty() ? key : name_ + "." + key;
  for (std::size_t i = 0; i < node.size(); ++i) {
    maps.push_back(StrictMap(file_, fmt::format("{}[{}]", name, i), node[i]));
  }
  return maps;
}

void StrictMap::finish() const {
  for (const auto& entry : node_) {
    const auto key = entry.first.as<std::string>("");
    if (asked_.count(key) == 0) {
      throw InputError(fmt::format("{}:{}: {}{}: found an unknown key, expected one of {}",
                                   file_,
                                   entry.first.Mark().line + 1,
                                   name_.empty() ? "" : name_ + ".",
                                   key,
                                   fmt::join(asked_, ", ")));
    }
  }
}

}  // namespace gpo
