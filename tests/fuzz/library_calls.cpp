// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The library's interface with public structs that the fuzzed bytes change. Without bytes, the
// input is a good window.
#include "engine/geometry/pose.h"
#include "engine/live.h"
#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace gpo::fuzz {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFirstSpecial = 250;  // bytes from here on replace a value
constexpr std::array kNumbers{
    std::numeric_limits<double>::quiet_NaN(), kInfinity, -1.0, 0.0, 1e300};
using Times = std::numeric_limits<std::int64_t>;
constexpr std::array<std::int64_t, 5> kIntegers{Times::max(), Times::min(), -1, 0, 1};
constexpr std::int64_t kFrame_ns = 33'000'000, kSample_ns = 5'000'000;

/// Values that the bytes change, one after the other; unchanged after the last byte.
class Changes {
 public:
  explicit Changes(std::string_view bytes) : bytes_(bytes) {}

  int byte() {
    if (bytes_.empty()) return 0;
    const auto value = static_cast<unsigned char>(bytes_.front());
    bytes_.remove_prefix(1);
    return value;
  }
  double number(double usual) { return one_of(kNumbers, usual); }
  std::int64_t integer(std::int64_t usual) { return one_of(kIntegers, usual); }
  int count(int usual) {
    const int value = byte();
    return value < 200 ? usual : value % 20;
  }
  template <class Choice>
  Choice choice(Choice usual, int choices) {
    const int value = byte();
    return value == 0 ? usual : static_cast<Choice>(value % choices);
  }
  void change(auto& values) {
    for (double& value : values) value = number(value);
  }

 private:
  template <class Values, class Value>
  Value one_of(const Values& specials, Value usual) {
    const auto special = static_cast<std::size_t>(std::max(0, byte() - kFirstSpecial));
    return special == 0 ? usual : specials[special - 1];
  }

  std::string_view bytes_;
};

Camera camera_of(Changes& changes) {
  Camera camera{.width = 640, .height = 480, .fx = 500, .fy = 500, .cx = 319.5, .cy = 239.5};
  for (double* const value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy})
    *value = changes.number(*value);
  camera.width = static_cast<int>(changes.integer(camera.width));
  camera.distortion = changes.choice(Distortion::none, 8);
  camera.coefficients.assign(changes.count(0), 0.01);
  camera.sigmas.assign(changes.count(0), 0.1);
  camera.covariance.assign(changes.count(0), 0.1);
  for (auto* const values : {&camera.coefficients, &camera.sigmas, &camera.covariance})
    changes.change(*values);
  if (changes.byte() > 128) camera.readout = Readout{changes.number(0.02), changes.number(0.001)};
  camera.readout_direction = changes.choice(ReadoutDirection::down, 4);
  return camera;
}

/// A frame of a camera that moves sideways in front of a tilted plane.
Frame frame_of(int number, Changes& changes) {
  Frame frame{.timestamp_ns = changes.integer(kFrame_ns * number)};
  const int tracks = changes.count(24);
  for (int k = 0; k < tracks; ++k) frame.ids.push_back(changes.integer(k));
  frame.raw_px.resize(2, std::max(0, tracks - changes.count(0)));
  for (int k = 0; k < frame.raw_px.cols(); ++k) {
    const Eigen::Vector3d point(k % 6 - 2.5, k / 6 - 1.5, 5 + 0.3 * (k % 6));
    const Eigen::Vector2d seen = (point - 0.1 * number * Eigen::Vector3d::UnitX()).hnormalized();
    const double noise_px = changes.byte() / 512.0;
    for (int c = 0; c < 2; ++c)
      frame.raw_px(c, k) = changes.number(500 * seen[c] + (c == 0 ? 319.5 : 239.5) + noise_px);
  }
  if (changes.byte() > 128)
    frame.R_wc = changes.number(1) * so3_exp({changes.number(0), 0, changes.number(0)});
  return frame;
}

