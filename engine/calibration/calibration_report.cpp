// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/calibration_report.h"

#include "engine/base/error.h"
#include "engine/recording/layouts/write_recording.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

template <typename... Values>
std::string row(const char* name, fmt::format_string<Values...> format, Values&&... values) {
  return fmt::format("{:<12}{}\n", name, fmt::format(format, std::forward<Values>(values)...));
}

std::string warning_lines(const char* prefix, const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) text += prefix + warning + "\n";
  return text;
}

struct YamlStyle {
  int coefficient_digits = 6;
  int sigma_digits = 3;
  const char* source = "";
  const char* sigmas_remark = "";
};

std::string camera_yaml(const Camera& camera, const YamlStyle& style) {
  const std::vector<double> all = parameters(camera);
  const std::span<const double> values = all;
  std::string text = fmt::format(
      "resolution: [{}, {}]\ncamera_model: pinhole\n{}intrinsics: {}  # fx, fy, cx, cy\n",
      camera.width,
      camera.height,
      style.source,
      yaml_list(values.first(4), 8));
  if (camera.distortion != Distortion::none)
    text += fmt::format(
        "distortion_model: {}\ndistortion_coefficients: {}\n",
        camera.distortion == Distortion::equidistant ? "equidistant" : "radial-tangential",
        yaml_list(values.subspan(4), style.coefficient_digits));
  text += readout_yaml(camera);
  if (camera.sigmas.empty()) return text;
  return text + style.sigmas_remark + lens_uncertainty_yaml(camera, style.sigma_digits);
}

std::string parameter_rows(const Camera& camera) {
  const auto names = parameter_names(camera);
  const auto values = parameters(camera);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += i < 4 ? row(names[i].c_str(), "{:10.2f} +- {:.2f} px", values[i], camera.sigmas[i])
                  : row(names[i].c_str(), "{:10.5f} +- {:.5f}", values[i], camera.sigmas[i]);
  return text;
}

std::string seen(const CameraCalibration& calibration) {
  return fmt::format("corners in {:.0f} % of the image, board slanted by up to {:.0f} deg",
                     100 * calibration.coverage,
                     calibration.slant_deg);
}

std::string board(const CameraCalibration& calibration) {
  return fmt::format("not flat: corners are up to {:.2g} mm off a plane, which the fit includes",
                     1000 * calibration.bend_m);
}

std::string seen(const PlaneLens& lens) {
  return fmt::format(
      "{} points in {} images{}, normals up to {:.0f} deg apart, moved by {:.2f} distances",
      lens.points,
      lens.views,
      lens.gyroscope ? " and the gyroscope" : "",
      lens.tilt_deg,
      lens.moved);
}

std::string readout_row(const Camera& camera) {
  if (!camera.readout) return "";
  return row("readout",
             "{:10.2f} +- {:.2f} ms, first row to last",
             1e3 * camera.readout->seconds,
             1e3 * camera.readout->sigma_s);
}

std::string readout(const PlaneLens& lens) {
  return fmt::format("{:10.3f} +- {:.3f} frame intervals, first row to last",
                     lens.lens[kReadout],
                     lens.sigma[kReadout]);
}

std::vector<std::string> warnings_of(const PlaneLens& lens) {
  std::vector<std::string> all;
  std::vector<const char*> by_prior;
  for (int k = 0; k < kLensUnknowns; ++k)
    if (lens.prior_only[k]) by_prior.push_back(kLensNames[k]);
  if (!by_prior.empty()) all.push_back(fmt::format("{}: prior only", fmt::join(by_prior, ", ")));
  if (!lens.left_out.empty())
    all.push_back(fmt::format("left out, as they disagree with the others: frames {}",
                              fmt::join(lens.left_out, ", ")));
  return all;
}

double rotation_between_deg(const Matrix3d& a, const Matrix3d& b) {
  return degrees(so3_log(a.transpose() * b).norm());
}

