// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/report/camera_path.h"

#include "engine/base/error.h"
#include "engine/recording/layouts/write_recording.h"

#include <cstdlib>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace gpo {
namespace {

constexpr int kDecimals = 9;

std::string seconds(std::int64_t ns) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return fmt::format(
      "{}{}.{:09d}", ns < 0 ? "-" : "", std::abs(ns / kSecond), std::abs(ns % kSecond));
}

Eigen::Quaterniond quaternion(const Pose& camera) {
  Eigen::Quaterniond q(camera.R_wc);
  if (q.w() < 0) q.coeffs() *= -1;
  return q.normalized();
}

std::string tum_line(std::int64_t ns, const Pose& camera) {
  const auto& p = camera.p_wc;
  const Eigen::Quaterniond q = quaternion(camera);
  return fmt::format("{} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n",
                     seconds(ns),
                     p.x(),
                     p.y(),
                     p.z(),
                     q.x(),
                     q.y(),
                     q.z(),
                     q.w());
}

std::string euroc_line(std::int64_t ns, const Pose& camera) {
  return std::to_string(ns) + cells(camera.p_wc, kDecimals) +
         quaternion_cells(quaternion(camera), kDecimals) + "\n";
}

std::string kitti_line(std::int64_t /*ns*/, const Pose& camera) {
  std::string line;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      line += fmt::format("{:.9e} ", camera.R_wc(row, column));
    line += fmt::format("{:.9e}{}", camera.p_wc[row], row < 2 ? " " : "\n");
  }
  return line;
}

}  // namespace

CameraPath estimated_path(const Inspection& inspection,
                          const std::optional<double>& meters_per_unit) {
  if (!inspection.initialization->ok) {
    throw InputError(fmt::format("{}: the initialization failed ({}), so there is no trajectory",
                                 inspection.recording->name,
                                 inspection.initialization->reason));
  }
  CameraPath path{inspection.window->timestamps_ns,
                  inspection.initialization->cameras,
                  "world = reference camera (x right, y down, z forward); unit = "};
  path.world += meters_per_unit ? "meter" : "distance of the plane";
  for (Pose& camera : path.cameras) camera.p_wc *= meters_per_unit.value_or(1);
  return path;
}

CameraPath true_path(const Inspection& inspection) {
  if (!inspection.truth) {
    throw InputError(inspection.recording->name + ": no ground truth to write a trajectory of");
  }
  CameraPath trajectory{{}, {}, "world = that of " + inspection.truth->source + "; unit = meter"};
  const auto& cameras = inspection.truth->cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    trajectory.complete = trajectory.complete && cameras[i];
    if (!cameras[i]) continue;
    trajectory.timestamps_ns.push_back(inspection.window->timestamps_ns[i]);
    trajectory.cameras.push_back(*cameras[i]);
  }
  return trajectory;
}

std::string to_text(const CameraPath& trajectory, TrajectoryFormat format) {
  struct Style {
    const char* header;  ///< empty for KITTI
    std::string (*line)(std::int64_t ns, const Pose& camera);
  };
  constexpr std::array<Style, 3> kStyles{
      {{"# timestamp[s] tx ty tz qx qy qz qw; camera to world; ", tum_line},
       {"#timestamp [ns],p_x,p_y,p_z,q_w,q_x,q_y,q_z; camera to world; ", euroc_line},
       {"", kitti_line}}};
  if (format == TrajectoryFormat::kitti && !trajectory.complete) {
    throw InputError(
        "trajectory: some frames have no pose, which KITTI's format cannot express. Choose tum or "
        "euroc");
  }
  const Style& style = kStyles[static_cast<std::size_t>(format)];
  std::string text = *style.header == '\0' ? "" : style.header + trajectory.world + "\n";
  for (std::size_t i = 0; i < trajectory.cameras.size(); ++i)
    text += style.line(trajectory.timestamps_ns[i], trajectory.cameras[i]);
  return text;
}

}  // namespace gpo
