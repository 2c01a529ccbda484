// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/made_inspection.h"

#include "engine/truth/truth.h"
#include "engine/window/tracks.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

namespace gpo {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr int kFrames = 40, kStart = 5, kLength = 30, kTracks = 150;
constexpr double kTilt_deg = 35;  // between the optical axis and the floor's normal
constexpr double kDistance_m = 1.6;

Camera made_camera(bool distorted) {
  Camera camera{640, 480, 500, 505, 322.3, 236.8, Distortion::none, {}};
  if (!distorted) return camera;
  camera.distortion = Distortion::radial_tangential;
  camera.coefficients = {-0.28, 0.07, 0.0008, -0.0004};
  return camera;
}

/// In the reference camera's frame, in plane distances.
Pose made_pose(int frame) {
  const double s = static_cast<double>(frame - kStart) / kLength;
  Pose pose;
  pose.p_wc = Vector3d(0.45 * s, -0.1 * s + 0.06 * std::sin(5 * s), 0.12 * s * s);
  if (frame == kStart) pose.p_wc.setZero();
  pose.R_wc = so3_exp(Vector3d(0.03 * std::sin(4 * s), -0.25 * s, 0.05 * s));
  return pose;
}

Plane made_plane() {
  return {-Vector3d(0, std::sin(radians(kTilt_deg)), std::cos(radians(kTilt_deg))), 1};
}

Vector3d on_floor(const Camera& camera, const Pose& pose, const Vector2d& raw_px) {
  const Vector2d ideal = undistort(camera, raw_px);
  const Vector3d ray((ideal.x() - camera.cx) / camera.fx, (ideal.y() - camera.cy) / camera.fy, 1);
  return intersect(made_plane(), pose, ray).value_or(Vector3d(1e3, 1e3, 1e3));
}

cv::Mat made_image(const Camera& camera, int frame) {
  cv::Mat image(camera.height, camera.width, CV_8UC3);
  const Vector3d x = Vector3d::UnitX(), y = made_plane().normal.cross(x);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Vector3d point = on_floor(camera, made_pose(frame), Vector2d(u, v));
      const double a = 6 * point.dot(x), b = 6 * point.dot(y);
      const bool dark = (static_cast<long>(std::floor(a)) + static_cast<long>(std::floor(b))) & 1;
      const double grain = 14 * std::sin(11 * a) * std::sin(13 * b);
      const auto value = static_cast<uchar>((dark ? 92 : 158) + grain);
      image.at<cv::Vec3b>(v, u) = cv::Vec3b(value - 12, value, value + 8);
    }
  return image;
}

std::shared_ptr<Recording> made_recording(const MadeOptions& options) {
  auto recording = std::make_shared<Recording>();
  recording->name = "made";
  recording->camera = made_camera(options.distorted);
  for (int i = 0; i < kFrames; ++i) recording->timestamps_ns.push_back(i * 33'333'333L);
  if (options.images)
    recording->images = std::make_shared<FrameCache>(
        kFrames, [camera = recording->camera](int i) { return made_image(camera, i); });
  return recording;
}

/// Adds tracks with 0.4 px noise. Outliers lie above the floor, some tracks end early.
void add_tracks(Inspection& inspection) {
  const Camera& camera = inspection.recording->camera;
  auto tracks = std::make_shared<Tracks>();
  auto window = std::make_shared<Window>();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> along_x(20, 620), along_y(20, 460), unit(0, 1);
  std::normal_distribution<double> noise(0, 0.4);
  tracks->start = window->start = kStart;
  window->K = intrinsic_matrix(camera);
  tracks->raw_px.assign(kLength, Eigen::Matrix2Xd::Constant(2, kTracks, std::nan("")));
  window->points_px = tracks->raw_px;
  window->inlier.assign(kLength, std::vector<bool>(kTracks, false));
  window->H_i1.assign(kLength, Eigen::Matrix3d::Identity());
  for (int track = 0; track < kTracks; ++track) {
    tracks->ids.push_back(track);
    // Separate statements: the order of evaluation of arguments is unspecified.
    const double y = along_y(random), x = along_x(random);
    const Vector3d floor = on_floor(camera, Pose(), Vector2d(x, y));
    const bool outlier = track % 10 == 0;
    const double height = outlier ? 0.1 + 0.2 * unit(random) : 0;
    const int end = track % 7 == 3 ? 20 : kLength;
    for (int i = 0; i < end; ++i) {
      const Vector3d point = floor * (1 - height);
      const double noise_y = noise(random), noise_x = noise(random);
      const Vector2d pixel =
          project(camera, to_camera(made_pose(kStart + i), point)) + Vector2d(noise_x, noise_y);
      if (pixel.minCoeff() < 0 || pixel.x() > 639 || pixel.y() > 479) break;
      tracks->raw_px[i].col(track) = pixel;
      window->points_px[i].col(track) = undistort(camera, pixel);
      window->inlier[i][track] = !outlier;
    }
  }
  for (int i = 0; i < kLength; ++i) {
    window->timestamps_ns.push_back(inspection.recording->timestamps_ns[kStart + i]);
    window->R_wc.push_back(made_pose(kStart + i).R_wc);
  }
  inspection.tracks = tracks;
  inspection.window = window;
}

