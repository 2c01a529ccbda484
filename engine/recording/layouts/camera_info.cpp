// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/camera_info.h"

#include "engine/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr double kLongestFocalLength_px = 1e6;  // [px]
constexpr double kLargestCoefficient = 1e6;
constexpr std::uint32_t kLongestSide = 100'000;  // [px]

/// ROS' names of models.
struct Model {
  const char* name;
  Distortion distortion;
  std::initializer_list<std::size_t> counts;  ///< of coefficients
};
const std::array<Model, 4> kModels = {
    {{"plumb_bob", Distortion::radial_tangential, {4, 5}},
     {"rational_polynomial", Distortion::radial_tangential, {8, 12, 14}},
     {"equidistant", Distortion::equidistant, {4}},
     {"fisheye", Distortion::equidistant, {4}}}};

[[noreturn]] void fail(const std::string& name,
                       const std::string& field,
                       const std::string& found,
                       const std::string& expected) {
  throw InputError(fmt::format("{}: `{}`: found {}, expected {}", name, field, found, expected));
}

void set_lens(Camera& camera, const CameraInfoMessage& info, const std::string& name) {
  const auto zero = [](double k) { return k == 0; };
  if (std::ranges::all_of(info.D, zero)) return;  // also where there are none
  const auto model = std::ranges::find_if(
      kModels, [&](const Model& m) { return info.distortion_model == m.name; });
  if (model == kModels.end()) {
    fail(name,
         "distortion_model",
         "\"" + info.distortion_model + "\"",
         "plumb_bob, rational_polynomial or equidistant");
  }
  if (std::ranges::find(model->counts, info.D.size()) == model->counts.end()) {
    fail(name,
         "D",
         fmt::format("{} numbers", info.D.size()),
         fmt::format("{} for {}", fmt::join(model->counts, " or "), model->name));
  }
  const auto possible = [](double k) { return std::abs(k) <= kLargestCoefficient; };
  if (!std::ranges::all_of(info.D, possible))
    fail(name, "D", "a coefficient that no lens has", "numbers of the order of 1");
  camera.distortion = model->distortion;
  camera.coefficients = info.D;
  // ROS writes five where four were calibrated.
  if (info.D.size() == 5 && info.D.back() == 0) camera.coefficients.pop_back();
}

}  // namespace

bool is_calibrated(const CameraInfoMessage& info) { return info.K[0] != 0; }

Camera camera_of(const CameraInfoMessage& info, const std::string& name) {
  const auto& k = info.K;
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
    fail(name, "K", "another matrix", "[fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  const auto possible = [](double f) { return f > 0 && f <= kLongestFocalLength_px; };
  if (!possible(k[0]) || !possible(k[4]))
    fail(name, "K", "a focal length that no lens has", "fx, fy in pixels");
  if (std::max(info.width, info.height) > kLongestSide)
    fail(name, "width", "a size that no picture has", "pixels");
  Camera camera;
  camera.width = static_cast<int>(info.width);
  camera.height = static_cast<int>(info.height);
  camera.fx = k[0];
  camera.fy = k[4];
  camera.cx = k[2];
  camera.cy = k[5];
  const bool inside = camera.cx > -camera.width && camera.cx < 2 * camera.width &&
                      camera.cy > -camera.height && camera.cy < 2 * camera.height;
  if (camera.width > 0 && camera.height > 0 && !inside)
    fail(name, "K", "a principal point far outside of the picture", "cx, cy near its middle");
  if (!std::isfinite(camera.cx) || !std::isfinite(camera.cy))
    fail(name, "K", "no numbers", "cx, cy in pixels");
  set_lens(camera, info, name);
  return camera;
}

CameraInfoMessage camera_info_of(const Camera& camera) {
  CameraInfoMessage info;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  info.D = camera.coefficients;
  if (camera.distortion == Distortion::equidistant) {
    info.distortion_model = "equidistant";
    return info;
  }
  constexpr std::size_t kPlumbBob = 5;
  info.D.resize(std::max(info.D.size(), kPlumbBob), 0);
  info.distortion_model = info.D.size() == kPlumbBob ? "plumb_bob" : "rational_polynomial";
  return info;
}

}  // namespace gpo
