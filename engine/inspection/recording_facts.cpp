// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/recording_facts.h"

namespace gpo {
namespace {

constexpr std::ptrdiff_t kLeastRotations = 10;

ClockReference true_rotations(const Recording& recording) {
  ClockReference reference{.source = "the ground truth", .timestamps_ns = {}, .R_wc = {}};
  if (!recording.truth) return reference;
  const auto& poses = recording.truth->poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i]) continue;
    reference.timestamps_ns.push_back(recording.timestamps_ns[i]);
    reference.R_wc.push_back(poses[i]->R_wc);
  }
  return reference;
}

ClockReference integrated_rates(const Gyroscope& gyroscope) {
  ClockReference reference{
      .source = "the gyroscope", .timestamps_ns = {}, .R_wc = {}, .rates_are_biased = true};
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  const auto& times_ns = gyroscope.timestamps_ns;
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    if (i > 0) {
      const double dt_s = 1e-9 * static_cast<double>(times_ns[i] - times_ns[i - 1]);
      const Eigen::Vector3d mean = 0.5 * (gyroscope.rates_rad_s[i - 1] + gyroscope.rates_rad_s[i]);
      R = R * so3_exp(gyroscope.R_gyro_camera.transpose() * (mean - gyroscope.bias_rad_s) * dt_s);
    }
    reference.timestamps_ns.push_back(times_ns[i] - gyroscope.time_offset_ns);
    reference.R_wc.push_back(R);
  }
  return reference;
}

}  // namespace

RecordingFacts recording_facts(const Recording& recording) {
  RecordingFacts facts{.name = recording.name, .T_body_camera = recording.T_body_camera};
  ClockReference reference = true_rotations(recording);
  if (std::ssize(reference.R_wc) < kLeastRotations && recording.gyroscope)
    reference = integrated_rates(*recording.gyroscope);
  if (std::ssize(reference.R_wc) >= kLeastRotations)
    facts.clock = std::make_shared<const ClockReference>(std::move(reference));
  return facts;
}

}  // namespace gpo
