// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/anchors.h"

#include "engine/geometry/homography.h"
#include "engine/window/tracks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix2Xd;
using Eigen::Matrix2Xf;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector2f;

constexpr int kMostSteps = 20;          // of Gauss-Newton
constexpr double kConverged_px = 1e-3;  // length of its last step

/// CV_32FC1.
cv::Mat smooth(const cv::Mat& gray, const AnchorOptions& options) {
  const int size = 2 * cvCeil(4 * options.blur_px) - 1;
  const cv::Mat kernel = cv::getGaussianKernel(size, options.blur_px, CV_32F);
  cv::Mat smoothed;
  cv::sepFilter2D(gray, smoothed, CV_32F, kernel, kernel);
  return smoothed;
}

/// Bilinear; NaN outside of the picture. Our own, because OpenCV's `remap` rounds places to 1/32
/// px.
float sample(const cv::Mat& picture, const Vector2f& px) {
  const bool inside = px.x() >= 0 && px.y() >= 0 && px.x() < static_cast<float>(picture.cols - 1) &&
                      px.y() < static_cast<float>(picture.rows - 1);
  if (!inside) return std::numeric_limits<float>::quiet_NaN();
  const int u = static_cast<int>(px.x());
  const int v = static_cast<int>(px.y());
  const float a = px.x() - static_cast<float>(u);
  const float b = px.y() - static_cast<float>(v);
  const auto* upper = picture.ptr<float>(v) + u;
  const auto* lower = picture.ptr<float>(v + 1) + u;
  return (1 - b) * ((1 - a) * upper[0] + a * upper[1]) + b * ((1 - a) * lower[0] + a * lower[1]);
}

/// A look against a picture: what one step of Gauss-Newton needs.
struct Comparison {
  Vector2d step_px;    ///< by which the look should move, in the reference picture
  double correlation;  ///< zero-mean normalized
};

/// Least squares I(w(x)) = gain (T(x) - grad T(x) step) + offset over step, gain and offset: linear
/// in gain * step. The slopes are the look's own, so that they stay the same (inverse
/// compositional: Baker & Matthews 2004). `places_px` are w of the look's pixels, 2 x n; nothing
/// where less than half of them are in the picture or the look is darker where it should be
/// brighter.
std::optional<Comparison> compare(const cv::Mat& picture,
                                  const Look& look,
                                  const Matrix2Xf& places_px,
                                  const Vector2f& shift_px) {
  Eigen::VectorXf brightness(places_px.cols());
  Eigen::VectorXf inside = Eigen::VectorXf::Ones(places_px.cols());
  for (Eigen::Index k = 0; k < brightness.size(); ++k) {
    brightness[k] = sample(picture, places_px.col(k) + shift_px);
    if (std::isnan(brightness[k])) brightness[k] = inside[k] = 0;
  }
  const double n = inside.sum();
  if (2 * n < static_cast<double>(inside.size())) return std::nullopt;
  const bool whole = inside.minCoeff() > 0;
  const Eigen::Matrix4d A =
      (whole ? look.normal
             : Eigen::Matrix4f(look.model.transpose() * inside.asDiagonal() * look.model))
          .cast<double>();
  const Eigen::Vector4d b = (look.model.transpose() * brightness).cast<double>();
  const Eigen::Vector4d solution = A.ldlt().solve(b);
  const double gain = solution(2);
  if (!(gain > 0)) return std::nullopt;
  const double covariance = b(2) - A(2, 3) * b(3) / n;
  const double variances =
      (brightness.squaredNorm() - b(3) * b(3) / n) * (A(2, 2) - A(2, 3) * A(2, 3) / n);
  return Comparison{-solution.head<2>() / gain,
                    variances > 0 ? covariance / std::sqrt(variances) : 0};
}

/// Where H and the lens take an undistorted pixel of the reference picture: a raw pixel.
Vector2d carried(const Camera& camera, const Matrix3d& H, const Vector2d& undistorted_px) {
  return distort(camera, transfer(H, undistorted_px));
}

