// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/files/output_file.h"
#include "engine/recording/companions/calibration_file.h"
#include "engine/recording/companions/sidecar_files.h"
#include "engine/recording/layouts/euroc_text.h"
#include "engine/recording/layouts/write_recording.h"
#include "engine/recording/pictures/picture_file.h"
#include "engine/window/timestamps.h"
#include "engine/window/tracks.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;

std::string camera_yaml(const Recording& recording) {
  std::string text = "sensor_type: camera\n" +
                     transformation_yaml(recording.T_body_camera.value_or(Pose{})) +
                     lens_yaml(recording.camera);
  if (const double rate = rate_hz(recording.timestamps_ns); is_picture_rate(rate))
    text += fmt::format("rate_hz: {:.6g}\n", rate);
  if (recording.gyroscope && recording.gyroscope->time_offset_ns != 0)
    text += fmt::format("timeshift_cam_imu: {}  # [s] gyroscope's clock - camera's clock\n",
                        static_cast<double>(recording.gyroscope->time_offset_ns) * 1e-9);
  return text;
}

std::string imu_yaml(const Gyroscope& gyroscope, const Pose& T_body_camera) {
  const Pose T_body_gyro{T_body_camera.R_wc * gyroscope.R_gyro_camera.transpose(),
                         Eigen::Vector3d::Zero()};
  const std::string text = fmt::format("sensor_type: imu\n{}rate_hz: {}\n",
                                       transformation_yaml(T_body_gyro),
                                       rate_hz(gyroscope.timestamps_ns));
  return text + bias_yaml(gyroscope);
}

std::string imu_csv(const Gyroscope& gyroscope) {
  const bool accelerations = !gyroscope.accelerations_m_s2.empty();
  std::string text = std::string(kGyroscopeHead) + (accelerations ? kAccelerometerHead : "") + "\n";
  for (std::size_t i = 0; i < gyroscope.timestamps_ns.size(); ++i) {
    text += std::to_string(gyroscope.timestamps_ns[i]) + cells(gyroscope.rates_rad_s[i]);
    if (accelerations) text += cells(gyroscope.accelerations_m_s2[i]);
    text += '\n';
  }
  return text;
}

std::string truth_csv(const Recording& recording, const GroundTruth& truth) {
  std::string text = std::string("#timestamp [ns]") + kPoseHead + "\n";
  const Pose T_camera_body = inverse(recording.T_body_camera.value_or(Pose{}));
  SteadyQuaternions steady;
  for (std::size_t i = 0; i < truth.poses.size(); ++i) {
    if (!truth.poses[i]) continue;
    const Pose body = *truth.poses[i] * T_camera_body;
    text += std::to_string(recording.timestamps_ns[i]) + cells(body.p_wc) +
            quaternion_cells(steady(body.R_wc)) + "\n";
  }
  return text;
}

/// The pictures that the recording has, and the list of all frames.
void write_pictures(const Recording& recording,
                    const fs::path& cam,
                    const std::function<void(int done, int of)>& progress) {
  make_folder(cam / "data");
  std::string list = kPictureListHead;
  for (int i = 0; i < recording.frame_count(); ++i) {
    const std::string name = fmt::format("{:019d}.png", recording.timestamps_ns[i]);
    list += fmt::format("{},{}\n", recording.timestamps_ns[i], name);
    if (!recording.pictures) continue;
    write_picture(cam / "data" / name, gray_if_gray(recording.pictures->bgr(i)));
    if (progress) progress(i + 1, recording.frame_count());
  }
  write_file(cam / "data.csv", list);
}

void write_truth(const Recording& recording, const GroundTruth& truth, const fs::path& mav) {
  const fs::path folder = mav / "state_groundtruth_estimate0";
  make_folder(folder);
  write_file(folder / "data.csv", truth_csv(recording, truth));
  write_file(folder / "sensor.yaml",
             "sensor_type: visual-inertial\n" + transformation_yaml(Pose{}) + kNoInterpolation);
}

}  // namespace

void write_euroc(const Recording& recording,
                 const std::optional<GroundTruth>& truth,
                 const fs::path& folder,
                 const std::function<void(int done, int of)>& progress) {
  UnfinishedFolder unfinished(folder);
  const fs::path mav = unfinished.path() / "mav0";
  make_folder(mav / "cam0");
  write_file(mav / "cam0" / "sensor.yaml", camera_yaml(recording));
  if (const auto& gyroscope = recording.gyroscope) {
    make_folder(mav / "imu0");
    write_file(mav / "imu0" / "sensor.yaml",
               imu_yaml(*gyroscope, recording.T_body_camera.value_or(Pose{})));
    write_file(mav / "imu0" / "data.csv", imu_csv(*gyroscope));
  }
  if (truth) write_truth(recording, *truth, mav);
  for (const auto& [name, text] : sidecar_texts(recording))
    write_file(unfinished.path() / name, text);
  write_pictures(recording, mav / "cam0", progress);
  unfinished.finish();
}

}  // namespace gpo
