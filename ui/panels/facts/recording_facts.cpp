// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/calibration/calibrate.h"
#include "engine/calibration/plane/plane_lens.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/window/timestamps.h"
#include "ui/panels/facts/facts.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

int digits_of(std::size_t k) { return k < 4 ? 2 : 5; }

/// Returns the text of parameter `k` of a camera: focal lengths and center in pixels, then
/// coefficients.
std::string with_sigma(double value, std::optional<double> sigma, std::size_t k) {
  const char* unit = k < 4 ? " px" : "";
  if (!sigma || *sigma == 0)
    return fmt::format("{:.{}f}{}{}", value, digits_of(k), unit, sigma ? " exact" : "");
  return fmt::format("{:.{}f} \u00b1{:.2g}{}", value, digits_of(k), *sigma, unit);
}

std::optional<double> sigma_of(const Camera& camera, std::size_t k) {
  return k < camera.sigmas.size() ? std::optional(camera.sigmas[k]) : std::nullopt;
}

/// Texts for the values of `CameraSource`.
constexpr const char* kSources[] = {
    "calibration file", "estimated from the images", "guessed field of view"};

/// Returns the angle between the rays of two pixels [deg]; nullopt beyond the lens model.
std::optional<double> angle_between_deg(const Camera& camera,
                                        const Vector2d& a,
                                        const Vector2d& b) {
  const Eigen::Matrix3d K_inverse = intrinsic_matrix(camera).inverse();
  const Vector3d ray_a = K_inverse * undistort(camera, a).homogeneous();
  const Vector3d ray_b = K_inverse * undistort(camera, b).homogeneous();
  const double deg = angle_deg(ray_a, ray_b);
  return std::isfinite(deg) ? std::optional(deg) : std::nullopt;
}

ResultRow view_row(const Camera& camera) {
  const double right = camera.width - 0.5, bottom = camera.height - 0.5;
  const auto text = [&](const Vector2d& a, const Vector2d& b) {
    const auto deg = angle_between_deg(camera, a, b);
    return deg ? fmt::format("{:.1f}\u00b0", *deg) : std::string("\u2013");
  };
  return {.label = "Field of view",
          .value = text({-0.5, camera.cy}, {right, camera.cy}) + " \u00d7 " +
                   text({camera.cx, -0.5}, {camera.cx, bottom}),
          .note = "diagonal " + text({-0.5, -0.5}, {right, bottom}),
          .tooltip = "Angle between the rays of opposite borders through the principal point"};
}

ResultGroup camera_group(const Recording& recording) {
  const Camera& camera = recording.camera;
  const bool guess = recording.camera_source == CameraSource::guess;
  ResultGroup group{
      "CAMERA",
      {{.label = "Source",
        .value = kSources[static_cast<std::size_t>(recording.camera_source)],
        .tooltip = guess ? "Run calibrate, or add a camera file" : "Source of the lens parameters",
        .color = guess ? Role::warning : Role::text},
       {.label = "Image",
        .value = fmt::format("{}\u00d7{} px", camera.width, camera.height),
        .tooltip = "Size of the recorded images"},
       view_row(camera),
       {.label = "Lens model",
        .value = distortion_name(camera.distortion),
        .tooltip = "Model of the distortion, as in camera files"}}};
  const std::vector<std::string> names = parameter_names(camera);
  const std::vector<double> values = parameters(camera);
  const bool by_images = recording.camera_source == CameraSource::self_calibrated;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto sigma = sigma_of(camera, k);
    const bool center = k == 2 || k == 3;
    const double least = kPriorOnly * LensPrior{}.sigma[2] * camera.width;
    const bool prior_only = by_images && center && sigma && *sigma > least;
    ResultRow row{.label = names[k],
                  .value = with_sigma(values[k], sigma, k),
                  .tooltip = sigma ? "Value and standard deviation"
                                   : "The calibration states no standard deviation"};
    if (prior_only) {
      row.note = "prior only";
      row.color = Role::warning;
      row.tooltip =
          "The images do not determine it: it is the center of the image, with the "
          "standard deviation of the prior";
    }
    group.rows.push_back(std::move(row));
  }
  const auto& readout = camera.readout;
  group.rows.push_back(
      readout
          ? ResultRow{.label = "Readout",
                      .value = fmt::format(
                          "{:.2f} \u00b1{:.2g} ms", 1e3 * readout->seconds, 1e3 * readout->sigma_s),
                      .tooltip = "Time from the first to the last row of an image"}
          : dash("Readout", "The rolling shutter's readout time is unknown"));
  return group;
}

