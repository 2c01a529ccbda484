// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/external_methods/own_method.h"
#include "engine/files/text_file.h"
#include "engine/geometry/camera_resection.h"
#include "engine/geometry/decompositions.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/plane/plane_result.h"

#include <algorithm>
#include <cmath>
#include <regex>

#include <Eigen/LU>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

using Json = nlohmann::json;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMaxNumber = 1e12;
/// Distance from a rotation matrix that is accepted as rounding to few digits.
constexpr double kMaxSkew = 1e-3;
constexpr double kRounding = 1e-12;
/// Largest share of points behind the reference camera; more mean a wrong sign or world.
constexpr double kMostBehind = 0.05;

[[noreturn]] void refuse_answer(const std::string& key, const std::string& expected) {
  throw InputError(fmt::format("{}: expected {}", key, expected));
}

/// Returns the line with NaN and Infinity, which Python writes and JSON lacks, as strings.
std::string with_quoted_constants(std::string_view line) {
  static const std::regex constant(R"(([\[:,] ?)(NaN|-?Infinity))");
  return std::regex_replace(std::string(line), constant, "$1\"$2\"");
}

/// Limits the depth so that the parser does not run out of stack.
Json parsed(std::string_view line) {
  constexpr int kMaxDepth = 8;
  const auto keep = [](int depth, Json::parse_event_t, const Json&) {
    if (depth > kMaxDepth) throw InputError("nested too deeply, expected a JSON object");
    return true;
  };
  try {
    return Json::parse(line, keep);
  } catch (const Json::parse_error& error) {
    Json json = Json::parse(with_quoted_constants(line), keep, false);
    if (!json.is_discarded()) return json;
    throw InputError(fmt::format(
        "invalid JSON from byte {} on: '{}'", error.byte, legible(line.substr(0, 200), 40)));
  } catch (const Json::exception&) {
    throw InputError("a number is out of range");
  }
}

void check_keys(const Json& json,
                const std::string& where,
                std::initializer_list<const char*> keys) {
  if (!json.is_object()) refuse_answer(where, "an object");
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(keys, key) != keys.end()) continue;
    throw InputError(
        fmt::format("{}: unknown key, expected {}",
                    where == "answer" ? legible(key, 40) : where + "." + legible(key, 40),
                    fmt::join(keys, ", ")));
  }
}

double number(const Json& json, const std::string& key, const std::string& expected) {
  constexpr std::size_t kMaxText = 40;
  if (json.is_string())
    throw InputError(fmt::format(
        "{}: found '{}', expected {}", key, legible(json.get<std::string>(), kMaxText), expected));
  if (!json.is_number()) refuse_answer(key, expected);
  const auto value = json.get<double>();
  if (std::abs(value) <= kMaxNumber) return value;
  throw InputError(
      fmt::format("{}: {:g} is too large, expected at most {:g}", key, value, kMaxNumber));
}

void append_numbers(const Json& json,
                    const std::string& key,
                    const std::string& expected,
                    std::vector<double>& into) {
  if (!json.is_array()) refuse_answer(key, expected);
  for (const Json& one : json) {
    if (one.is_array() && into.size() <= 9)
      append_numbers(one, key, expected, into);
    else
      into.push_back(number(one, key, expected));
    if (into.size() > 9) refuse_answer(key, expected);
  }
}

const Json& member(const Json& json, const std::string& where, const char* key) {
  const auto found = json.find(key);
  if (found == json.end()) throw InputError(fmt::format("{}.{}: is missing", where, key));
  return *found;
}

std::vector<double> numbers(const Json& json,
                            const std::string& where,
                            const char* key,
                            std::size_t count) {
  const std::string name = where + "." + key;
  const std::string expected = counted(count, "number");
  std::vector<double> values;
  append_numbers(member(json, where, key), name, expected, values);
  if (values.size() != count) refuse_answer(name, expected);
  return values;
}

Vector3d vector_in(const Json& json, const std::string& where, const char* key) {
  return Vector3d::Map(numbers(json, where, key, 3).data());
}

