// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/checks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo::check {
namespace {

// Published calibrations of 20 cameras (EuRoC, KITTI, TUM, TUM-VI, phones, action cameras): the
// principal point is up to 4 % of the size off the center and fx / fy up to 1.5 % off 1.
// KITTI-360's cropped images (13 %) are beyond. Images resized to 0.75: 17 %.
constexpr double kMostOffCenter = 0.08;  // share of width or height
constexpr double kMostAspect = 0.03;
// A calibration for another image size moves both coordinates alike; those cameras differ by up to
// 6 % of half the size.
constexpr double kLeastResize = 0.06;
constexpr double kAlikeRatios = 0.04;
constexpr double kWidest_deg = 150, kNarrowest_deg = 5;

/// Returns the longer side's field of view [deg]; a fisheye's angle is proportional to the radius.
double view_deg(const Camera& camera) {
  const double half = 0.5 * std::max(camera.width / camera.fx, camera.height / camera.fy);
  const bool is_fisheye = camera.distortion > Distortion::radial_tangential;
  return degrees(2 * (is_fisheye ? half : std::atan(half)));
}

/// Returns by how much the image was resized after its calibration; nullopt if it seems it was not.
std::optional<double> resize_of(const Camera& camera) {
  const double by_x = 0.5 * (camera.width - 1) / camera.cx;
  const double by_y = 0.5 * (camera.height - 1) / camera.cy;
  const double scale = std::sqrt(by_x * by_y);
  if (!(scale > 0 && std::isfinite(scale)) || std::abs(std::log(by_x / by_y)) > kAlikeRatios ||
      std::abs(std::log(scale)) < kLeastResize)
    return std::nullopt;
  for (const double usual : {0.25, 1. / 3, 0.375, 0.5, 0.6, 2. / 3, 0.75, 0.8, 1.25, 1.5, 2., 4.})
    if (std::abs(std::log(scale / usual)) < 0.5 * kAlikeRatios) return usual;
  return scale;
}

Findings weak(std::string sentence, std::string advice, std::string command = "") {
  return {{.level = Level::weak,
           .sentence = std::move(sentence),
           .advice = std::move(advice),
           .command = std::move(command),
           .view = "camera"}};
}

}  // namespace

Findings guessed_camera(const Evidence& e) {
  return e.camera_is_guess ? weak("the camera is a guess", "calibrate it", "calibrate")
                           : Findings{};
}

Findings interlaced(const Evidence& e) {
  if (e.first_field.empty()) return {};
  return {{.sentence =
               fmt::format("interlaced, {} field first: the first field is used", e.first_field)}};
}

Findings implausible_intrinsics(const Evidence& e) {
  if (e.camera == nullptr || e.camera_is_guess || e.camera->width < 1 || e.camera->height < 1)
    return {};
  const Camera& c = *e.camera;
  const double x = (c.cx + 0.5) / c.width, y = (c.cy + 0.5) / c.height;
  if (const auto scale = resize_of(c))
    return weak(fmt::format("the principal point ({:.1f}, {:.1f}) is at {:.0f} % of the width and "
                            "{:.0f} % of the height: the calibration seems to be for images of "
                            "about {:.0f} x {:.0f} px, these have {} x {}",
                            c.cx,
                            c.cy,
                            100 * x,
                            100 * y,
                            c.width / *scale,
                            c.height / *scale,
                            c.width,
                            c.height),
                fmt::format("multiply fx, fy, cx and cy of the calibration by {:.4g} (setting "
                            "intrinsics_scale)",
                            *scale * e.intrinsics_scale),
                fmt::format("set intrinsics_scale {:.4g}", *scale * e.intrinsics_scale));
  constexpr const char* kCheck = "check the order of fx, fy, cx, cy and the size of the images";
  if (!(std::max(std::abs(x - 0.5), std::abs(y - 0.5)) <= kMostOffCenter))
    return weak(fmt::format("the principal point ({:.1f}, {:.1f}) is at {:.0f} % of the width and "
                            "{:.0f} % of the height",
                            c.cx,
                            c.cy,
                            100 * x,
                            100 * y),
                kCheck);
  if (!(std::abs(std::log(c.fx / c.fy) + std::log(e.pixel_aspect)) <= kMostAspect))
    return weak(
        fmt::format("fx is {:.3f} times fy, although pixels seem to be square", c.fx / c.fy),
        kCheck);
  const double most_deg = c.distortion > Distortion::radial_tangential ? 360 : kWidest_deg;
  if (const double view = view_deg(c); !(view >= kNarrowest_deg && view <= most_deg))
    return weak(fmt::format("the field of view is {:.1f} deg", view), kCheck);
  return {};
}

}  // namespace gpo::check
