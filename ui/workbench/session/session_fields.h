// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/error.h"
#include "ui/workbench/state.h"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gpo {

using SessionJson = nlohmann::ordered_json;

/// Reads one object of a session. Error messages say where it is.
class SessionReader {
 public:
  SessionReader(const SessionJson& json, std::string where)
      : json_(json), where_(std::move(where)) {
    if (!json.is_object()) throw InputError(where_ + ": expected an object");
  }

  bool has(const char* key) const { return json_.contains(key) && !json_.at(key).is_null(); }
  SessionReader object(const char* key) const { return {json_.at(key), where_ + ": " + key}; }

  /// Leaves the value as it is if the key is missing or null.
  template <class T>
  void operator()(const char* key, T& value) const {
    if (!has(key)) return;
    try {
      json_.at(key).get_to(value);
    } catch (const SessionJson::exception&) {
      refuse(key);
    }
  }
  void operator()(const char* key, double& value, double least, double most) const {
    (*this)(key, value);
    if (!(value >= least && value <= most)) refuse(key);
  }
  void operator()(const char* key, int& value, int least, int most) const {
    if (!has(key)) return;
    const SessionJson& json = json_.at(key);
    // get_to would silently truncate 1.5 and numbers that do not fit into an int.
    if (!json.is_number_integer() || json < least || json > most) refuse(key);
    json.get_to(value);
  }
  template <int N>
  void operator()(const char* key, Eigen::Matrix<double, N, 1>& vector) const {
    std::vector<double> all(vector.data(), vector.data() + N);
    (*this)(key, all);
    if (all.size() != N) refuse(key);
    std::ranges::copy(all, vector.data());
  }
  [[noreturn]] void refuse(const char* key) const {
    throw InputError(fmt::format("{}: {}: invalid value {}", where_, key, json_.at(key).dump()));
  }
  const SessionJson& json() const { return json_; }
  const std::string& where() const { return where_; }

 private:
  const SessionJson& json_;
  std::string where_;
};

/// A part of the state that sessions store. Missing ones keep the default of the state.
struct SessionField {
  const char* key;
  std::function<SessionJson(const WorkbenchState&)> write;
  /// For sessions that have the key. Throws InputError that names it.
  std::function<void(const SessionReader&, WorkbenchState&)> read;
  std::function<void(const WorkbenchState& from, WorkbenchState& to)> copy;
};

/// All fields, in the order in which they are written.
std::span<const SessionField> session_fields();

}  // namespace gpo
