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

/// A value in a YAML file that knows where it stands, so that an error can say it.
struct YamlEntry {
  std::filesystem::path file;
  std::string key;  ///< empty: the whole file
  YAML::Node node;
};

/// Parses a file, OpenCV's dialect ("%YAML:1.0", !!opencv-matrix) too. Throws InputError.
YamlEntry load_yaml(const std::filesystem::path& file);

/// "FILE:LINE: key `KEY`: found FOUND, expected EXPECTED".
[[noreturn]] void yaml_fail(const YamlEntry& entry,
                            const std::string& found,
                            const std::string& expected);
/// The same, with what stands there as FOUND.
[[noreturn]] void yaml_fail(const YamlEntry& entry, const std::string& expected);

/// A node below a map, with its full key: "MAP.KEY".
YamlEntry below(const YamlEntry& map, const std::string& key, const YAML::Node& node);
std::optional<YamlEntry> find(const YamlEntry& map, const std::string& key);
/// The same, or an InputError that says what was expected.
YamlEntry at(const YamlEntry& map, const std::string& key, const std::string& expected);

std::string text(const YamlEntry& entry, const std::string& expected);
double number(const YamlEntry& entry, const std::string& expected = "a finite number");
std::int64_t integer(const YamlEntry& entry, const std::string& expected);
/// All numbers of a list, of a list of lists, or of a matrix ({rows, cols, data}), row by row.
std::vector<double> numbers(const YamlEntry& entry);
std::vector<double> numbers(const YamlEntry& entry, std::size_t count, const std::string& expected);

/// Whether the first thing in a file is a tag. Throws InputError where it cannot be read.
bool is_xml(const std::filesystem::path& file);

/// Parses an XML file as OpenCV's FileStorage writes it into what its YAML would have been:
/// elements are keys, several words are a list, `<_>` are the items of a list. Throws InputError.
YamlEntry load_opencv_xml(const std::filesystem::path& file);

}  // namespace gpo