Matrix3d rotation_in(const Json& json, const std::string& where, const char* key) {
  const std::vector<double> values = numbers(json, where, key, 9);
  const Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
  const auto rotation = rotation_meant(R, kMaxSkew);
  if (rotation) return *rotation;
  const bool reflection = rotation_meant(-R, kMaxSkew).has_value();
  refuse_answer(where + "." + key,
                reflection ? "a rotation matrix, row by row, found a reflection of determinant -1"
                           : "a rotation matrix, row by row");
}

int index_in(const Json& json, const std::string& where, const char* key, int count) {
  const Json& value = member(json, where, key);
  if (!value.is_number_integer() || value < 0 || value >= count)
    refuse_answer(
        where + "." + key,
        count > 0 ? fmt::format("a number from 0 to {}", count - 1) : "none: there are none");
  return value.get<int>();
}

Plane plane_in(const Json& json, const std::string& where) {
  const Vector3d normal = vector_in(json, where, "normal");
  const std::string key = where + ".distance";
  const double distance = number(member(json, where, "distance"), key, "a number");
  const double length = normal.norm();
  if (!(length > 1e-9)) refuse_answer(where + ".normal", "a vector that is not zero");
  if (std::abs(length - 1) <= kRounding) return {normal, distance};
  return {normal / length, distance / length};
}

const Json& array_in(const Json& json, const char* key) {
  static const Json none = Json::array();
  const auto found = json.find(key);
  if (found == json.end() || found->is_null()) return none;
  if (!found->is_array()) refuse_answer(key, "an array");
  return *found;
}

std::vector<std::optional<Pose>> cameras_in(const Json& json, int frames) {
  const Json& list = array_in(json, "cameras");
  if (std::ssize(list) != frames)
    refuse_answer("cameras", fmt::format("{}, one per frame, found {}", frames, list.size()));
  std::vector<std::optional<Pose>> cameras(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string where = fmt::format("cameras[{}]", i);
    if (list[i].is_null()) continue;
    check_keys(list[i], where, {"R_wc", "center"});
    cameras[i] = Pose{rotation_in(list[i], where, "R_wc"), vector_in(list[i], where, "center")};
  }
  if (!cameras.front()) refuse_answer("cameras[0]", "the reference camera, found null");
  return cameras;
}

/// The plane's distance from the reference camera, not from the world's origin, is the unit.
void check_off_reference(const Plane& plane, const Answer& answer, const std::string& where) {
  if (std::abs(plane.normal.dot(answer.cameras.front()->p_wc) + plane.distance) > 1e-9) return;
  refuse_answer(where + ".distance", "a plane that does not contain the reference camera");
}

std::vector<PlaneEstimate> planes_in(const Json& json, int count) {
  std::vector<PlaneEstimate> planes;
  for (const Json& one : array_in(json, "planes")) {
    const std::string where = fmt::format("planes[{}]", planes.size());
    check_keys(one, where, {"plane", "normal", "distance"});
    const int number = index_in(one, where, "plane", count);
    if (std::ranges::find(planes, number, &PlaneEstimate::number) != planes.end())
      refuse_answer(where + ".plane", fmt::format("each plane once, found {} again", number));
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
      refuse_answer(where + ".track", fmt::format("each track once, found {} again", track));
    known[track] = true;
    points.push_back({track, vector_in(one, where, "position")});
  }
  return points;
}

Answer seen_from_reference(Answer answer) {
  const Pose reference = *answer.cameras.front();
  const Pose from_world = inverse(reference);
  for (auto& camera : answer.cameras)
    if (camera) camera = from_world * *camera;
  answer.cameras.front() = Pose{};
  const auto transform = [&](Plane& plane) {
    plane = facing_origin(plane_in_camera(plane, reference));
  };
  if (answer.plane) transform(*answer.plane);
  for (PlaneEstimate& one : answer.planes) transform(one.plane);
  for (MapPoint& point : answer.points) point.position = to_camera(reference, point.position);
  std::erase_if(answer.points, [](const MapPoint& point) { return !(point.position.z() > 0); });
  return answer;
}

