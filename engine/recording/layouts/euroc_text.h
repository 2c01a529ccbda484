// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/window/gyroscope.h"

#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

// How EuRoC's files have numbers: what is written by one part of the program is read by another.

/// The heads of EuRoC's tables, each a line.
inline constexpr const char* kImageListHead = "#timestamp [ns],filename\n";
inline constexpr const char* kGyroscopeHead =
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1]";
inline constexpr const char* kAccelerometerHead =
    ",a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]";
inline constexpr const char* kPoseHead =
    ",p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []";

/// ",x,y,z": cells of a table, with so many decimals, or the shortest text that reads back as the
/// same number.
std::string cells(const Eigen::Ref<const Eigen::VectorXd>& values,
                  std::optional<int> decimals = {});
/// ",w,x,y,z", as EuRoC stores a rotation.
std::string quaternion_cells(const Eigen::Quaterniond& q, std::optional<int> decimals = {});

/// Rotations of consecutive poses without a jump between q and -q, for who interpolates.
class SteadyQuaternions {
 public:
  Eigen::Quaterniond operator()(const Eigen::Matrix3d& R);

 private:
  Eigen::Quaterniond previous_ = Eigen::Quaterniond::Identity();
};

/// "[1, 2.5]"; reads back as the same numbers.
std::string yaml_list(std::span<const double> values);
std::string yaml_list(const Eigen::Vector3d& values);
/// `T_BS` as EuRoC's sensor.yaml has it; reads back as the same numbers.
std::string transformation_yaml(const Pose& pose);
/// `gyroscope_bias`, unless it is zero, `gyroscope_bias_sigma` and `gyroscope_noise_density`.
std::string bias_yaml(const Gyroscope& gyroscope);
/// Beside poses that are not to be interpolated.
inline constexpr const char* kNoInterpolation =
    "longest_gap_s: 0  # over which poses are interpolated: frames without one stay without\n";
/// `resolution` to `distortion_coefficients`.
std::string lens_yaml(const Camera& camera);

}  // namespace gpo
