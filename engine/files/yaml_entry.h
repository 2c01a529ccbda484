// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/paths.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>
#include <yaml-cpp/yaml.h>

namespace gpo {

/// A value in a YAML file with its place for error messages.
struct YamlEntry {
  fs::path file;
  std::string key;  ///< empty: the whole file
  YAML::Node node;
};

/// Parses a file, also in OpenCV's dialect ("%YAML:1.0", !!opencv-matrix). Throws InputError.
YamlEntry load_yaml(const fs::path& file);

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

bool is_xml(const fs::path& file);

/// Parses an XML file of OpenCV's FileStorage into the equivalent of its YAML. Throws InputError.
YamlEntry load_opencv_xml(const fs::path& file);

/// Bounds of a number, both included, with its unit.
struct Bounds {
  double low;
  double high;
  std::string unit = "";
};

/// A map of a YAML file, read strictly. Each getter throws InputError with file, line, key, the
/// value and the expectation; `finish` refuses keys that were not requested.
class StrictMap {
 public:
  explicit StrictMap(YamlEntry map);

  bool has(const std::string& key);
  // A missing key is an error unless there is `otherwise`.
  double number(const std::string& key, const Bounds& range, std::optional<double> otherwise = {});
  template <typename T = int>
  T integer(const std::string& key,
            const Bounds& range,
            std::optional<std::int64_t> otherwise = {}) {
    return static_cast<T>(read_integer(key, range, otherwise));
  }
  std::string choice(const std::string& key,
                     const std::vector<std::string>& choices,
                     const std::optional<std::string>& otherwise = {});
  std::vector<double> numbers(const std::string& key, const Bounds& range, int least, int most);
  template <int N>
  Eigen::Matrix<double, N, 1> vector(const std::string& key, const Bounds& range) {
    return Eigen::Map<const Eigen::Matrix<double, N, 1>>(numbers(key, range, N, N).data());
  }
  /// Returns `read(map)` of the map below a key, all of whose keys must be read.
  template <typename Read>
  auto map(const std::string& key, const Read& read) {
    return finished(StrictMap(take(key, "a map")), read);
  }
  /// Returns the same of each of at most 200 maps; empty without the key.
  template <typename Read>
  auto list(const std::string& key, const Read& read) {
    std::vector<std::invoke_result_t<Read, StrictMap&>> values;
    for (const StrictMap& one : maps(key)) values.push_back(finished(one, read));
    return values;
  }
  void finish() const;
  [[noreturn]] void fail(const std::string& key,
                         const std::string& found,
                         const std::string& expected) const;

 private:
  static auto finished(StrictMap map, const auto& read) {
    auto value = read(map);
    map.finish();
    return value;
  }
  YamlEntry take(const std::string& key, const std::string& expected);
  std::vector<StrictMap> maps(const std::string& key);
  std::int64_t read_integer(const std::string& key,
                            const Bounds& range,
                            std::optional<std::int64_t> otherwise);

  YamlEntry map_;
  std::set<std::string> requested_;
};

}  // namespace gpo
