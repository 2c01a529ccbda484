// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/gyroscope_report.h"

#include "engine/calibration/camera_parameters.h"
#include "engine/geometry/pose.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using Eigen::Vector3d;

/// "R_gyro_camera" by the camera's axes, where each is near one of the gyroscope's: "x -> -y".
std::string axes(const Eigen::Matrix3d& R_gyro_camera) {
  constexpr std::array kNames{"x", "y", "z"};
  constexpr double kNear_deg = 20;
  std::vector<std::string> all;
  for (int k = 0; k < 3; ++k) {
    const Vector3d axis = R_gyro_camera.col(k);
    Eigen::Index at = 0;
    axis.cwiseAbs().maxCoeff(&at);
    if (std::abs(axis(at)) < std::cos(radians(kNear_deg))) return "";
    all.push_back(fmt::format("{} along {}{}", kNames[k], axis(at) < 0 ? "-" : "", kNames[at]));
  }
  return fmt::format(" (the camera's {} of the gyroscope)", fmt::join(all, ", "));
}

std::string vector_text(const Vector3d& v, int digits) {
  return fmt::format("{:.{}f} {:.{}f} {:.{}f}", v.x(), digits, v.y(), digits, v.z(), digits);
}

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
/// Between windows the pictures tell nothing: a gap.
constexpr double kGap_s = 0.3;

}  // namespace

double rotation_between_deg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return degrees(so3_log(a.transpose() * b).norm());
}

std::string to_yaml(const GyroscopeFit& fit, const Camera& camera, const std::string& source) {
  const auto row_of = [&](int k) {
    const Vector3d r = fit.R_gyro_camera.row(k);
    return fmt::format("[{:.9f}, {:.9f}, {:.9f}, 0]", r.x(), r.y(), r.z());
  };
  std::string text = fmt::format(
      "# gyroscope on its camera, from {} windows of {}\n"
      "# rotation +- {} deg about the camera's axes, clock +- {:.2f} ms\n"
      "# bias {} +- {} rad/s\n",
      fit.windows,
      source,
      vector_text(fit.rotation_sigma_deg, 3),
      1e3 * fit.time_offset_sigma_s,
      vector_text(fit.bias_rad_s, 5),
      vector_text(fit.bias_sigma_rad_s, 5));
  if (fit.drift)
    text +=
        fmt::format("# the clocks drift by {:.1f} +- {:.1f} us/s, which this file cannot tell\n",
                    1e6 * *fit.drift,
                    1e6 * fit.drift_sigma);
  text += camera_yaml(camera, {.coefficient_digits = 8, .sigma_digits = 4});
  return text + fmt::format("T_BS: [{}, {}, {}, [0, 0, 0, 1]]\ntimeshift_cam_imu: {:.6f}  # s\n",
                            row_of(0),
                            row_of(1),
                            row_of(2),
                            fit.time_offset_s);
}

std::string to_text(const GyroscopeFit& fit, const Gyroscope& recorded) {
  std::string text =
      row("windows",
          fmt::format(
              "{} used{}",
              fit.windows,
              fit.outliers > 0 ? fmt::format(", {} left out that disagree", fit.outliers) : ""));
  const Vector3d rotation = so3_log(fit.R_gyro_camera);
  const double apart_deg = rotation_between_deg(fit.R_gyro_camera, recorded.R_gyro_camera);
  text += row("rotation",
              fmt::format("{} deg, {:.2f} deg from the recording's{}",
                          vector_text(degrees(1) * rotation, 2),
                          apart_deg,
                          axes(fit.R_gyro_camera)));
  text +=
      row("  +-",
          fmt::format("{} deg about the camera's axes", vector_text(fit.rotation_sigma_deg, 2)));
  text += row("clock",
              fmt::format("{:+.2f} +- {:.2f} ms (gyroscope's = camera's + this; the recording has "
                          "{:+.2f} ms)",
                          1e3 * fit.time_offset_s,
                          1e3 * fit.time_offset_sigma_s,
                          1e-6 * static_cast<double>(recorded.time_offset_ns)));
  if (fit.drift)
    text += row("drift",
                fmt::format("{:+.1f} +- {:.1f} us/s", 1e6 * *fit.drift, 1e6 * fit.drift_sigma));
  text += row(
      "bias",
      fmt::format(
          "{} +- {} rad/s", vector_text(fit.bias_rad_s, 4), vector_text(fit.bias_sigma_rad_s, 4)));
  text += row("speeds", fmt::format("correlation {:.3f}", fit.correlation));
  text += row(
      "residual",
      fmt::format("{:.3f} deg RMS over a window (before {:.3f})", fit.rms_deg, fit.rms_before_deg));
  for (const std::string& warning : fit.warnings) text += row("warning", warning);
  return text;
}

