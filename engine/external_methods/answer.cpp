// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/external_methods/answer.h"

#include "engine/base/error.h"
#include "engine/geometry/nearest_rotation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

using Json = nlohmann::json;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLargest = 1e12;
/// A matrix this far from a rotation is meant to be one, written with few digits.
constexpr double kMostSkew = 1e-3;
/// This near, it is one.
constexpr double kRounding = 1e-12;

[[noreturn]] void refuse(const std::string& key, const std::string& expected) {
  throw InputError(fmt::format("{}: expected {}", key, expected));
}

/// Deeper than any answer, and far from where a parser runs out of stack.
Json parsed(std::string_view line) {
  constexpr int kDeepest = 8;
  const auto keep = [](int depth, Json::parse_event_t, const Json&) {
    if (depth > kDeepest) throw InputError("nested too deep, expected a JSON object");
    return true;
  };
  try {
    return Json::parse(line, keep);
  } catch (const Json::parse_error& error) {
    throw InputError(
        fmt::format("no JSON from byte {} on: '{}'", error.byte, legible(line.substr(0, 200), 40)));
  } catch (const Json::exception&) {
    throw InputError("a number is out of range");
  }
}

void check_keys(const Json& json,
                const std::string& where,
                std::initializer_list<const char*> keys) {
  if (!json.is_object()) refuse(where, "an object");
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(keys, key) != keys.end()) continue;
    throw InputError(
        fmt::format("{}: unknown key, expected {}",
                    where == "answer" ? legible(key, 40) : where + "." + legible(key, 40),
                    fmt::join(keys, ", ")));
  }
}

double number(const Json& json, const std::string& key, const std::string& expected) {
  if (!json.is_number()) refuse(key, expected);
  const auto value = json.get<double>();
  if (!(std::abs(value) <= kLargest)) refuse(key, expected);
  return value;
}

/// So many numbers in a row, or in rows.
void numbers(const Json& json,
             const std::string& key,
             const std::string& expected,
             std::vector<double>& into) {
  if (!json.is_array()) refuse(key, expected);
  for (const Json& one : json) {
    if (one.is_array() && into.size() <= 9) {
      numbers(one, key, expected, into);
    } else {
      into.push_back(number(one, key, expected));
    }
    if (into.size() > 9) refuse(key, expected);
  }
}

const Json& member(const Json& json, const std::string& where, const char* key) {
  const auto found = json.find(key);
  if (found == json.end()) throw InputError(fmt::format("{}.{}: is missing", where, key));
  return *found;
}

Vector3d vector_in(const Json& json, const std::string& where, const char* key) {
  constexpr const char* kExpected = "3 numbers";
  const std::string name = where + "." + key;
  std::vector<double> values;
  numbers(member(json, where, key), name, kExpected, values);
  if (values.size() != 3) refuse(name, kExpected);
  return {values[0], values[1], values[2]};
}

Matrix3d rotation_in(const Json& json, const std::string& where, const char* key) {
  constexpr const char* kExpected = "9 numbers";
  const std::string name = where + "." + key;
  std::vector<double> values;
  numbers(member(json, where, key), name, kExpected, values);
  if (values.size() != 9) refuse(name, kExpected);
  const Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
  const auto rotation = rotation_meant(R, kMostSkew);
  if (!rotation) refuse(name, "a rotation matrix, row by row");
  return *rotation;
}

int index_in(const Json& json, const std::string& where, const char* key, int count) {
  const Json& value = member(json, where, key);
  if (!value.is_number_integer() || value < 0 || value >= count) {
    refuse(where + "." + key,
           count > 0 ? fmt::format("a number from 0 to {}", count - 1) : "none: there are none");
  }
  return value.get<int>();
}

