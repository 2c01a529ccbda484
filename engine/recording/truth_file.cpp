// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/truth_file.h"

#include "engine/recording/csv_table.h"
#include "engine/recording/timestamps.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace gpo {

namespace {

constexpr int kBiasColumn = 11;  // of b_w in: t, p (3), q (4), v (3), b_w (3), b_a (3)
constexpr std::size_t kColumnsWithBias = 17;

Pose pose_of(const CsvTable& table, const CsvRow& row) {
  const auto value = [&](int column) { return csv_number(table, row, column); };
  const Eigen::Quaterniond q(value(4), value(5), value(6), value(7));
  if (std::abs(q.norm() - 1) > 1e-2) {
    csv_fail(
        table, row.line, "a quaternion of norm " + std::to_string(q.norm()), "a unit quaternion");
  }
  return {q.normalized().toRotationMatrix(), {value(1), value(2), value(3)}};
}

std::optional<Eigen::Vector3d> mean_bias(const CsvTable& table) {
  if (table.rows[0].cells.size() != kColumnsWithBias) return std::nullopt;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& row : table.rows) {
    for (int i = 0; i < 3; ++i) sum[i] += csv_number(table, row, kBiasColumn + i);
  }
  return sum / static_cast<double>(table.rows.size());
}

}  // namespace

BodyPath read_body_path(const std::filesystem::path& file) {
  const CsvTable table =
      read_csv(file, {"timestamp", "px", "py", "pz", "qw", "qx", "qy", "qz"}, CsvColumns::at_least);
  BodyPath path;
  path.timestamps_ns = csv_time_stamps(table, TimeUnit::nanoseconds);
  path.median_period_ns = median_period_ns(path.timestamps_ns);
  for (const auto& row : table.rows) path.T_world_body.push_back(pose_of(table, row));
  path.mean_gyro_bias_rad_s = mean_bias(table);
  return path;
}

std::optional<Pose> pose_at(const BodyPath& path, std::int64_t time_ns) {
  const auto& times = path.timestamps_ns;
  const auto after = std::lower_bound(times.begin(), times.end(), time_ns);
  if (after == times.end()) return std::nullopt;
  const auto b = after - times.begin();
  if (*after == time_ns) return path.T_world_body[b];
  if (b == 0) return std::nullopt;
  const auto a = b - 1;
  if ((times[b] - times[a]) / 3 > path.median_period_ns) return std::nullopt;
  const double s =
      static_cast<double>(time_ns - times[a]) / static_cast<double>(times[b] - times[a]);
  const Pose& T_a = path.T_world_body[a];
  const Pose& T_b = path.T_world_body[b];
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(T_a.R_wc).slerp(s, Eigen::Quaterniond(T_b.R_wc)).normalized();
  return Pose{q.toRotationMatrix(), (1 - s) * T_a.p_wc + s * T_b.p_wc};
}

}  // namespace gpo