std::optional<Plane> plane_of_inliers(const Window& window, const std::vector<MapPoint>& points) {
  Eigen::Matrix3Xd positions(3, std::ssize(points));
  int count = 0;
  for (const MapPoint& point : points)
    if (window.is_inlier_track(point.track)) positions.col(count++) = point.position;
  return fit_plane(positions.leftCols(count));
}

/// Scales the plane to distance 1. Returns false if numbers overflow.
bool rescale(Answer& answer) {
  const double unit = answer.plane->distance;
  bool finite = true;
  const auto scale = [&](Vector3d& vector) {
    vector /= unit;
    finite = finite && vector.allFinite();
  };
  for (auto& camera : answer.cameras)
    if (camera) scale(camera->p_wc);
  for (MapPoint& point : answer.points) scale(point.position);
  for (PlaneEstimate& one : answer.planes) one.plane.distance /= unit;
  answer.plane->distance = 1;
  return finite && std::isfinite(1 / unit);
}

/// Returns why an answer contradicts itself or has points behind the camera; nullopt if neither.
std::optional<std::string> contradiction(const Window& window,
                                         const Answer& answer,
                                         std::size_t given_points) {
  const auto leading = std::ranges::find(answer.planes, window.leader, &PlaneEstimate::number);
  if (answer.plane && leading != answer.planes.end()) {
    const Plane &a = *answer.plane, &b = leading->plane;
    if ((a.normal - b.normal).norm() > kMaxSkew ||
        std::abs(a.distance - b.distance) > kMaxSkew * std::abs(a.distance))
      return fmt::format(
          "the answer has two different leading planes, plane and that of planes "
          "with the number {}",
          window.leader);
  }
  const std::size_t behind = given_points - answer.points.size();
  if (static_cast<double>(behind) > kMostBehind * static_cast<double>(given_points))
    return fmt::format("{} of the answer's {} are behind the reference camera",
                       behind,
                       counted(given_points, "point"));
  return std::nullopt;
}

/// Returns which camera fits its tracks far worse than the others; nullopt if none does.
std::optional<std::string> camera_apart(const Window& window, const Initialization& result) {
  constexpr double kApart = 10;  // times the residual of the others
  const auto errors_px = reprojection_errors_px(window, result.plane, result.cameras);
  std::vector<double> medians_px;
  auto begin = errors_px.begin();
  for (int i = 1; i < window.frame_count(); ++i) {
    const auto end = begin + std::ssize(window.inlier_tracks(i));
    medians_px.push_back(begin == end ? 0 : median({begin, end}));
    begin = end;
  }
  if (medians_px.empty()) return std::nullopt;
  const auto worst = std::ranges::max_element(medians_px);
  const double others_px = median(medians_px);
  if (!(*worst > most_residual_px(window) && *worst > kApart * others_px)) return std::nullopt;
  return fmt::format(
      "the camera of frame {} does not fit its tracks: median residual {:.1f} px, but {:.1f} px "
      "for the other frames",
      window.start + 1 + (worst - medians_px.begin()),
      *worst,
      others_px);
}

std::vector<PlaneEstimate> planes_of(const Window& window, const Answer& answer) {
  std::vector<PlaneEstimate> planes = answer.planes;
  if (window.planes.empty() || planes.empty()) return {};
  std::erase_if(planes, [&](const PlaneEstimate& one) { return one.number == window.leader; });
  planes.insert(planes.begin(), {window.leader, *answer.plane});
  return planes;
}

}  // namespace

