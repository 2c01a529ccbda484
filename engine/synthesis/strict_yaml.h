// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/yaml_entry.h"

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Bounds of a number, both included, with the unit for people.
struct Bounds {
  double low;
  double high;
  std::string unit = "";
};

/// One map of a YAML file, read strictly: each getter throws InputError that names file, line, key,
/// what was found and what was expected; `finish` refuses keys that nobody asked for.
class StrictMap {
 public:
  /// The file's top level.
  static StrictMap open(const std::filesystem::path& file);

  bool has(const std::string& key);
  double number(const std::string& key, const Bounds& range);
  double number(const std::string& key, const Bounds& range, double otherwise);
  std::int64_t integer(const std::string& key, const Bounds& range);
  std::int64_t integer(const std::string& key, const Bounds& range, std::int64_t otherwise);
  std::string choice(const std::string& key, const std::vector<std::string>& choices);
  std::vector<double> numbers(const std::string& key, const Bounds& range, int least, int most);
  template <int N>
  Eigen::Matrix<double, N, 1> vector(const std::string& key, const Bounds& range) {
    return Eigen::Map<const Eigen::Matrix<double, N, 1>>(numbers(key, range, N, N).data());
  }
  StrictMap map(const std::string& key);
  /// Of maps, as many as a person writes; empty where the key is absent.
  std::vector<StrictMap> list(const std::string& key);
  void finish() const;
  [[noreturn]] void fail(const std::string& key,
                         const std::string& found,
                         const std::string& expected) const;

 private:
  explicit StrictMap(YamlEntry map);
  YamlEntry take(const std::string& key, const std::string& expected);

  YamlEntry map_;
  std::set<std::string> asked_;
};

}  // namespace gpo
