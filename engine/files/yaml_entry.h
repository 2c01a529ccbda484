// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace gpo {

/// A value in a YAML file with its place for error messages.
struct YamlEntry {
  std::filesystem::path file;
  std::string key;  ///< empty: the whole file
  YAML::Node node;
};

/// Parses a file, also in OpenCV's dialect ("%YAML:1.0", !!opencv-matrix). Throws InputError.
YamlEntry load_yaml(const std::filesystem::path& file);

/// Throws InputError "FILE:LINE: key `KEY`: found FOUND, expected EXPECTED".
[[noreturn]] void yaml_fail(const YamlEntry& entry,
                            const std::string& found,
                            const std::string& expected);
/// The same with the value as FOUND.
[[noreturn]] void yaml_fail(const YamlEntry& entry, const std::string& expected);

/// Returns a node of a map with its full key: "MAP.KEY".
YamlEntry below(const YamlEntry& map, const std::string& key, const YAML::Node& node);
std::optional<YamlEntry> find(const YamlEntry& map, const std::string& key);
/// The same, but throws InputError if the key is missing.
YamlEntry at(const YamlEntry& map, const std::string& key, const std::string& expected);

std::string text(const YamlEntry& entry, const std::string& expected);
double number(const YamlEntry& entry, const std::string& expected = "a finite number");
std::int64_t integer(const YamlEntry& entry, const std::string& expected);
/// Returns the numbers of a list, nested list or matrix ({rows, cols, data}), row by row.
std::vector<double> numbers(const YamlEntry& entry);
std::vector<double> numbers(const YamlEntry& entry, std::size_t count, const std::string& expected);

/// Returns whether a file starts with a tag. Throws InputError if it cannot be read.
bool is_xml(const std::filesystem::path& file);

/// Parses an XML file of OpenCV's FileStorage into the equivalent of its YAML: elements are keys,
/// several words are a list, `<_>` are the items of a list. Throws InputError.
YamlEntry load_opencv_xml(const std::filesystem::path& file);

}  // namespace gpo