Gyroscope gyroscope_of(int frames, Changes& changes) {
  Gyroscope gyroscope;
  const bool accelerated = changes.byte() > 128;
  const int samples = changes.count(static_cast<int>(frames * kFrame_ns / kSample_ns) + 4);
  for (int k = 0; k < samples; ++k) {
    gyroscope.timestamps_ns.push_back(changes.integer((k - 2) * kSample_ns));
    if (accelerated) gyroscope.accelerations_m_s2.emplace_back(0, changes.number(-9.8), 0);
  }
  gyroscope.rates_rad_s.assign(std::max(0, samples - changes.count(0)), {0.01, 0, 0});
  for (Eigen::Vector3d& rate : gyroscope.rates_rad_s) rate.x() = changes.number(0.01);
  gyroscope.time_offset_ns = changes.integer(0);
  gyroscope.bias_rad_s.y() = changes.number(0);
  gyroscope.bias_sigma_rad_s = changes.number(0.01);
  gyroscope.noise_density = changes.number(3e-4);
  gyroscope.R_gyro_camera(1, 2) = changes.number(0);
  return gyroscope;
}

InitializeOptions options_of(Changes& changes) {
  InitializeOptions options;
  const int method = changes.byte();
  if (method > 0) options.method = methods()[method % methods().size()].key;
  options.rotations = changes.choice(RotationSource::automatic, 8);
  if (changes.byte() > 128) options.ransac = changes.byte() > 128;
  if (changes.byte() > 128) options.ransac_threshold_px = changes.number(2);
  if (changes.byte() > 128) options.inliers = changes.choice(Inliers::planes, 3);
  options.plane = static_cast<int>(changes.integer(1));
  options.gravity = changes.choice(options.gravity, 3);
  options.accelerometer_bias_sigma_m_s2 = changes.number(0.3);
  if (changes.byte() > 128) options.p_gyro_camera_m = Eigen::Vector3d(changes.number(0.1), 0, 0);
  options.method_options.solver = changes.choice(Solver::schur, 2);
  options.method_options.error = changes.choice(ErrorModel::automatic, 4);
  options.method_options.shutter = changes.choice(Shutter::known, 3);
  options.method_options.time_offset = changes.byte() > 128;
  return options;
}

/// A ready window has finite cameras; any other one has a reason.
void expect_sound(const WindowResult& result) {
  if (result.is_ready() != result.why_not_ready().empty())
    throw std::logic_error("a window that is not ready has no reason");
  for (const Pose& camera : result.initialization.cameras)
    if (!camera.R_wc.allFinite() || !camera.p_wc.allFinite())
      throw std::logic_error("a camera is not finite");
}

void call_live(const Camera& camera,
               const std::vector<Frame>& frames,
               const Gyroscope& gyroscope,
               const InitializeOptions& options) {
  LiveInitializer live(camera, {.initialize = options, .background = false, .most_frames = 6});
  std::size_t next = 0;
  for (const Frame& frame : frames) {
    const std::size_t end = std::min(next + 8, gyroscope.rates_rad_s.size());
    for (; next < std::min(end, gyroscope.timestamps_ns.size()); ++next)
      parse(
          [&] { live.add_gyroscope(gyroscope.timestamps_ns[next], gyroscope.rates_rad_s[next]); });
    parse([&] { live.add_frame(frame); });
  }
  const LiveStatus status = live.wait();
  if (status.answer) expect_sound(*status.answer);
}

}  // namespace

void call_library(std::string_view bytes) {
  Changes changes(bytes);
  const Camera camera = camera_of(changes);
  const InitializeOptions options = options_of(changes);
  std::vector<Frame> frames;
  for (int count = changes.count(8); std::ssize(frames) < count;)
    frames.push_back(frame_of(static_cast<int>(frames.size()), changes));
  const bool has_gyroscope = changes.byte() > 128;
  const Gyroscope gyroscope =
      has_gyroscope ? gyroscope_of(static_cast<int>(frames.size()), changes) : Gyroscope();
  parse([&] {
    expect_sound(initialize(camera, frames, has_gyroscope ? &gyroscope : nullptr, options));
  });
  parse([&] { call_live(camera, frames, gyroscope, options); });
}

}  // namespace gpo::fuzz
