// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/checks.h"
#include "engine/diagnosis/sensors_rest.h"
#include "engine/geometry/pose.h"
#include "engine/window/gyroscope_rest.h"

#include <optional>
#include <string>

#include <Eigen/Core>
#include <fmt/format.h>

namespace gpo::check {
namespace {

constexpr double kMostBias_rad_s = 0.5;  // absolute, of any gyroscope

std::string seen_at_rest(const SensorsRest& rest) {
  std::string seen =
      fmt::format("gyroscope and accelerometer are at rest, the plane's tracks move by {:.0f} px",
                  rest.moved_px);
  if (!rest.still_tracks.empty())
    seen += fmt::format(", {} tracks do not move", rest.still_tracks.size());
  if (rest.is_tilted()) seen += fmt::format(", the result tilts by {:.1f} deg", rest.tilted_deg);
  if (rest.is_too_close())
    seen += fmt::format(", the path needs a plane within {:.2g} m", rest.most_m);
  return seen;
}

/// Returns the bias with which the rotations of the result were integrated.
std::optional<Eigen::Vector3d> bias_of(const Evidence& e) {
  if (e.result == nullptr || !e.result->ok || e.window == nullptr || !e.window->gyro)
    return std::nullopt;
  return e.result->bias_rad_s.value_or(e.window->gyro->bias_rad_s);
}

}  // namespace

Findings camera_at_rest(const Evidence& e) {
  if (e.window == nullptr || e.gyroscope == nullptr || e.result == nullptr) return {};
  const auto rest = sensors_rest(*e.window, *e.gyroscope, *e.result);
  if (!rest) return {};
  Finding finding{.level = Level::degenerate, .view = "image"};
  if (rest->camera_rests()) {
    finding.sentence = fmt::format("the camera rests, the plane moves ({})", seen_at_rest(*rest));
    finding.advice = "move the camera and not the plane";
  } else if (rest->is_turned()) {
    finding.level = Level::weak;
    finding.sentence = fmt::format(
        "the gyroscope rests, the result turns by {:.1f} deg: the plane moves, or the "
        "gyroscope is not the camera's",
        rest->turned_deg);
  } else {
    return {};
  }
  for (const int column : rest->still_tracks)
    if (static_cast<std::size_t>(column) < e.ids.size()) finding.tracks.push_back(e.ids[column]);
  return {finding};
}

Findings contradicted_bias(const Evidence& e) {
  const auto bias_rad_s = bias_of(e);
  if (!bias_rad_s) return {};
  const GyroSensitivity& gyro = *e.window->gyro;
  const double sigmas = (*bias_rad_s - gyro.prior_rad_s).norm() / gyro.prior_sigma_rad_s;
  const double size_rad_s = bias_rad_s->norm();
  if (size_rad_s <= kMostBias_rad_s && sigmas <= kMostBiasSigmas) return {};
  const std::string source =
      e.gyroscope == nullptr ? "" : fmt::format(" ({})", e.gyroscope->bias_source);
  return {{.level = Level::degenerate,
           .sentence = fmt::format("wrong minimum: the gyroscope's bias would be {:.3f} rad/s "
                                   "({:.1f} deg/s), {:.0f} standard deviations from its prior{}",
                                   size_rad_s,
                                   degrees(size_rad_s),
                                   sigmas,
                                   source)}};
}

}  // namespace gpo::check