/// Where normal . X + distance = 0.
Plane plane_in(const Json& json, const std::string& where) {
  const Vector3d normal = vector_in(json, where, "normal");
  const std::string key = where + ".distance";
  const double distance = number(member(json, where, "distance"), key, "a number");
  const double length = normal.norm();
  if (!(length > 1e-9)) refuse(where + ".normal", "a vector that is not zero");
  if (!(std::abs(distance) > 1e-9 * length)) refuse(key, "a number that is not zero");
  if (std::abs(length - 1) <= kRounding) return {normal, distance};
  return {normal / length, distance / length};
}

const Json& array_in(const Json& json, const char* key) {
  static const Json none = Json::array();
  const auto found = json.find(key);
  if (found == json.end() || found->is_null()) return none;
  if (!found->is_array()) refuse(key, "an array");
  return *found;
}

std::vector<std::optional<Pose>> cameras_in(const Json& json, int frames) {
  const Json& list = array_in(json, "cameras");
  if (std::ssize(list) != frames)
    refuse("cameras", fmt::format("{}, one a frame, found {}", frames, list.size()));
  std::vector<std::optional<Pose>> cameras(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string where = fmt::format("cameras[{}]", i);
    if (list[i].is_null()) continue;
    check_keys(list[i], where, {"R_wc", "center"});
    cameras[i] = Pose{rotation_in(list[i], where, "R_wc"), vector_in(list[i], where, "center")};
  }
  if (!cameras.front()) refuse("cameras[0]", "the reference camera, found null");
  return cameras;
}

std::vector<PlaneEstimate> planes_in(const Json& json, int count) {
  std::vector<PlaneEstimate> planes;
  for (const Json& one : array_in(json, "planes")) {
    const std::string where = fmt::format("planes[{}]", planes.size());
    check_keys(one, where, {"plane", "normal", "distance"});
    const int number = index_in(one, where, "plane", count);
    if (std::ranges::find(planes, number, &PlaneEstimate::number) != planes.end())
      refuse(where + ".plane", fmt::format("each plane once, found {} again", number));
    planes.push_back({number, plane_in(one, where)});
  }
  return planes;
}

std::vector<MapPoint> points_in(const Json& json, int tracks) {
  std::vector<MapPoint> points;
  std::vector<bool> known(tracks, false);
  for (const Json& one : array_in(json, "points")) {
    const std::string where = fmt::format("points[{}]", points.size());
    check_keys(one, where, {"track", "position"});
    const int track = index_in(one, where, "track", tracks);
    if (known[track])
      refuse(where + ".track", fmt::format("each track once, found {} again", track));
    known[track] = true;
    points.push_back({track, vector_in(one, where, "position")});
  }
  return points;
}

}  // namespace

Answer read_answer(std::string_view line, const Asked& asked) {
  const Json json = parsed(line);
  if (!json.is_object()) refuse("answer", "an object");
  const auto given = [&](const char* key) { return json.contains(key) && !json[key].is_null(); };
  check_keys(
      json, "answer", {"id", "failed", "cameras", "plane", "planes", "points", "milliseconds"});
  if (given("id") && json["id"] != asked.id)
    refuse("id", fmt::format("{}, as in the question", asked.id));
  Answer answer;
  if (given("failed")) {
    if (!json["failed"].is_string()) refuse("failed", "a text");
    constexpr std::size_t kLongestReason = 500;
    answer.failed = legible(json["failed"].get<std::string>(), kLongestReason);
    return answer;
  }
  if (!given("cameras")) throw InputError("cameras: is missing, and so is failed");
  answer.cameras = cameras_in(json, asked.frames);
  if (given("plane")) {
    check_keys(json["plane"], "plane", {"normal", "distance"});
    answer.plane = plane_in(json["plane"], "plane");
  }
  answer.planes = planes_in(json, asked.planes);
  answer.points = points_in(json, asked.tracks);
  if (given("milliseconds"))
    answer.milliseconds = number(json["milliseconds"], "milliseconds", "a number");
  return answer;
}

}  // namespace gpo