/// The camera's axes as axes of the gyroscope, "x along -y, ..."; empty if one is not near any.
std::string axes(const Matrix3d& R_gyro_camera) {
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

/// Beyond a right angle a standard deviation of a rotation means nothing.
std::string sigmas_text(const Vector3d& sigma_deg, int digits) {
  const auto one = [&](int axis) {
    return sigma_deg[axis] > 90 ? "undetermined" : fmt::format("{:.{}f}", sigma_deg[axis], digits);
  };
  return fmt::format("{} {} {} deg about the camera's axes", one(0), one(1), one(2));
}

struct RateSource {
  const char* name;
  std::uint32_t rgb;
  bool dotted;
  std::function<Vector3d(const Interval&)> rate;
};

Curve curve_of(const RateSource& source,
               const std::vector<Interval>& intervals,
               const std::function<double(const Interval&, const Vector3d& rate)>& value) {
  constexpr double kGap_s = 0.3;
  Curve one;
  one.name = source.name;
  one.rgb = source.rgb;
  one.dotted = source.dotted;
  double last_s = 0;
  for (const Interval& interval : intervals) {
    const std::int64_t middle_ns = interval.from_ns + (interval.to_ns - interval.from_ns) / 2;
    const double time_s = 1e-9 * static_cast<double>(middle_ns - intervals.front().from_ns);
    if (!one.x.empty() && time_s - last_s > kGap_s) {
      one.x.push_back(last_s + 1e-6);
      one.y.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    one.x.push_back(last_s = time_s);
    one.y.push_back(value(interval, source.rate(interval)));
  }
  return one;
}

}  // namespace

std::string to_yaml(const CameraCalibration& calibration, const std::string& source) {
  std::string text = fmt::format("# calibrated from {}: {} views of a board, RMS {:.2f} px\n# {}\n",
                                 source,
                                 calibration.frames.size(),
                                 calibration.rms_px,
                                 seen(calibration));
  if (calibration.bend_m > 0) text += fmt::format("# board {}\n", board(calibration));
  return text + warning_lines("# warning: ", calibration.warnings) +
         camera_yaml(calibration.camera,
                     {.sigmas_remark = "# standard deviations, from leaving out blocks of time\n"});
}

std::string to_text(const CameraCalibration& calibration) {
  return row("views",
             "{} used; found the board in {} of {} images",
             calibration.frames.size(),
             calibration.found,
             calibration.examined) +
         row("RMS", "{:.3f} px", calibration.rms_px) + parameter_rows(calibration.camera) +
         readout_row(calibration.camera) + row("seen", "{}", seen(calibration)) +
         (calibration.bend_m > 0 ? row("board", "{}", board(calibration)) : "") +
         warning_lines("warning     ", calibration.warnings);
}

std::string to_yaml(const PlaneLens& lens, const std::string& source) {
  return fmt::format("# calibrated from {} and a plane in view, RMS {:.2f} px\n# {}\n# {}: {}\n",
                     source,
                     lens.rms_px,
                     seen(lens),
                     kLensNames[kReadout],
                     readout(lens)) +
         warning_lines("# warning: ", warnings_of(lens)) +
         camera_yaml(lens.camera, {.source = "source: self-calibrated\n"});
}

std::string to_text(const PlaneLens& lens) {
  return row("seen", "{}", seen(lens)) + row("RMS", "{:.3f} px", lens.rms_px) +
         parameter_rows(lens.camera) + row(kLensNames[kReadout], "{}", readout(lens)) +
         warning_lines("warning     ", warnings_of(lens));
}

std::string to_yaml(const GyroscopeFit& fit,
                    const Camera& camera,
                    const std::string& source,
                    const Eigen::Vector3d& lever_arm_m) {
  std::string text = fmt::format(
      "# gyroscope on its camera, from {} windows of {}\n"
      "# rotation +- {}, clock +- {:.2f} ms\n"
      "# bias {} +- {} rad/s\n",
      fit.windows,
      source,
      sigmas_text(fit.rotation_sigma_deg, 3),
      1e3 * fit.time_offset_sigma_s,
      vector_text(fit.bias_rad_s, 5),
      vector_text(fit.bias_sigma_rad_s, 5));
  text += lever_arm_m.isZero() ? "# position of the camera unknown: 0\n"
                               : "# position of the camera from the recording\n";
  if (fit.drift)
    text += fmt::format("# the clocks drift by {:.1f} +- {:.1f} us/s, not included in this file\n",
                        1e6 * *fit.drift,
                        1e6 * fit.drift_sigma);
  text += camera_yaml(camera, {.coefficient_digits = 8, .sigma_digits = 4}) + "T_BS: [";
  for (int row = 0; row < 3; ++row) {
    const Eigen::RowVector3d r = fit.R_gyro_camera.row(row);
    text +=
        fmt::format("[{:.9f}, {:.9f}, {:.9f}, {:.6g}], ", r.x(), r.y(), r.z(), lever_arm_m[row]);
  }
  return text + fmt::format("[0, 0, 0, 1]]\ntimeshift_cam_imu: {:.6f}  # s\n", fit.time_offset_s);
}

std::string to_text(const GyroscopeFit& fit, const Gyroscope& recorded) {
  std::string windows = fmt::format("{} used", fit.windows);
  if (fit.outliers > 0) windows += ", " + counted(fit.outliers, "outlier") + " left out";
  std::string text =
      row("windows", "{}", windows) +
      row("rotation",
          "{} deg, {:.2f} deg from the recording's{}",
          vector_text(degrees(1) * so3_log(fit.R_gyro_camera), 2),
          rotation_between_deg(fit.R_gyro_camera, recorded.R_gyro_camera),
          axes(fit.R_gyro_camera)) +
      row("  +-", "{}", sigmas_text(fit.rotation_sigma_deg, 2)) +
      row("clock",
          "{:+.2f} +- {:.2f} ms (gyroscope's minus camera's; the recording has {:+.2f} ms)",
          1e3 * fit.time_offset_s,
          1e3 * fit.time_offset_sigma_s,
          1e-6 * static_cast<double>(recorded.time_offset_ns));
  if (fit.drift)
    text += row("drift", "{:+.1f} +- {:.1f} us/s", 1e6 * *fit.drift, 1e6 * fit.drift_sigma);
  return text +
         row("bias",
             "{} +- {} rad/s",
             vector_text(fit.bias_rad_s, 4),
             vector_text(fit.bias_sigma_rad_s, 4)) +
         row("speeds", "correlation {:.3f}", fit.correlation) +
         row("residual",
             "{:.3f} deg RMS over a window (before {:.3f})",
             fit.rms_deg,
             fit.rms_before_deg) +
         warning_lines("warning     ", fit.warnings);
}

std::string why_it_does_not_fit(const GyroscopeFit& fit,
                                const Gyroscope& recorded,
                                double frame_period_s) {
  constexpr double kMost_deg = 5;
  constexpr double kSigmas = 5;
  if (!fit.ok)
    return fit.differs ? fmt::format(
                             "the gyroscope does not fit the images: {}; run calibrate "
                             "--gyroscope, or stabilization is on",
                             fit.reason)
                       : "";
  std::vector<std::string> wrong = fit.warnings;
  const double apart_deg = rotation_between_deg(fit.R_gyro_camera, recorded.R_gyro_camera);
  if (apart_deg > std::max(kMost_deg, kSigmas * fit.rotation_sigma_deg.maxCoeff()))
    wrong.push_back(fmt::format("its axes are {:.0f} deg off", apart_deg));
  const double late_s = fit.time_offset_s - 1e-9 * static_cast<double>(recorded.time_offset_ns);
  if (std::abs(late_s) > std::max(0.5 * frame_period_s, kSigmas * fit.time_offset_sigma_s))
    wrong.push_back(fmt::format("its clock is {:+.0f} ms off", 1e3 * late_s));
  if (wrong.empty()) return "";
  return fmt::format("the gyroscope does not fit the images: {}; run calibrate --gyroscope",
                     fmt::join(wrong, ", "));
}

std::string comparison_text(const Camera& found, const Camera& recorded) {
  std::string text = "compared with the recording's calibration:\n";
  const auto names = parameter_names(found);
  const auto now = parameters(found), before = parameters(recorded);
  const bool same_model = found.distortion == recorded.distortion;
  const std::size_t count = same_model ? std::min(now.size(), before.size()) : 4;
  const auto sigma_of = [](const Camera& camera, std::size_t k) {
    return k < camera.sigmas.size() ? camera.sigmas[k] : 0;
  };
  for (std::size_t k = 0; k < count; ++k) {
    const int digits = k < 4 ? 2 : 5;
    const double known = sigma_of(recorded, k), sigma = std::hypot(sigma_of(found, k), known);
    text += row(names[k].c_str(),
                "{:10.{}f}, recorded {:.{}f}{}: {:+.{}f}{} ({})",
                now[k],
                digits,
                before[k],
                digits,
                known > 0 ? fmt::format(" +- {:.{}f}", known, digits) : "",
                now[k] - before[k],
                digits,
                k < 4 ? " px" : "",
                sigma > 0 ? fmt::format("{:+.1f} sigma", (now[k] - before[k]) / sigma)
                          : "no standard deviation");
  }
  if (!same_model)
    text += fmt::format("The lens models differ ({}, recorded {}), so are the coefficients\n",
                        lens_model(found.distortion).name,
                        lens_model(recorded.distortion).name);
  return text;
}

std::vector<Chart> gyroscope_charts(const std::vector<ImageRotations>& windows,
                                    const Gyroscope& gyroscope,
                                    const GyroscopeFit& fit) {
  const RateIntegral integral(gyroscope);
  const std::vector<Interval> intervals = intervals_of(windows);
  const auto by_gyroscope =
      [&](const Matrix3d& R_gyro_camera, const Vector3d& bias, double offset_s) {
        return [&integral, R_gyro_camera, bias, offset_ns = to_ns(offset_s)](const Interval& one) {
          const auto rate = integral.mean_rate(one.from_ns + offset_ns, one.to_ns + offset_ns);
          if (!rate) return Vector3d(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
          return Vector3d(R_gyro_camera.transpose() * (*rate - bias));
        };
      };
  const double recorded_offset_s = 1e-9 * static_cast<double>(gyroscope.time_offset_ns);
  const std::array sources{
      RateSource{"images", 0x222222, false, [](const Interval& one) { return one.rate_rad_s; }},
      RateSource{"gyroscope, as recorded",
                 0xD55E00,
                 true,
                 by_gyroscope(gyroscope.R_gyro_camera, gyroscope.bias_rad_s, recorded_offset_s)},
      RateSource{"gyroscope, calibrated",
                 0x0072B2,
                 false,
                 by_gyroscope(fit.R_gyro_camera, fit.bias_rad_s, fit.time_offset_s)}};
  std::vector<Chart> charts;
  for (int axis = 0; axis < 3; ++axis) {
    const auto rate_about = [&](const Interval&, const Vector3d& rate) { return rate(axis); };
    std::vector<Curve> curves;
    for (const RateSource& source : sources)
      curves.push_back(curve_of(source, intervals, rate_about));
    charts.push_back({.title = fmt::format("about {}", std::array{"x", "y", "z"}[axis]),
                      .x_label = "time [s]",
                      .y_label = "rate [rad/s]",
                      .curves = std::move(curves)});
  }
  const auto difference = [](const Interval& one, const Vector3d& rate) {
    return (rate - one.rate_rad_s).norm();
  };
  charts.push_back({.title = "difference from the images",
                    .x_label = "time [s]",
                    .y_label = "|difference| [rad/s]",
                    .curves = {curve_of(sources[1], intervals, difference),
                               curve_of(sources[2], intervals, difference)}});
  return charts;
}

}  // namespace gpo