ResultGroup sensor_group(const Recording& recording) {
  ResultGroup group{"GYROSCOPE", {}};
  const auto& gyroscope = recording.gyroscope;
  if (!gyroscope) {
    group.rows.push_back(dash("Gyroscope", "The recording has none"));
    return group;
  }
  const auto& pose = recording.T_body_camera;
  const Vector3d turn_deg = so3_log(gyroscope->R_gyro_camera) * degrees(1);
  group.rows.push_back(
      {.label = "Rate",
       .value = fmt::format("{:.4g} Hz", rate_hz(gyroscope->timestamps_ns)),
       .note = gyroscope->accelerations_m_s2.empty() ? "no accelerometer" : "with accelerometer",
       .tooltip = "Median rate of the samples"});
  group.rows.push_back({.label = "Axes",
                        .value = fmt::format("({:.1f})\u00b0", fmt::join(turn_deg, ", ")),
                        .tooltip = "Rotation vector from camera axes to those of the gyroscope"});
  group.rows.push_back(
      pose ? ResultRow{.label = "Camera center",
                       .value = fmt::format("({:.4f}) m", fmt::join(pose->p_wc, ", ")),
                       .tooltip = "In the axes of the IMU"}
           : dash("Camera center", "The calibration does not state the camera's pose on the IMU"));
  group.rows.push_back(
      {.label = "Clock",
       .value = fmt::format("{:+.2f} ms", 1e-6 * static_cast<double>(gyroscope->time_offset_ns)),
       .tooltip = "Clock of the gyroscope minus that of the camera"});
  group.rows.push_back(
      {.label = "Bias",
       .value = fmt::format("({:.4f}) rad/s", fmt::join(gyroscope->bias_rad_s, ", ")),
       .note = gyroscope->bias_source,
       .tooltip = fmt::format("Subtracted from the rates; standard deviation "
                              "{:.2g} rad/s",
                              gyroscope->bias_sigma_rad_s)});
  return group;
}

/// Describes the intervals that are longer than `factor` median periods. Their times are counted
/// from `first_ns`.
ResultRow gap_row(const char* label,
                  std::span<const std::int64_t> times_ns,
                  double factor,
                  std::int64_t first_ns) {
  const std::int64_t period_ns = median_period_ns(times_ns);
  int count = 0;
  std::int64_t longest_ns = 0, at_ns = 0;
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    const std::int64_t step_ns = times_ns[i] - times_ns[i - 1];
    if (static_cast<double>(step_ns) <= factor * static_cast<double>(period_ns)) continue;
    ++count;
    if (step_ns > longest_ns) at_ns = times_ns[i - 1];
    longest_ns = std::max(longest_ns, step_ns);
  }
  const std::string tooltip = fmt::format("Intervals longer than {:g} median periods", factor);
  if (count == 0) return {.label = label, .value = "none", .tooltip = tooltip};
  return {.label = label,
          .value = counted(count, "gap"),
          .note = fmt::format("longest {:.3f} s at {:.2f} s",
                              1e-9 * static_cast<double>(longest_ns),
                              1e-9 * static_cast<double>(at_ns - first_ns)),
          .tooltip = tooltip,
          .color = Role::warning};
}

ResultGroup time_group(const Recording& recording) {
  const auto& times_ns = recording.timestamps_ns;
  ResultGroup group{"TIME AND TRUTH", {}};
  if (times_ns.empty()) return group;
  const double seconds = 1e-9 * static_cast<double>(times_ns.back() - times_ns.front());
  group.rows.push_back({.label = "Frames",
                        .value = fmt::format("{} at {:.4g} Hz", times_ns.size(), rate_hz(times_ns)),
                        .note = fmt::format("{:.2f} s", seconds),
                        .tooltip = "Number, median rate and duration"});
  group.rows.push_back(gap_row("Frame gaps", times_ns, 1.5, times_ns.front()));
  if (const auto& gyroscope = recording.gyroscope)
    group.rows.push_back(gap_row(
        "Sample gaps", gyroscope->timestamps_ns, 5, times_ns.front() + gyroscope->time_offset_ns));
  const auto& truth = recording.truth;
  if (!truth) {
    group.rows.push_back(dash(
        "Ground truth",
        recording.board ? "Computed from the board for each window" : "The recording has none"));
    return group;
  }
  const auto known =
      std::ranges::count_if(truth->poses, [](const auto& pose) { return pose.has_value(); });
  group.rows.push_back({.label = "Ground truth",
                        .value = counted(known, "pose"),
                        .note = truth->source,
                        .tooltip = "Frames with a true pose, and their file"});
  ResultRow jumps{.label = "Truth jumps",
                  .value = truth->jumps.empty() ? "none" : counted(truth->jumps.size(), "jump"),
                  .tooltip = "Steps of the true poses that no camera makes",
                  .color = truth->jumps.empty() ? Role::text : Role::warning};
  if (!truth->jumps.empty()) {
    const TruthJump& first = truth->jumps.front();
    jumps.note = fmt::format("first {:.1f}\u00b0, {:.3f} m at {:.2f} s",
                             first.angle_deg,
                             first.step_m,
                             1e-9 * static_cast<double>(first.first_ns - times_ns.front()));
  }
  group.rows.push_back(std::move(jumps));
  return group;
}

