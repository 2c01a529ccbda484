// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/recording/recording.h"

#include <Eigen/Geometry>

namespace gpo {

enum class RecordingFormat { euroc, rosbag, mcap };
template <>
struct ChoiceKeys<RecordingFormat> : NamedKeys<"format", "euroc", "rosbag", "mcap"> {};

using WriteProgress = std::function<void(int done, int of)>;

/// Writes a recording that opens as the same recording: as an EuRoC folder, or as a bag with
/// sidecar files beside it. The folder has images as PNG (lossless, but 8 bits), calibration,
/// gyroscope, tracks, board, plane, and `truth` as the body's poses at the frames' times, without
/// interpolation. The bag contains the images (8 bits, uncompressed), /camera_info, /imu by the
/// camera's clock, /ground_truth (of the camera) and /tf_static. On failure no partial output
/// remains. Throws InputError if an image cannot be decoded, the folder is not empty, or the disk
/// is full; for a bag that exists or has the wrong extension, foreign sidecar files beside it, a
/// recording without images, and times before 1970 in a ROS 1 bag.
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
/// ",w,x,y,z", EuRoC's order.
std::string quaternion_cells(const Eigen::Quaterniond& q, std::optional<int> decimals = {});

/// Converts rotations without sign changes between q and -q, which would break interpolation.
class SteadyQuaternions {
 public:
  Eigen::Quaterniond operator()(const Eigen::Matrix3d& R);

 private:
  Eigen::Quaterniond previous_ = Eigen::Quaterniond::Identity();
};

/// The keys of a camera's readout; empty if unknown.
std::string readout_yaml(const Camera& camera);
/// All digits that a number needs, or at most `digits`.
std::string yaml_list(std::span<const double> values, std::optional<int> digits = {});
std::string yaml_list(const Eigen::Vector3d& values);
/// `T_BS` of EuRoC's sensor.yaml; reads back exactly.
std::string transformation_yaml(const Pose& pose);
/// `gyroscope_bias`, unless it is zero, `gyroscope_bias_sigma` and `gyroscope_noise_density`.
std::string bias_yaml(const Gyroscope& gyroscope);
/// Key of a truth's YAML file that disables interpolation.
inline constexpr const char* kNoInterpolation =
    "longest_gap_s: 0  # no interpolation: frames without a pose stay without\n";
/// The keys `intrinsics_sigma`, `distortion_coefficients_sigma` and `intrinsics_covariance`, as far
/// as they are known.
std::string lens_uncertainty_yaml(const Camera& camera, std::optional<int> sigma_digits = {});
/// The keys `resolution` to `distortion_coefficients`, with the uncertainty and the readout.
std::string lens_yaml(const Camera& camera);

}  // namespace gpo
