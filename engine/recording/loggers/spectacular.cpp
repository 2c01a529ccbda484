// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/geometry/decompositions.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/loggers/logs.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace gpo {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestLine = std::size_t{1} << 16;

struct Place {
  const fs::path& file;
  int line = 0;  ///< 0: the whole file

  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    fail_at(line > 0 ? place_in(file, line) : file.string(), found, expected);
  }
};

const Json* find(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

double number(const Json* value, const char* key, const Place& place) {
  if (value == nullptr || !value->is_number() || !std::isfinite(value->get<double>()))
    place.fail(fmt::format("no finite number under `{}`", key), "one");
  return value->get<double>();
}

std::vector<double> numbers(const Json* list, const char* key, const Place& place) {
  std::vector<double> values;
  if (list == nullptr || !list->is_array())
    place.fail(fmt::format("no list under `{}`", key), "numbers");
  for (const Json& value : *list) values.push_back(number(&value, key, place));
  return values;
}

std::int64_t time_ns(const Json& line, const Place& place) {
  constexpr double kMost_s = 4e9;
  const double time_s = number(find(line, "time"), "time", place);
  if (!(std::abs(time_s) < kMost_s)) place.fail("an implausible `time`", "seconds");
  return std::llround(1e9 * time_s);
}

void add_lens(Camera& camera, std::string model, std::vector<double> k, const Place& place) {
  std::ranges::replace(model = lower_case(model), '_', '-');
  const std::size_t count = k.size();
  if (model == "kannala-brandt4" && count == 4) {
    camera.distortion = Distortion::equidistant;
    camera.coefficients = std::move(k);
    return;
  }
  const bool none = std::ranges::all_of(k, [](double value) { return value == 0; });
  if (none && (model.empty() || model == "pinhole" || model == "brown-conrady")) return;
  if (model == "pinhole" && count == 3) k = {k[0], k[1], 0, 0, k[2]};  // k1, k2, k3
  const bool opencv = k.size() == 4 || k.size() == 5 || k.size() == 8;
  if ((model != "pinhole" && model != "brown-conrady") || !opencv)
    place.fail(fmt::format("an unsupported lens with {} coefficients", count),
               "pinhole with 3, kannala-brandt4 with 4 or brown-conrady with 4, 5 or 8");
  camera.distortion = Distortion::radial_tangential;
  camera.coefficients = std::move(k);
}

Camera camera_of(const Json& json, const char* model_key, const Place& place) {
  const auto at = [&](const char* key) { return number(find(json, key), key, place); };
  Camera camera{.fx = at("focalLengthX"),
                .fy = at("focalLengthY"),
                .cx = at("principalPointX"),
                .cy = at("principalPointY")};
  if (!(camera.fx > 0) || !(camera.fy > 0))
    place.fail("an implausible focal length", "pixels, > 0");
  const Json* model = find(json, model_key);
  const Json* coefficients = find(json, "distortionCoefficients");
  if (coefficients != nullptr)
    add_lens(camera,
             model != nullptr && model->is_string() ? model->get<std::string>() : "pinhole",
             numbers(coefficients, "distortionCoefficients", place),
             place);
  return camera;
}

/// Reads imuToCamera, row by row: p_camera = T p_imu.
std::optional<Pose> body_of(const Json& json, const Place& place) {
  const Json* rows = find(json, "imuToCamera");
  if (rows == nullptr) return std::nullopt;
  Pose T_camera_imu;
  for (int i = 0; i < 3; ++i) {
    const bool has_row = rows->is_array() && rows->size() == 4;
    const auto row = numbers(has_row ? &(*rows)[i] : nullptr, "imuToCamera", place);
    if (row.size() != 4) place.fail("an invalid `imuToCamera`", "4 rows of 4 numbers");
    T_camera_imu.R_wc.row(i) << row[0], row[1], row[2];
    T_camera_imu.p_wc[i] = row[3];
  }
  constexpr double kMostOff = 0.05;  // for examples with few digits
  Eigen::Matrix3d& R = T_camera_imu.R_wc;
  const Eigen::Matrix3d nearest = nearest_rotation(R);
  if (!((nearest - R).norm() < kMostOff))
    place.fail("no rotation in `imuToCamera`", "a rigid transformation");
  R = nearest;
  return inverse(T_camera_imu);
}

void add_camera(Log& log, const Json& json, const char* model_key, const Place& place) {
  log.camera = camera_of(json, model_key, place);
  log.camera_file = place.file;
  if (const auto body = body_of(json, place)) log.T_body_camera = body;
}

/// Lines and rates [rad/s] by time [ns]; a file need not have them in order.
using Samples = std::map<std::int64_t, std::pair<int, Eigen::Vector3d>>;

struct Sensors {
  Samples gyroscope, accelerometer;
};

void add_sensor(Sensors& sensors, const Json& line, const Place& place) {
  const Json& sensor = line["sensor"];
  const Json* type = find(sensor, "type");
  const bool accelerates = type != nullptr && *type == "accelerometer";
  if (type == nullptr || (*type != "gyroscope" && !accelerates)) return;
  Samples& samples = accelerates ? sensors.accelerometer : sensors.gyroscope;
  const auto rates = numbers(find(sensor, "values"), "values", place);
  if (rates.size() != 3)
    place.fail(fmt::format("{} {}", rates.size(), accelerates ? "accelerations" : "rates"),
               accelerates ? "3 (m/s^2)" : "3 (rad/s)");
  const std::pair sample(place.line, Eigen::Vector3d(rates[0], rates[1], rates[2]));
  if (!samples.emplace(time_ns(line, place), sample).second)
    place.fail("a second sample at the same time", "one");
}

void add_frame(Log& log, const Json& line, const Place& place) {
  const std::int64_t time = time_ns(line, place);
  if (!log.frame_times_ns.empty() && time <= log.frame_times_ns.back())
    place.fail("a frame that is not later than the previous one", "ascending times");
  const bool first = log.frame_times_ns.empty();
  log.frame_times_ns.push_back(time);
  const Json& cameras = line["frames"];
  if (!first || !cameras.is_array()) return;
  for (const Json& camera : cameras) {
    const Json* number = find(camera, "cameraInd");
    const Json* parameters = find(camera, "cameraParameters");
    if (parameters == nullptr || (number != nullptr && *number != 0)) continue;
    const Camera before = log.camera.value_or(Camera{});
    add_camera(log, *parameters, "distortionModel", place);
    log.camera->width = before.width;
    log.camera->height = before.height;
    if (const auto body = body_of(camera, place)) log.T_body_camera = body;
  }
}

void add_calibration(Log& log, const fs::path& file) {
  if (!is_file(file)) return;
  const Json json = read_json(file);
  const Place place{file};
  const Json* cameras = find(json, "cameras");
  if (cameras == nullptr || !cameras->is_array() || cameras->empty())
    place.fail("no list `cameras`", "Spectacular AI's calibration");
  const Json& camera = cameras->front();
  add_camera(log, camera, "model", place);
  const auto size = [&](const char* key) {
    const Json* pixels = find(camera, key);
    if (pixels == nullptr) return 0;
    const double count = number(pixels, key, place);
    if (count < 1 || count > 1e5) place.fail(fmt::format("an implausible `{}`", key), "pixels");
    return static_cast<int>(count);
  };
  log.camera->width = size("imageWidth");
  log.camera->height = size("imageHeight");
}

}  // namespace

