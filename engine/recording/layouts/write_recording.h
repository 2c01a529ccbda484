// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/recording/recording.h"

#include <Eigen/Geometry>

namespace gpo {

enum class RecordingFormat { euroc, rosbag, mcap };
template <>
struct ChoiceKeys<RecordingFormat> {
  static constexpr const char* name = "format";
  static constexpr std::array<const char*, 3> keys = {"euroc", "rosbag", "mcap"};
};

using WriteProgress = std::function<void(int done, int of)>;

/// Writes a recording that opens as the same one: EuRoC (8-bit PNG, `truth` as body poses at the
/// frames' times) or a bag (8-bit images, /camera_info, /imu by the camera's clock, /ground_truth,
/// /tf_static, sidecar files). Leaves no partial output. Throws InputError for existing
/// outputs, foreign sidecar files, missing images, times before 1970 in ROS 1, and a full disk.
void write_recording(const Recording& recording,
                     const std::optional<GroundTruth>& truth,
                     RecordingFormat format,
                     const fs::path& output,
                     const WriteProgress& progress = {});

inline constexpr const char* kImageListHead = "#timestamp [ns],filename\n";
inline constexpr const char* kGyroscopeHead =
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1]";
inline constexpr const char* kAccelerometerHead =
    ",a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]";
inline constexpr const char* kPoseHead =
    ",p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []";

/// ",x,y,z": cells with `decimals` digits, or the shortest text that reads back exactly.
std::string cells(const Eigen::Ref<const Eigen::VectorXd>& values,
                  std::optional<int> decimals = {});
std::string quaternion_cells(const Eigen::Quaterniond& q, std::optional<int> decimals = {});

/// Converts rotations without sign changes between q and -q, which would break interpolation.
class SteadyQuaternions {
 public:
  Eigen::Quaterniond operator()(const Eigen::Matrix3d& R);

 private:
  Eigen::Quaterniond previous_ = Eigen::Quaterniond::Identity();
};

std::string readout_yaml(const Camera& camera);
/// All digits that a number needs, or at most `digits`.
std::string yaml_list(std::span<const double> values, std::optional<int> digits = {});
std::string yaml_list(const Eigen::Vector3d& values);
std::string transformation_yaml(const Pose& pose);
std::string bias_yaml(const Gyroscope& gyroscope);
inline constexpr const char* kNoInterpolation =
    "longest_gap_s: 0  # no interpolation: frames without a pose stay without\n";
/// `intrinsics_sigma`, `distortion_coefficients_sigma` and `intrinsics_covariance`, if known.
std::string lens_uncertainty_yaml(const Camera& camera, std::optional<int> sigma_digits = {});
std::string lens_yaml(const Camera& camera);

}  // namespace gpo
