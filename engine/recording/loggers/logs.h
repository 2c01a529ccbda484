// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/recording/bags/containers/bag.h"
#include "engine/window/gyroscope.h"

#include <initializer_list>

namespace gpo {

/// A camera's or an app's own log of a video. The camera's axes are those of the image as stored in
/// the file, before a player rotates it.
struct Log {
  fs::path file;                                ///< for messages
  fs::path camera_file;                         ///< source of `camera`
  std::optional<Camera> camera;                 ///< size 0 if unknown
  std::optional<Pose> T_body_camera;            ///< body: the gyroscope's axes; nullopt if unknown
  std::optional<Gyroscope> gyroscope;           ///< without time offset and rotation to the camera
  fs::path frames_file;                         ///< source of times and poses
  std::vector<std::int64_t> frame_times_ns;     ///< one for each image, ascending; empty if unknown
  std::vector<std::optional<Pose>> true_poses;  ///< camera poses of the images; empty if unknown
  fs::path truth_file;                          ///< source of the poses; empty: `frames_file`
  std::optional<double> readout_s;              ///< see `Readout`, of the stored images
  std::optional<ReadoutDirection> readout_direction;  ///< in the stored images; nullopt: down
  std::vector<std::string> notes;                     ///< each shown once to the user
};

/// By Stray Scanner, Spectacular AI, Gyroflow, Sensor Logger or ios_logger; nullopt if there is
/// none.
std::optional<Log> log_beside(const fs::path& folder, const std::optional<fs::path>& video);

/// GPMF or Camera Motion Metadata; the first frame is at `first_frame_s` in the container.
std::optional<Log> log_inside(const fs::path& video, double first_frame_s);

// Readers of the files beside a video. All throw InputError.

/// Lines of KEY,VALUE, then `t,gx,gy,gz,...` in units of `tscale` [s] and `gscale` [rad/s].
Log read_gcsv(const fs::path& file);

/// Sensor Logger: `seconds_elapsed`, assumed to be the video's time, and rates [rad/s].
Log read_sensor_logger(const fs::path& file);

/// Reads `imu.csv`, `odometry.csv` (ARKit's camera poses) and `camera_matrix.csv` of Stray Scanner.
Log read_stray_scanner(const fs::path& folder);

Log read_spectacular(const fs::path& file);

/// Reads `Frames.txt`, `Gyro.txt`, `Accel.txt` and `ARposes.txt` of ios_logger, or ADVIO's
/// `frames.csv`, `gyro.csv`, `accelerometer.csv` and poses.
Log read_ios_logger(const fs::path& folder);

/// A piece of a telemetry track and its time in the container.
struct TelemetryPacket {
  double begin_s = 0;
  double end_s = 0;
  std::string bytes;
};

/// Telemetry that a camera stores beside the images in an MP4 or MOV.
struct TelemetryTrack {
  std::string format;  ///< "gpmd" (GoPro) or "camm" (Camera Motion Metadata)
  std::vector<TelemetryPacket> packets;
};

/// Reads the first such track; nullopt if there is none. Throws InputError if it is too large.
std::optional<TelemetryTrack> read_telemetry_track(const fs::path& video);

std::string gopro_settings(const fs::path& video);

/// A sample of a Camera Motion Metadata (CAMM) track; most have one value.
struct CammSample {
  std::optional<Eigen::Vector3d> rates_rad_s;         ///< the gyroscope's axes
  std::optional<Eigen::Vector3d> accelerations_m_s2;  ///< the same axes
  std::optional<double> readout_s;                    ///< from the first row to the last
};

/// Ignores unknown kinds of samples. Throws InputError with `source` for truncated samples and
/// rates that are not finite.
CammSample parse_camm(std::string_view bytes, const std::string& source);

/// Content of a box of an MP4 or MOV [bytes of the file].
struct MovieBox {
  std::uint64_t begin = 0, end = 0;
};

/// Finds the first box of a kind inside another one, for boxes that FFmpeg ignores.
std::optional<MovieBox> box_in(const FileBytes& movie, MovieBox outer, std::string_view kind);
/// Finds a nested box by the kinds of all boxes from the outermost on. Other files have none.
std::optional<MovieBox> box_at(const FileBytes& movie,
                               std::initializer_list<std::string_view> kinds);
/// Empty if the box is larger than 1 MiB.
std::string bytes_of(const FileBytes& movie, MovieBox box);

/// Finds a value by its key in the content of a box `meta` (QuickTime File Format, "Metadata");
/// returns numbers as text. nullopt if it is missing or unreadable.
std::optional<std::string> metadata_value(std::string_view meta, std::string_view key);

/// Number and time of the first sample of a payload's stream.
struct GpmfStamp {
  std::int64_t first_sample = 0;    ///< since the beginning of the video
  std::optional<double> camera_us;  ///< STMP or TICK, by the camera's clock
};

/// Samples of a sensor in one payload of a GoPro's telemetry.
struct GpmfSamples {
  std::vector<Eigen::Vector3d> values;  ///< GoPro's axes: x left, y back, z up
  GpmfStamp first;                      ///< stamp of the first value
};

/// Sensors and shutter in one payload of a GoPro's telemetry (GPMF).
struct GpmfPayload {
  GpmfSamples rates_rad_s;             ///< GYRO
  GpmfSamples accelerations_m_s2;      ///< ACCL, specific force
  std::optional<GpmfStamp> exposures;  ///< stamp of the first exposure time (SHUT)
  std::optional<double> readout_s;     ///< SROT
};

/// Running counts of samples and exposures, for cameras that do not store them.
struct GpmfCount {
  std::int64_t rates = 0;
  std::int64_t accelerations = 0;
  std::int64_t exposures = 0;
};

/// Reads the first device with a gyroscope in a payload. Scales its samples (SCAL) and converts
/// their axes according to the file (MTRX with ORIO, or ORIN) or the camera's model. `counted` has
/// the counts of the previous payloads and is updated. Throws InputError with `source`.
GpmfPayload parse_gpmf(std::string_view bytes, const std::string& source, GpmfCount& counted);

/// Returns the times of all payloads' samples of a sensor since the first frame [ns]. They are on
/// the line fitted to the camera's stamps, the first exposure being the first frame's. Without
/// stamps they are on the line through the payloads' begins in the container, `payload_times_s`,
/// with the end of the last as an additional entry and the first frame at 0. Empty if the times are
/// unknown.
std::vector<std::int64_t> gpmf_times_ns(
    const std::vector<GpmfPayload>& payloads,
    const std::vector<double>& payload_times_s,
    GpmfSamples GpmfPayload::*sensor = &GpmfPayload::rates_rad_s);

/// Returns how a GoPro's settings state that the images are stabilized, for people; empty if not.
std::string stabilization_of_gpmf(std::string_view settings);

/// A GPMF value and its key; numbers are big-endian.
struct GpmfItem {
  std::string_view key;  ///< four letters
  char type = 0;         ///< a letter; 0: nested items
  int size = 0;          ///< sample size [bytes]
  int count = 0;         ///< number of samples
  std::string_view data = {};
  const std::string* source = nullptr;  ///< name of the file, for messages
};

class GpmfItems {
 public:
  GpmfItems(std::string_view bytes, const std::string& source) : rest_(bytes), source_(source) {}

  /// Returns the next item; nullopt at the end or in the padding. Throws InputError with `source`.
  std::optional<GpmfItem> next();

 private:
  std::string_view rest_;
  const std::string& source_;
};

/// Returns all numbers of an item, finite. Throws InputError.
std::vector<double> gpmf_numbers(const GpmfItem& item);

/// Returns the text without the zeros at its end.
std::string gpmf_text(const GpmfItem& item);

/// Returns the rotation for three named axes, upper case for an axis and lower case for its
/// opposite: "YxZ" has the rows e_y, -e_x, e_z. nullopt if the text is invalid or left-handed.
std::optional<Eigen::Matrix3d> signed_axes(std::string_view text);

}  // namespace gpo
