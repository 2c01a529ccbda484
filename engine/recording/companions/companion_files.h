// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/csv_table.h"
#include "engine/files/yaml_entry.h"
#include "engine/geometry/pose.h"
#include "engine/recording/recording.h"

namespace gpo {

struct Calibration {
  Camera camera;
  /// x_body = R_wc x_camera + p_wc; with Kalibr the body is the IMU.
  std::optional<Pose> T_body_camera;
  std::int64_t time_offset_ns = 0;           ///< gyroscope clock = camera clock + offset
  std::optional<double> rate_hz;             ///< frame rate
  CameraSource source = CameraSource::file;  ///< key `source`: self-calibrated or guess
  std::string name{};                        ///< file name
  std::string format{};                      ///< for people: "Kalibr"
};

/// Reads a lens file of one of the `lens_formats`, recognized by its keys. Throws InputError.
Calibration read_calibration(const fs::path& file);

/// Returns whether `read_calibration` accepts it as a camera's `rate_hz`.
bool is_image_rate(double rate_hz);

/// Name in EuRoC's files.
const char* distortion_name(Distortion distortion);

/// A calibration that was found by the usual names (camera.yaml, sensor.yaml, camchain-imucam.yaml,
/// calibration.xml, ...) or by its content, and files that look like one.
struct CalibrationSearch {
  std::optional<fs::path> file;
  bool by_content = false;  ///< the file has no usual name
  std::vector<FoundFile> unused;
};

/// Searches the folders in their order, and a COLMAP project's `sparse` in each.
CalibrationSearch search_calibration(const std::vector<fs::path>& folders);
/// Reports the calibration that is used and why others are not; the latter also as notes, unless
/// the user has named one camera.yaml or the like.
void report_calibration(Recording& recording,
                        const CalibrationSearch& search,
                        const Calibration& calibration);

/// Reads EuRoC's `T_BS`: a list of 16 numbers, 4 x 4 lists, or {rows, cols, data}. Throws
/// InputError unless it is a rigid transformation.
Pose rigid_motion(const YamlEntry& entry);

/// Reads a pose from three columns from `position` on and those of the quaternion, w x y z. Throws
/// InputError unless the quaternion's norm is 1 within 1 %.
Pose csv_pose(const CsvTable& table,
              const CsvRow& row,
              int position,
              const std::array<int, 4>& quaternion);

/// Accelerometer samples, with times on the gyroscope's clock.
struct AccelerationSamples {
  std::vector<std::int64_t> timestamps_ns;      ///< ascending
  std::vector<Eigen::Vector3d> specific_force;  ///< the gyroscope's axes [m/s^2]
};

/// Sets the accelerations at the gyroscope's samples by linear interpolation; nan in gaps of more
/// than 0.1 s. Leaves them empty if the accelerometer does not cover the gyroscope but for 0.1 s.
void add_accelerations(const AccelerationSamples& samples, Gyroscope& gyroscope);

/// Time stamps, rates [rad/s] (or [deg/s] by the header), accelerations. Throws InputError.
Gyroscope read_gyroscope(const fs::path& file, TimeUnit unit);

/// Axes, bias and noise of a gyroscope, as far as its sensor file has them.
struct ImuCalibration {
  std::optional<Eigen::Matrix3d> R_body_gyro;
  std::optional<Eigen::Vector3d> bias_rad_s;
  std::optional<double> bias_sigma_rad_s;
  std::optional<double> noise_density;  ///< [rad/s/sqrt(Hz)]
};

/// EuRoC's imu0/sensor.yaml, each entry optional, a noise density of 0 unknown. Throws InputError.
ImuCalibration read_imu_calibration(const fs::path& file);

/// Applies bias and noise. `source` of the bias is for people.
void set_bias(Gyroscope& gyroscope, const ImuCalibration& calibration, const char* source);

/// Poses over time of the frame that a truth file measures: the body, a camera or markers.
struct PosePath {
  std::vector<std::int64_t> timestamps_ns;  ///< strictly ascending
  std::vector<Pose> poses;                  ///< in the truth's world [m]
  std::int64_t longest_gap_ns = 0;          ///< largest gap to interpolate
  int left_out = 0;                         ///< rows that are not finite or repeat a time
  std::optional<Eigen::Vector3d> mean_gyro_bias_rad_s;  ///< if the file has the columns
};

/// Reads EuRoC's data.csv: time stamp, p, q_wxyz, optionally v, b_w, b_a. Throws InputError.
PosePath read_euroc_path(const fs::path& file);

/// Reads TUM's groundtruth.txt: time [s], p, q_xyzw, with blanks. Throws InputError.
PosePath read_tum_path(const fs::path& file);

/// Interpolates a pose (slerp and linear), also up to a tenth of a period, at most 1 ms, outside of
/// the path, whose times may be rounded; nullopt beyond and in long gaps.
std::optional<Pose> pose_at(const PosePath& path, std::int64_t time_ns);

/// Transform to the measured frame and clock offset.
struct TruthMounting {
  Pose T_measured_camera;           ///< hand-eye: x_measured = R x_camera + p
  std::int64_t time_offset_ns = 0;  ///< truth's clock = camera's clock + offset
  std::optional<bool> upright{};    ///< key `upright`, see GroundTruth
  std::string source{};             ///< key `source`: before a conversion; empty: none
};

/// Three median periods, the default of the longest gap to interpolate.
std::int64_t usual_longest_gap_ns(const std::vector<std::int64_t>& timestamps_ns);

/// Stands in a truth's source between its file and the source before a conversion.
inline constexpr std::string_view kOriginally = ", originally ";

/// Returns camera poses at the frames' times. `source` is for people.
GroundTruth camera_truth(const PosePath& path,
                         const TruthMounting& mounting,
                         std::string source,
                         const std::vector<std::int64_t>& frame_times_ns);

/// Reads the optional `time_offset_s`, `longest_gap_s`, `upright` and `source` of a truth's YAML.
/// Throws InputError.
void read_truth_clock(const fs::path& yaml, PosePath& path, TruthMounting& mounting);

/// Reads these and `T_truth_camera` of the optional groundtruth.yaml. Throws InputError.
void read_mounting_beside(const fs::path& folder, PosePath& path, TruthMounting& mounting);

/// Changes between successive poses that no camera makes: the rate or speed exceeds 0.5 rad/s or
/// 0.25 m/s plus five times the median of ten neighbors. Successive jumps count once.
std::vector<TruthJump> jumps_of(std::span<const std::int64_t> times_ns,
                                std::span<const std::optional<Pose>> poses);

void keep_between(std::int64_t first_ns, std::int64_t last_ns, std::vector<TruthJump>& jumps);

std::string text_of(const TruthJump& jump, std::int64_t origin_ns);

std::vector<std::string> notes_of(std::span<const TruthJump> jumps, std::int64_t origin_ns);

/// nullopt without groundtruth.txt. Throws InputError.
std::optional<GroundTruth> truth_beside(const fs::path& folder,
                                        const std::vector<std::int64_t>& frame_times_ns);

/// Reads board.yaml: {pattern: chessboard, columns: 9, rows: 6, square: 0.025}, {pattern: charuco,
/// squares: [8, 6], square: 0.03, marker: 0.022, dictionary: DICT_5X5_100}, Kalibr's aprilgrid, or
/// {pattern: apriltag, tagSize: 0.1, id: 0}. Throws InputError.
Board read_board(const fs::path& file);

/// Reads plane.yaml: {normal: [x, y, z], distance: d}. Throws InputError.
Plane read_plane(const fs::path& file);

/// Returns the text of board.yaml.
std::string board_yaml(const Board& board);

/// Returns names and texts of a recording's plane.yaml, board.yaml and tracks.csv.
std::map<std::string, std::string> sidecar_texts(const Recording& recording);

}  // namespace gpo
