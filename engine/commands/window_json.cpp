// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/commands/window_json.h"

#include "engine/base/choice.h"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

namespace gpo {
namespace {

using Ordered = nlohmann::ordered_json;

/// Null where it is not a number.
Ordered vector_json(const Eigen::VectorXd& vector) {
  if (!vector.allFinite()) return nullptr;
  return std::vector<double>(vector.begin(), vector.end());
}

Ordered matrix_json(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite()) return nullptr;
  Ordered rows = Ordered::array();
  for (int i = 0; i < 3; ++i) rows.push_back(vector_json(matrix.row(i).transpose()));
  return rows;
}

Ordered list_json(const auto& values, auto json_of) {
  Ordered list = Ordered::array();
  for (const auto& value : values) list.push_back(json_of(value));
  return list;
}

Ordered columns_json(const Eigen::Matrix2Xd& columns) {
  Ordered list = Ordered::array();
  for (const auto& column : columns.colwise()) list.push_back(vector_json(column));
  return list;
}

Ordered plane_json(const WindowPlane& plane) {
  return {{"tracks", plane.tracks},
          {"picture_share", plane.picture_share},
          {"homographies", list_json(plane.H_i1, matrix_json)}};
}

/// The samples within the window, and one more to either side.
Ordered gyroscope_json(const Gyroscope& gyroscope, const Window& window) {
  const auto& times = gyroscope.timestamps_ns;
  const auto after =
      std::ranges::upper_bound(times, window.timestamps_ns.front() + gyroscope.time_offset_ns);
  const auto beyond =
      std::ranges::lower_bound(times, window.timestamps_ns.back() + gyroscope.time_offset_ns);
  const auto first = std::max<std::ptrdiff_t>(0, after - times.begin() - 1);
  const auto end = std::min(std::ssize(times), beyond - times.begin() + 1);
  Ordered json = {{"timestamps_ns", Ordered::array()}, {"rates_rad_s", Ordered::array()}};
  for (auto i = first; i < end; ++i) {
    json["timestamps_ns"].push_back(times[i]);
    json["rates_rad_s"].push_back(vector_json(gyroscope.rates_rad_s[i]));
  }
  json["R_gyro_camera"] = matrix_json(gyroscope.R_gyro_camera);
  json["time_offset_ns"] = gyroscope.time_offset_ns;
  json["bias_rad_s"] = vector_json(gyroscope.bias_rad_s);
  return json;
}

Ordered camera_json(const Camera& camera) {
  constexpr std::array kModels{"none", "radial-tangential", "equidistant"};
  return {{"width", camera.width},
          {"height", camera.height},
          {"intrinsics", {camera.fx, camera.fy, camera.cx, camera.cy}},
          {"distortion", kModels[static_cast<std::size_t>(camera.distortion)]},
          {"coefficients", camera.coefficients}};
}

void add_pictures(const Sources& sources, const Window& window, Ordered& json) {
  const auto name = [](const std::filesystem::path& file) {
    std::error_code none;
    return std::filesystem::absolute(file, none).string();
  };
  if (std::ssize(sources.pictures) == window.frame_count())
    json["pictures"] = list_json(sources.pictures, name);
  else if (sources.pictures.size() == 1)
    json["video"] = name(sources.pictures.front());
}

}  // namespace

Ordered window_json(const Window& window, const Sources& sources) {
  const auto same = [](const auto& value) { return Ordered(value); };
  Ordered json = {{"start", window.start},
                  {"K", matrix_json(window.K)},
                  {"timestamps_ns", window.timestamps_ns},
                  {"tracks", list_json(window.points_px, columns_json)},
                  {"inliers", list_json(window.inlier, same)},
                  {"all_tracks", window.all_tracks},
                  {"homographies", list_json(window.H_i1, matrix_json)},
                  {"planes", list_json(window.planes, plane_json)},
                  {"leading_plane", window.leader},
                  {"rotations", list_json(window.R_wc, matrix_json)},
                  {"rotations_are", to_string(window.rotations)}};
  if (sources.gyroscope != nullptr) json["gyroscope"] = gyroscope_json(*sources.gyroscope, window);
  if (sources.camera != nullptr) json["camera"] = camera_json(*sources.camera);
  add_pictures(sources, window, json);
  return json;
}

}  // namespace gpo