Log read_spectacular(const fs::path& file) {
  const Budget budget(file);
  Log log;
  log.file = file;
  log.frames_file = file;
  add_calibration(log, file.parent_path() / "calibration.json");
  Sensors sensors;
  const std::string bytes = read_file(file);
  TextLines lines(bytes);
  while (const auto row = lines.next()) {
    const Place place{file, lines.number()};
    if (row->size() > kLongestLine)
      place.fail(fmt::format("a line of {} bytes", row->size()), "one measurement");
    if (row->empty()) continue;
    spend_items(file);
    const Json json = parse_json(*row);
    if (!json.is_object()) place.fail("a line that is not a JSON object", "one measurement");
    if (json.contains("sensor")) add_sensor(sensors, json, place);
    if (json.contains("frames")) add_frame(log, json, place);
  }
  if (sensors.gyroscope.empty()) return log;
  Gyroscope& gyroscope = log.gyroscope.emplace();
  gyroscope.file = file;
  for (const auto& [time, sample] : sensors.gyroscope) {
    gyroscope.timestamps_ns.push_back(time);
    gyroscope.lines.push_back(sample.first);
    gyroscope.rates_rad_s.push_back(sample.second);
  }
  AccelerationSamples accelerations;
  for (const auto& [time, sample] : sensors.accelerometer) {
    accelerations.timestamps_ns.push_back(time);
    accelerations.specific_force.push_back(sample.second);
  }
  add_accelerations(accelerations, gyroscope);
  return log;
}

}  // namespace gpo
