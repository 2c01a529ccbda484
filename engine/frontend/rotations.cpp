// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/rotations.h"

#include "engine/base/error.h"
#include "engine/geometry/pose.h"
#include "engine/window/timestamps.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kGapPeriods = 5;
constexpr double kMarginPeriods = 1.5;  // beyond the first and the last sample the rate is held

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Refuses a window whose times the samples do not cover closely. Times on the gyroscope's clock.
void check_coverage(const Gyroscope& gyroscope, std::int64_t first_ns, std::int64_t last_ns) {
  const auto& t = gyroscope.timestamps_ns;
  const std::string file = gyroscope.file.string();
  if (t.size() < 2)
    throw InputError(fmt::format("{}: {} samples, expected at least 2", file, t.size()));
  const auto period_ns = static_cast<double>(median_period_ns(t));
  const double margin_ns = kMarginPeriods * period_ns;
  if (static_cast<double>(t.front() - first_ns) > margin_ns) {
    throw InputError(
        fmt::format("{}:{}: the gyroscope starts at {} ns, {:.3f} s after the window's first frame",
                    file,
                    gyroscope.lines.front(),
                    t.front(),
                    seconds(t.front() - first_ns)));
  }
  if (static_cast<double>(last_ns - t.back()) > margin_ns) {
    throw InputError(
        fmt::format("{}:{}: the gyroscope ends at {} ns, {:.3f} s before the window's last frame",
                    file,
                    gyroscope.lines.back(),
                    t.back(),
                    seconds(last_ns - t.back())));
  }
  for (std::size_t k = 1; k < t.size(); ++k) {
    const std::int64_t dt_ns = t[k] - t[k - 1];
    const bool inside = t[k] > first_ns && t[k - 1] < last_ns;
    if (inside && dt_ns <= 0) {
      throw InputError(fmt::format(
          "{}:{}: time stamp {} does not come after {}", file, gyroscope.lines[k], t[k], t[k - 1]));
    }
    if (inside && static_cast<double>(dt_ns) > kGapPeriods * period_ns) {
      throw InputError(
          fmt::format("{}:{}: gap of {:.3f} s in the gyroscope's samples before {} ns, inside the "
                      "window; expected about {:.4f} s",
                      file,
                      gyroscope.lines[k],
                      seconds(dt_ns),
                      t[k],
                      period_ns * 1e-9));
    }
  }
}

/// The rate at a time, linear between samples, held beyond them.
Eigen::Vector3d rate_at(const Gyroscope& gyroscope, std::int64_t t_ns) {
  const auto& t = gyroscope.timestamps_ns;
  const auto after = std::ranges::upper_bound(t, t_ns);
  if (after == t.begin()) return gyroscope.rates_rad_s.front();
  if (after == t.end()) return gyroscope.rates_rad_s.back();
  const auto k = static_cast<std::size_t>(after - t.begin());
  const double u = static_cast<double>(t_ns - t[k - 1]) / static_cast<double>(t[k] - t[k - 1]);
  return (1 - u) * gyroscope.rates_rad_s[k - 1] + u * gyroscope.rates_rad_s[k];
}

/// Rotation from the gyroscope's axes now to those at the first frame, and how it moves with the
/// bias: R_first_now(bias + db) ~ R_first_now exp(d_bias db).
struct Turn {
  Eigen::Matrix3d R_first_now = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d d_bias = Eigen::Matrix3d::Zero();  ///< [s]
};

/// Goes on at a constant rate (Forster et al., "On-Manifold Preintegration", eq. 44 with its sum as
/// a recursion).
void advance(Turn& turn, const Eigen::Vector3d& rate_rad_s, double dt_s) {
  const Eigen::Vector3d step = rate_rad_s * dt_s;
  const Eigen::Matrix3d R_step = so3_exp(step);
  turn.R_first_now = turn.R_first_now * R_step;
  turn.d_bias = R_step.transpose() * turn.d_bias - so3_right_jacobian(step) * dt_s;
}

/// From one time to another by the mid-point rule over the samples between.
void advance(Turn& turn, const Gyroscope& gyroscope, std::int64_t from_ns, std::int64_t to_ns) {
  const auto& t = gyroscope.timestamps_ns;
  std::int64_t now_ns = from_ns;
  Eigen::Vector3d rate = rate_at(gyroscope, from_ns);
  auto sample = static_cast<std::size_t>(std::ranges::upper_bound(t, from_ns) - t.begin());
  while (now_ns < to_ns) {
    const bool has_sample = sample < t.size() && t[sample] < to_ns;
    const std::int64_t next_ns = has_sample ? t[sample] : to_ns;
    const Eigen::Vector3d next_rate =
        has_sample ? gyroscope.rates_rad_s[sample] : rate_at(gyroscope, to_ns);
    advance(turn, 0.5 * (rate + next_rate) - gyroscope.bias_rad_s, seconds(next_ns - now_ns));
    now_ns = next_ns;
    rate = next_rate;
    ++sample;
  }
}

}  // namespace

bool needs_gyroscope(RotationSource source) {
  return source == RotationSource::gyro || source == RotationSource::gyro_calibrated;
}

Rotations sensitive_gyro_rotations(const Gyroscope& gyroscope,
                                   std::span<const std::int64_t> frame_times_ns) {
  std::vector<std::int64_t> times_ns(frame_times_ns.begin(), frame_times_ns.end());
  for (std::int64_t& t : times_ns) t += gyroscope.time_offset_ns;
  check_coverage(gyroscope, times_ns.front(), times_ns.back());
  const Eigen::Matrix3d R_cg = gyroscope.R_gyro_camera.transpose();
  const auto rate = [&](std::int64_t t_ns) -> Eigen::Vector3d {
    return rate_at(gyroscope, t_ns) - gyroscope.bias_rad_s;
  };
  const Eigen::Vector3d first_rate = rate(times_ns.front());
  Rotations rotations{.model = RotationModel::bias};
  const double sigma_rad_s = gyroscope.bias_sigma_rad_s;
  GyroSensitivity gyro{gyroscope.bias_rad_s,
                       gyroscope.bias_rad_s,
                       sigma_rad_s,
                       sigma_rad_s * sigma_rad_s * Eigen::Matrix3d::Identity(),
                       gyroscope.noise_density,
                       {},
                       {}};
  Turn turn;
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    if (i > 0) advance(turn, gyroscope, times_ns[i - 1], times_ns[i]);
    rotations.R_wc.push_back(R_cg * turn.R_first_now * R_cg.transpose());
    gyro.d_bias.push_back(R_cg * turn.d_bias);
    // A later clock drops the first frame's turn and adds the last one's:
    // exp(-w_1 dt) R exp(w_i dt) = R exp((w_i - R^T w_1) dt), all in the gyroscope's axes.
    gyro.d_offset.push_back(R_cg * (rate(times_ns[i]) - turn.R_first_now.transpose() * first_rate));
  }
  rotations.gyro = std::move(gyro);
  return rotations;
}

std::vector<Eigen::Matrix3d> gyro_rotations(const Gyroscope& gyroscope,
                                            std::span<const std::int64_t> frame_times_ns) {
  return sensitive_gyro_rotations(gyroscope, frame_times_ns).R_wc;
}

}  // namespace gpo