/// By how much a look is off its prediction by H, or why it is not found.
struct Search {
  Vector2d shift_px = Vector2d::Zero();
  std::optional<TrackEnd> end = std::nullopt;
};

Search search(const cv::Mat& picture,
              const Look& look,
              const Camera& camera,
              const Matrix3d& H,
              const AnchorOptions& options) {
  if (look.width < 2 || look.height < 2)
    return {.end = TrackEnd{.reason = LossReason::look_not_found}};
  Nodes nodes;
  for (int k = 0; k < 9; ++k) nodes.col(k) = carried(camera, H, look.undistorted_px.col(k));
  if (!nodes.allFinite()) return {.end = TrackEnd{.reason = LossReason::look_not_found}};
  const Matrix2Xf places = places_between(nodes, look.width, look.height);
  Matrix2d J;  // of the way from the reference picture, in the middle of the look
  J << (nodes.col(5) - nodes.col(3)) / (look.width - 1),
      (nodes.col(7) - nodes.col(1)) / (look.height - 1);
  Vector2d shift = Vector2d::Zero();
  for (int step = 0; step < kMostSteps; ++step) {
    const auto compared = compare(picture, look, places, shift.cast<float>());
    if (!compared) return {.end = TrackEnd{.reason = LossReason::look_not_found}};
    const Vector2d step_px = J * compared->step_px;
    shift += step_px;
    if (!(shift.norm() <= options.farthest_px))
      return {.end = TrackEnd{0, LossReason::look_far, shift.norm(), options.farthest_px}};
    if (step_px.norm() > kConverged_px) continue;
    if (compared->correlation >= options.least_correlation) return {shift};
    return {.end = TrackEnd{
                0, LossReason::look_unlike, compared->correlation, options.least_correlation}};
  }
  return {.end = TrackEnd{.reason = LossReason::look_not_found}};
}

/// The homography from the reference frame and which tracks agree with it; none where lost.
std::optional<RobustHomography> plane_homography(const Anchors& anchors,
                                                 const Matrix2Xd& raw_px,
                                                 const RansacOptions& options) {
  std::vector<int> seen;
  Matrix2Xd now(2, raw_px.cols());
  for (int j = 0; j < raw_px.cols(); ++j) {
    if (!raw_px.col(j).allFinite() || !anchors.undistorted_px.col(j).allFinite()) continue;
    now.col(j) = undistort(anchors.camera, raw_px.col(j));
    if (now.col(j).allFinite()) seen.push_back(j);
  }
  const auto robust =
      homography_ransac(anchors.undistorted_px(Eigen::all, seen), now(Eigen::all, seen), options);
  if (!robust) return std::nullopt;
  RobustHomography of_all{robust->H, std::vector<bool>(raw_px.cols(), false)};
  for (std::size_t k = 0; k < seen.size(); ++k) of_all.inlier[seen[k]] = robust->inlier[k];
  return of_all;
}

/// What of the square around a pixel is in the picture; empty of what is no pixel at all.
cv::Rect patch_around(const Vector2d& raw_px, int half, const cv::Size& size) {
  const double most = std::max(size.width, size.height) + half;
  if (!raw_px.allFinite() || raw_px.cwiseAbs().maxCoeff() > most) return {};
  const cv::Point center(cvRound(raw_px.x()), cvRound(raw_px.y()));
  return cv::Rect(center.x - half, center.y - half, 2 * half + 1, 2 * half + 1) &
         cv::Rect({0, 0}, size);
}