void add_estimate(Inspection& inspection, double error_deg) {
  auto estimate = std::make_shared<Initialization>();
  estimate->ok = true;
  const Eigen::Matrix3d tilt = so3_exp(radians(error_deg) * Vector3d(0.8, 0.6, 0));
  estimate->plane = {tilt * made_plane().normal, 1};
  for (int i = 0; i < kLength; ++i) {
    Pose pose = made_pose(kStart + i);
    pose.p_wc = tilt * pose.p_wc;
    estimate->cameras.push_back(pose);
  }
  const Camera& camera = inspection.recording->camera;
  for (int track = 0; track < kTracks; ++track)
    if (inspection.window->inlier[1][track])
      estimate->points.push_back(
          {track, tilt * on_floor(camera, Pose(), inspection.tracks->raw_px[0].col(track))});
  inspection.initialization = estimate;
  inspection.cube = anchor_on_plane(estimate->plane, Pose(), Vector3d(0.02, 0.12, 1));
}

/// Adds ground truth in a rotated and translated frame, in meters.
void add_truth(Inspection& inspection) {
  const Similarity T{kDistance_m, so3_exp(Vector3d(1.2, -0.4, 0.7)), Vector3d(3, -2, 1)};
  auto truth = std::make_shared<WindowTruth>();
  truth->source = "made";
  for (int i = 0; i < kLength; ++i) {
    const Pose pose = made_pose(kStart + i);
    truth->cameras.push_back(Pose{T.R_ab * pose.R_wc, T * pose.p_wc});
  }
  const Vector3d normal = T.R_ab * made_plane().normal;
  truth->plane = Plane{normal, -normal.dot(T * Vector3d(-made_plane().normal))};
  inspection.truth = truth;
  if (!inspection.initialization->ok) return;
  auto& evaluation = inspection.evaluation.emplace();
  evaluation.T_true_est = T;
  evaluation.scale = T.scale;
  inspection.true_cube =
      anchor_on_plane(*truth->plane, *truth->cameras.front(), Vector3d(0.02, 0.12, 1));
}

/// Returns an uncertainty mostly about the direction of motion, of centers along their baseline.
Uncertainty made_uncertainty(const Initialization& estimate, double normal_sigma_deg) {
  Uncertainty uncertainty;
  uncertainty.own = true;
  uncertainty.sigma_px = 0.4;
  uncertainty.rotations = RotationModel::bias;
  const double sigma = radians(normal_sigma_deg);
  const Vector3d x = Vector3d::UnitX(), y = estimate.plane.normal.cross(x).normalized();
  const Vector3d z = y.cross(estimate.plane.normal);
  uncertainty.normal_covariance =
      sigma * sigma * (0.8 * y * y.transpose() + 0.2 * z * z.transpose());
  uncertainty.normal_sigma_deg = normal_sigma_deg;
  for (const Pose& pose : estimate.cameras) {
    const Vector3d p = pose.p_wc;
    uncertainty.center_covariances.push_back(
        sigma * sigma * (p * p.transpose() + 0.1 * p.squaredNorm() * Eigen::Matrix3d::Identity()));
    uncertainty.distance_ratio_sigmas.push_back(0.5 * sigma * p.norm());
  }
  uncertainty.bias_covariance = 0.25e-6 * Eigen::Matrix3d::Identity();
  uncertainty.bound_known_rotations_deg = 0.6 * normal_sigma_deg;
  uncertainty.bound_unknown_bias_deg = 0.9 * normal_sigma_deg;
  return uncertainty;
}

/// Returns the verdict on a window of this length: degenerate, then weak, then ready.
Verdict made_verdict(int frames, double normal_sigma_deg) {
  Verdict verdict;
  verdict.normal_sigma_deg = normal_sigma_deg * kLength / frames;
  verdict.rotation_rms_px = 0.4 + 0.3 * (frames - 2);
  verdict.noise_px = 0.4;
  verdict.largest_translation = 0.45 * frames / kLength;
  verdict.readiness = frames < 6    ? Readiness::degenerate
                      : frames < 15 ? Readiness::weak
                                    : Readiness::ready;
  verdict.reason = frames < 6    ? "hardly any parallax: rotation alone explains the tracks"
                   : frames < 15 ? "the normal is uncertain: use a longer window"
                                 : "the normal uncertainty is low enough";
  return verdict;
}

void add_uncertainty(Inspection& inspection, double normal_sigma_deg) {
  auto result = std::make_shared<Initialization>(*inspection.initialization);
  for (int frames = 2; frames <= kLength; ++frames)
    inspection.growth.push_back(made_verdict(frames, normal_sigma_deg));
  result->verdict = inspection.growth.back();
  if (result->ok) {
    result->uncertainty = made_uncertainty(*result, normal_sigma_deg);
    result->bias_rad_s = Vector3d(0.0123, -0.0045, 0.0008);
  } else {
    result->verdict = inspection.growth.front();
    result->verdict->reason = result->reason;
  }
  inspection.growth.back() = *result->verdict;
  inspection.initialization = result;
}

}  // namespace

Inspection made_inspection(const MadeOptions& options) {
  Inspection inspection;
  inspection.recording = made_recording(options);
  inspection.settings.start = kStart;
  inspection.settings.frames = kLength;
  add_tracks(inspection);
  if (options.ok)
    add_estimate(inspection, options.estimate_error);
  else
    inspection.initialization = std::make_shared<Initialization>(failed(
        "no parallax: rotation alone explains the tracks to 0.48 px, where noise is 0.40 px"));
  if (options.refused)
    inspection.initialization = std::make_shared<Initialization>(refused(
        "wrong minimum: the plane's horizon runs through the points", *inspection.initialization));
  if (options.normal_sigma_deg > 0) add_uncertainty(inspection, options.normal_sigma_deg);
  if (options.truth) add_truth(inspection);
  return inspection;
}

}  // namespace gpo
