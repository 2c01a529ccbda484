// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/pipeline/pipeline.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kMostSkew = 1e-6;  // of each entry of R^T R - I

bool is_rotation(const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d skewed = R.transpose() * R - Eigen::Matrix3d::Identity();
  return skewed.cwiseAbs().maxCoeff() < kMostSkew && R.determinant() > 0;
}

}  // namespace

void check_options(const InitializeOptions& options) {
  options.method.row();
  if (!(options.ransac_threshold_px > 0)) {
    throw SettingError("ransac_threshold_px",
                       fmt::format("{}, expected more than 0", options.ransac_threshold_px));
  }
  if (options.plane < 1)
    throw SettingError("plane", fmt::format("{}, expected at least 1", options.plane));
}

void check_frame(const Frame& frame, int number, const Frame* before) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("frame {}: {}", number, what));
  };
  if (before != nullptr && frame.timestamp_ns <= before->timestamp_ns) {
    refuse(fmt::format(
        "time stamp {} does not come after {}", frame.timestamp_ns, before->timestamp_ns));
  }
  if (static_cast<Eigen::Index>(frame.ids.size()) != frame.raw_px.cols()) {
    refuse(fmt::format(
        "{} ids and {} pixels, expected equal counts", frame.ids.size(), frame.raw_px.cols()));
  }
  if (!frame.raw_px.allFinite()) refuse("a pixel is not finite");
  std::vector<std::int64_t> ids = frame.ids;
  std::ranges::sort(ids);
  if (const auto twice = std::ranges::adjacent_find(ids); twice != ids.end())
    refuse(fmt::format("track {} is seen twice", *twice));
  if (before != nullptr && before->R_wc.has_value() != frame.R_wc.has_value())
    refuse("expected rotations of all frames or of none");
  if (frame.R_wc && !is_rotation(*frame.R_wc)) refuse("R_wc is not a rotation");
}

void check_gyroscope(const Gyroscope& gyroscope) {
  const auto& t = gyroscope.timestamps_ns;
  if (t.size() != gyroscope.rates_rad_s.size()) {
    throw InputError(fmt::format("gyroscope: {} time stamps and {} rates, expected equal counts",
                                 t.size(),
                                 gyroscope.rates_rad_s.size()));
  }
  if (const auto back = std::ranges::adjacent_find(t, std::ranges::greater_equal());
      back != t.end())
    throw InputError(
        fmt::format("gyroscope: time stamp {} does not come after {}", *(back + 1), *back));
  for (const Eigen::Vector3d& rate : gyroscope.rates_rad_s)
    if (!rate.allFinite()) throw InputError("gyroscope: a rate is not finite");
  const auto& accelerations = gyroscope.accelerations_m_s2;
  if (!accelerations.empty() && accelerations.size() != t.size())
    throw InputError(fmt::format(
        "accelerometer: {} time stamps and {} accelerations, expected equal counts or none",
        t.size(),
        accelerations.size()));
  for (const Eigen::Vector3d& acceleration : accelerations)
    if (!acceleration.allFinite()) throw InputError("accelerometer: an acceleration is not finite");
  if (!is_rotation(gyroscope.R_gyro_camera))
    throw InputError("gyroscope: R_gyro_camera is not a rotation");
}

}  // namespace gpo
