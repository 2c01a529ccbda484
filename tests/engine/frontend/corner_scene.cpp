// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/frontend/corner_scene.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

constexpr double kTexels = 480;  // per unit of length; about a pixel at distance 1
constexpr int kTexture = 2048;

cv::Mat texture(std::uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat noise(kTexture, kTexture, CV_32F);
  random.fill(noise, cv::RNG::NORMAL, 0, 1);
  cv::Mat fine, coarse;
  cv::GaussianBlur(noise, fine, {}, 2);
  cv::GaussianBlur(noise, coarse, {}, 7);
  const cv::Mat sum = 240 * fine + 700 * coarse + 128;
  return cv::max(cv::min(sum, 245), 10);
}

Pose pose_at(int frame) {
  const double t = frame / (CornerScene::kFrames - 1.0);
  Pose pose;
  pose.R_wc =
      Eigen::AngleAxisd(0.12 * t, Eigen::Vector3d(0.3, -1, 0.4).normalized()).toRotationMatrix();
  pose.p_wc = Eigen::Vector3d(0.28 * t, -0.05 * std::sin(3 * t), 0.1 * t);
  return pose;
}

/// Returns the nearest surface and the depth along the ray.
template <typename Surfaces>
std::pair<int, double> hit(const Surfaces& surfaces,
                           const Eigen::Vector3d& from,
                           const Eigen::Vector3d& ray) {
  std::pair<int, double> nearest{0, 1e9};
  for (int k = 0; k < 2; ++k) {
    const double depth =
        (surfaces[k].distance - surfaces[k].normal.dot(from)) / surfaces[k].normal.dot(ray);
    if (depth > 0 && depth < nearest.second) nearest = {k, depth};
  }
  return nearest;
}

}  // namespace

CornerScene::CornerScene()
    : camera_{480,
              360,
              400,
              398,
              242,
              178,
              Distortion::radial_tangential,
              {0.08, -0.12, 5e-4, -8e-4}},
      rays_(camera_.height, camera_.width, CV_64FC2) {
  const Eigen::Vector3d floor = Eigen::Vector3d(0.1, 1, 0.25).normalized();
  const Eigen::Vector3d wall = Eigen::Vector3d(-0.2, -0.1, 1).normalized();
  const auto surface = [](const Eigen::Vector3d& normal, double distance, std::uint64_t seed) {
    const Eigen::Vector3d along = normal.unitOrthogonal();
    return Surface{normal, distance, along, normal.cross(along), texture(seed)};
  };
  surfaces_ = {surface(floor, 0.38, 1), surface(wall, 1.4, 2)};
  for (int v = 0; v < camera_.height; ++v) {
    for (int u = 0; u < camera_.width; ++u) {
      const Eigen::Vector3d ray = ray_at(Eigen::Vector2d(u, v));
      rays_.at<cv::Vec2d>(v, u) = {ray.x(), ray.y()};
    }
  }
}

cv::Mat CornerScene::gray(int frame) const {
  const Pose pose = pose_at(frame);
  std::array<cv::Mat, 2> maps;
  for (cv::Mat& map : maps) map = cv::Mat(rays_.size(), CV_32FC2, cv::Scalar(-1, -1));
  for (int v = 0; v < rays_.rows; ++v) {
    for (int u = 0; u < rays_.cols; ++u) {
      const auto& r = rays_.at<cv::Vec2d>(v, u);
      const Eigen::Vector3d ray = pose.R_wc * Eigen::Vector3d(r[0], r[1], 1);
      const auto [k, depth] = hit(surfaces_, pose.p_wc, ray);
      const Eigen::Vector3d point = pose.p_wc + depth * ray;
      maps[k].at<cv::Vec2f>(v, u) =
          cv::Vec2f(static_cast<float>(kTexture / 2.0 + kTexels * surfaces_[k].along.dot(point)),
                    static_cast<float>(kTexture / 2.0 + kTexels * surfaces_[k].across.dot(point)));
    }
  }
  cv::Mat sum = cv::Mat::zeros(rays_.size(), CV_32F);
  for (int k = 0; k < 2; ++k) {
    cv::Mat part;
    cv::remap(surfaces_[k].texture, part, maps[k], {}, cv::INTER_CUBIC, cv::BORDER_CONSTANT);
    sum += part;
  }
  cv::RNG random(1000 + frame);
  cv::Mat noise(sum.size(), CV_32F);
  random.fill(noise, cv::RNG::NORMAL, 0, 1);
  cv::Mat gray;
  cv::Mat(sum + noise).convertTo(gray, CV_8U);
  return gray;
}

Eigen::Vector3d CornerScene::ray_at(const Eigen::Vector2d& raw_px) const {
  return intrinsic_matrix(camera_).inverse() * undistort(camera_, raw_px).homogeneous();
}

int CornerScene::plane_at(const Eigen::Vector2d& raw_px) const {
  return hit(surfaces_, Eigen::Vector3d::Zero(), ray_at(raw_px)).first;
}

Eigen::Vector2d CornerScene::moved(const Eigen::Vector2d& raw_px, int frame) const {
  const Eigen::Vector3d ray = ray_at(raw_px);
  const double depth = hit(surfaces_, Eigen::Vector3d::Zero(), ray).second;
  return project(camera_, to_camera(pose_at(frame), depth * ray));
}

}  // namespace gpo::test