/// The pixels of `patch` in the smoothed reference picture and its slopes.
Look look_at(const cv::Rect& patch,
             const cv::Mat& smoothed,
             const cv::Mat& slope_x,
             const cv::Mat& slope_y,
             const Camera& camera) {
  Look look{patch.width, patch.height, Nodes::Zero(), {}, Eigen::Matrix4f::Zero()};
  if (patch.empty()) return look;
  for (int k = 0; k < 9; ++k) {
    const int column = k % 3;
    const int row = k / 3;
    const Vector2d px(patch.x + 0.5 * (patch.width - 1) * column,
                      patch.y + 0.5 * (patch.height - 1) * row);
    look.undistorted_px.col(k) = undistort(camera, px);
  }
  look.model.resize(patch.area(), 4);
  for (int k = 0; k < patch.area(); ++k) {
    const cv::Point pixel = patch.tl() + cv::Point(k % patch.width, k / patch.width);
    look.model.row(k) << slope_x.at<float>(pixel), slope_y.at<float>(pixel),
        smoothed.at<float>(pixel), 1;
  }
  look.model.col(2).array() -= look.model.col(2).mean();
  look.normal = look.model.transpose() * look.model;
  return look;
}

/// Quadratic through values at -1, 0 and 1.
struct Quadratic {
  Vector2d at_minus, at_zero, at_plus;
  Vector2d operator()(double t) const {
    return at_zero + t * (0.5 * (at_plus - at_minus) + t * (0.5 * (at_plus + at_minus) - at_zero));
  }
};

}  // namespace

Matrix2Xf places_between(const Nodes& nodes_px, int width, int height) {
  const auto column = [&](int k) {
    return Quadratic{nodes_px.col(k), nodes_px.col(k + 3), nodes_px.col(k + 6)};
  };
  const Quadratic left = column(0);
  const Quadratic middle = column(1);
  const Quadratic right = column(2);
  Matrix2Xf places(2, static_cast<Eigen::Index>(width) * height);
  for (int v = 0; v < height; ++v) {
    const double t = 2.0 * v / (height - 1) - 1;
    const Quadratic row{left(t), middle(t), right(t)};
    for (int u = 0; u < width; ++u)
      places.col(v * width + u) = row(2.0 * u / (width - 1) - 1).cast<float>();
  }
  return places;
}

Anchors make_anchors(const cv::Mat& gray,
                     const Matrix2Xd& raw_px,
                     const Camera& camera,
                     const AnchorOptions& options) {
  const cv::Mat smoothed = smooth(gray, options);
  cv::Mat slope_x;
  cv::Mat slope_y;
  cv::Sobel(smoothed, slope_x, CV_32F, 1, 0, 1, 0.5);
  cv::Sobel(smoothed, slope_y, CV_32F, 0, 1, 1, 0.5);
  Anchors anchors{camera, Matrix2Xd(2, raw_px.cols()), {}};
  for (Eigen::Index j = 0; j < raw_px.cols(); ++j) {
    anchors.undistorted_px.col(j) = undistort(camera, raw_px.col(j));
    const cv::Rect patch = patch_around(raw_px.col(j), options.half_patch_px, gray.size());
    anchors.looks.push_back(look_at(patch, smoothed, slope_x, slope_y, camera));
  }
  return anchors;
}

Held hold(const Anchors& anchors,
          const cv::Mat& gray,
          const Matrix2Xd& followed_px,
          const AnchorOptions& options) {
  const cv::Mat picture = smooth(gray, options);
  Held held{followed_px, std::vector<std::optional<TrackEnd>>(followed_px.cols())};
  // One round is enough: where a look is found hardly depends on how well it was predicted. Others,
  // each with the homography of what was found before, changed the median error by 0.0001 px.
  const auto plane = plane_homography(anchors, followed_px, options.ransac);
  for (Eigen::Index j = 0; plane && j < followed_px.cols(); ++j) {
    if (!plane->inlier[j]) continue;
    const auto [shift_px, end] =
        search(picture, anchors.looks[j], anchors.camera, plane->H, options);
    held.ends[j] = end;
    held.raw_px.col(j).setConstant(std::numeric_limits<double>::quiet_NaN());
    if (end) continue;
    held.raw_px.col(j) =
        carried(anchors.camera, plane->H, anchors.undistorted_px.col(j)) + shift_px;
  }
  return held;
}

}  // namespace gpo