/// From the first time stamps only: this runs in every frame of the window.
double rate_at_start_hz(std::span<const std::int64_t> timestamps_ns) {
  constexpr std::size_t kEnough = 200;
  return rate_hz(timestamps_ns.first(std::min(timestamps_ns.size(), kEnough)));
}

}  // namespace

std::vector<std::string> recording_facts(const Recording& recording) {
  std::vector<std::string> facts = {
      recording.name,
      fmt::format("{}\u00d7{}", recording.camera.width, recording.camera.height),
      counted(recording.frame_count(), "frame")};
  const double frames_hz = rate_at_start_hz(recording.timestamps_ns);
  if (frames_hz > 0) facts.back() += fmt::format(" at {:.3g} Hz", frames_hz);
  const double gyro_hz =
      recording.gyroscope ? rate_at_start_hz(recording.gyroscope->timestamps_ns) : 0;
  facts.push_back(gyro_hz > 0           ? fmt::format("gyro {:.3g} Hz", gyro_hz)
                  : recording.gyroscope ? "gyro"
                                        : "no gyro");
  facts.push_back(recording.truth   ? "ground truth"
                  : recording.board ? "ground truth from the board"
                                    : "no ground truth");
  if (recording.camera_source == CameraSource::guess) facts.emplace_back("not calibrated");
  if (recording.camera_source == CameraSource::self_calibrated)
    facts.emplace_back("self-calibrated");
  return facts;
}

std::vector<ResultGroup> recording_groups(const Recording& recording) {
  return {camera_group(recording), sensor_group(recording), time_group(recording)};
}

std::vector<ResultRow> calibration_changes(const Camera& before, const Camera& after) {
  const auto names = parameter_names(after);
  const auto now = parameters(after);
  const auto old_names = parameter_names(before);
  const auto old = parameters(before);
  std::vector<ResultRow> rows;
  for (std::size_t k = 0; k < now.size(); ++k) {
    const auto found = std::ranges::find(old_names, names[k]);
    const double was =
        found == old_names.end() ? 0 : old[static_cast<std::size_t>(found - old_names.begin())];
    rows.push_back(
        {.label = names[k],
         .value = fmt::format(
             "{:.{}f} \u2192 {}", was, digits_of(k), with_sigma(now[k], sigma_of(after, k), k)),
         .note = fmt::format("{:+.{}f}", now[k] - was, digits_of(k)),
         .tooltip = "Before and after the calibration, and the change"});
  }
  return rows;
}

std::vector<std::vector<Vector2d>> distortion_grid(const Camera& camera, int cells) {
  constexpr int kPieces = 8;  // per cell
  const double step = static_cast<double>(std::max(camera.width, camera.height)) / cells;
  std::vector<std::vector<Vector2d>> lines;
  const auto add = [&](const Vector2d& from, const Vector2d& to) {
    const int pieces = std::max(2, static_cast<int>(kPieces * (to - from).norm() / step));
    std::vector<Vector2d>& line = lines.emplace_back();
    for (int i = 0; i <= pieces; ++i) {
      const Vector2d raw_px = distort(camera, from + (to - from) * i / pieces);
      if (raw_px.allFinite()) line.push_back(raw_px);
    }
  };
  const double right = camera.width - 0.5, bottom = camera.height - 0.5;
  for (double x = -0.5; x <= right + 1e-6; x += step) add({x, -0.5}, {x, bottom});
  for (double y = -0.5; y <= bottom + 1e-6; y += step) add({-0.5, y}, {right, y});
  return lines;
}

}  // namespace gpo