std::string why_it_does_not_fit(const GyroscopeFit& fit,
                                const Gyroscope& recorded,
                                double frame_period_s) {
  constexpr double kMost_deg = 5;
  constexpr double kSigmas = 5;
  if (!fit.ok) return "";
  std::vector<std::string> wrong;
  const double apart_deg = rotation_between_deg(fit.R_gyro_camera, recorded.R_gyro_camera);
  if (apart_deg > std::max(kMost_deg, kSigmas * fit.rotation_sigma_deg.maxCoeff()))
    wrong.push_back(fmt::format("its axes are {:.0f} deg off", apart_deg));
  const double late_s = fit.time_offset_s - 1e-9 * static_cast<double>(recorded.time_offset_ns);
  if (std::abs(late_s) > std::max(0.5 * frame_period_s, kSigmas * fit.time_offset_sigma_s))
    wrong.push_back(fmt::format("its clock is {:+.0f} ms off", 1e3 * late_s));
  if (wrong.empty()) return "";
  return fmt::format("the gyroscope does not fit the pictures: {}; see calibrate --gyroscope",
                     fmt::join(wrong, ", "));
}

std::vector<Chart> gyroscope_charts(const RatesOverTime& rates) {
  constexpr std::uint32_t kImages = 0x222222, kBefore = 0xD55E00, kAfter = 0x0072B2;
  const auto curve = [&](const char* name, std::uint32_t rgb, const auto& value) {
    Curve one;
    one.name = name;
    one.rgb = rgb;
    one.dotted = rgb == kBefore;
    for (std::size_t k = 0; k < rates.time_s.size(); ++k) {
      if (k > 0 && rates.time_s[k] - rates.time_s[k - 1] > kGap_s) {
        one.x.push_back(rates.time_s[k - 1] + 1e-6);
        one.y.push_back(kNothing);
      }
      one.x.push_back(rates.time_s[k]);
      one.y.push_back(value(k));
    }
    return one;
  };
  /// Rates of the gyroscope before and after calibration; `of(rates, k)` is the value of a sample.
  const auto both = [&](const auto& of) {
    return std::vector{
        curve("gyroscope, as recorded", kBefore, [&](auto k) { return of(rates.before_rad_s, k); }),
        curve("gyroscope, calibrated", kAfter, [&](auto k) { return of(rates.after_rad_s, k); })};
  };
  std::vector<Chart> charts;
  for (int axis = 0; axis < 3; ++axis) {
    const auto of = [&](const auto& all, std::size_t k) { return all[k](axis); };
    charts.push_back({.title = fmt::format("about {}", std::array{"x", "y", "z"}[axis]),
                      .x_label = "time [s]",
                      .y_label = "rate [rad/s]",
                      .curves = both(of)});
    auto& curves = charts.back().curves;
    curves.insert(curves.begin(), curve("pictures", kImages, [&](std::size_t k) {
                    return of(rates.images_rad_s, k);
                  }));
  }
  charts.push_back({.title = "what is left",
                    .x_label = "time [s]",
                    .y_label = "|difference| [rad/s]",
                    .curves = both([&](const auto& all, std::size_t k) {
                      return (all[k] - rates.images_rad_s[k]).norm();
                    })});
  return charts;
}

}  // namespace gpo