Answer read_answer(std::string_view line, const ExpectedAnswer& expected) {
  const Json json = parsed(line);
  if (!json.is_object()) refuse_answer("answer", "an object");
  const auto given = [&](const char* key) { return json.contains(key) && !json[key].is_null(); };
  check_keys(
      json, "answer", {"id", "failed", "cameras", "plane", "planes", "points", "milliseconds"});
  if (given("id") && json["id"] != expected.id)
    refuse_answer("id", fmt::format("{}, as in the question", expected.id));
  Answer answer;
  if (given("failed")) {
    if (!json["failed"].is_string()) refuse_answer("failed", "a string");
    constexpr std::size_t kMaxReason = 500;
    answer.failed = legible(json["failed"].get<std::string>(), kMaxReason);
    if (trimmed(*answer.failed).empty()) answer.failed = "failed without a reason";
    return answer;
  }
  if (!given("cameras")) throw InputError("cameras: is missing, as is failed");
  answer.cameras = cameras_in(json, expected.frames);
  if (given("plane")) {
    check_keys(json["plane"], "plane", {"normal", "distance"});
    answer.plane = plane_in(json["plane"], "plane");
    check_off_reference(*answer.plane, answer, "plane");
  }
  answer.planes = planes_in(json, expected.planes);
  for (std::size_t k = 0; k < answer.planes.size(); ++k)
    check_off_reference(answer.planes[k].plane, answer, fmt::format("planes[{}]", k));
  answer.points = points_in(json, expected.tracks);
  if (given("milliseconds")) {
    answer.milliseconds = number(json["milliseconds"], "milliseconds", "a number");
    if (*answer.milliseconds < 0)
      refuse_answer("milliseconds", fmt::format("0 or more, found {:g}", *answer.milliseconds));
  }
  return answer;
}

Initialization initialization_of(const Window& window, const Answer& given) {
  if (given.failed) return failed(*given.failed);
  Answer answer = seen_from_reference(given);
  if (const auto reason = contradiction(window, answer, given.points.size()))
    return failed(*reason);
  const auto leading = std::ranges::find(answer.planes, window.leader, &PlaneEstimate::number);
  if (!answer.plane && leading != answer.planes.end()) answer.plane = leading->plane;
  const bool over_plane = answer.plane && answer.points.empty();
  if (!answer.plane) {
    if (answer.points.empty()) answer.points = triangulated(window, answer.cameras);
    answer.plane = plane_of_inliers(window, answer.points);
    if (!answer.plane) return failed("the answer has no plane, and none fits its points");
  }
  if (!rescale(answer))
    return failed("the answer's numbers overflow when scaled to the distance of its plane");
  const std::array reference{Pose{}};
  const auto points = over_plane ? lift_to_plane(window, *answer.plane, reference) : answer.points;
  Initialization result;
  result.plane = *answer.plane;
  result.planes = planes_of(window, answer);
  for (int i = 0; i < window.frame_count(); ++i) {
    const auto camera = answer.cameras[i] ? answer.cameras[i] : resected(window, points, i);
    if (!camera)
      return failed(fmt::format("the answer has no camera of frame {}, which sees too few points",
                                window.start + i));
    result.cameras.push_back(*camera);
  }
  if (const auto reason = camera_apart(window, result)) return refused(*reason, std::move(result));
  if (over_plane) return with_map_points(window, std::move(result));
  result.points = points;
  std::vector<double> errors_px = reprojection_errors_px(window, result.cameras, result.points);
  if (!given.points.empty() && !errors_px.empty() && median(errors_px) > most_residual_px(window))
    return refused(fmt::format("the points do not fit their tracks: median residual {:.1f} px",
                               median(errors_px)),
                   std::move(result));
  std::erase_if(errors_px, [](double error) { return !std::isfinite(error); });
  result.rms_px = root_mean_square(errors_px);
  return trusted(window, std::move(result));
}

std::optional<Pose> resected(const Window& window, const std::vector<MapPoint>& points, int frame) {
  Eigen::Matrix3Xd positions(3, std::ssize(points));
  Eigen::Matrix2Xd pixels(2, std::ssize(points));
  int count = 0;
  for (const MapPoint& point : points) {
    if (!window.points_px[frame].col(point.track).allFinite()) continue;
    positions.col(count) = point.position;
    pixels.col(count++) = window.points_px[frame].col(point.track);
  }
  constexpr int kMinPoints = 6;  // PnP needs four, but with fewer than these it is a guess
  if (count < kMinPoints) return std::nullopt;
  const auto found = resect_camera(positions.leftCols(count), pixels.leftCols(count), window.K);
  return found ? std::optional(found->pose) : std::nullopt;
}

}  // namespace gpo
