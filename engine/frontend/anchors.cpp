// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/anchors.h"

#include "engine/geometry/homography.h"
#include "engine/geometry/median.h"

#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr int kMostSteps = 20;          // of Gauss-Newton
constexpr double kConverged_px = 1e-3;  // length of its last step

cv::Mat smooth(const cv::Mat& gray, const AnchorOptions& options) {
  cv::Mat smoothed;
  gray.convertTo(smoothed, CV_32F);
  cv::GaussianBlur(smoothed, smoothed, cv::Size(), options.blur_px);
  return smoothed;
}

/// CV_32FC3: brightness and its slopes along x and y [gray levels, gray levels / px].
cv::Mat with_slopes(const cv::Mat& smoothed) {
  std::vector<cv::Mat> channels{smoothed, {}, {}};
  cv::Sobel(smoothed, channels[1], CV_32F, 1, 0, 1, 0.5);
  cv::Sobel(smoothed, channels[2], CV_32F, 0, 1, 1, 0.5);
  cv::Mat merged;
  cv::merge(channels, merged);
  return merged;
}

/// Bilinear. Our own, because OpenCV's `remap` rounds places to 1/32 px (pitfall E7).
std::optional<cv::Vec3f> sample(const cv::Mat& picture, const Vector2d& px) {
  const bool inside =
      px.x() >= 0 && px.y() >= 0 && px.x() < picture.cols - 1 && px.y() < picture.rows - 1;
  if (!inside) return std::nullopt;
  const int u = static_cast<int>(px.x());
  const int v = static_cast<int>(px.y());
  const auto a = static_cast<float>(px.x() - u);
  const auto b = static_cast<float>(px.y() - v);
  const auto* upper = picture.ptr<cv::Vec3f>(v) + u;
  const auto* lower = picture.ptr<cv::Vec3f>(v + 1) + u;
  return (1 - b) * ((1 - a) * upper[0] + a * upper[1]) + b * ((1 - a) * lower[0] + a * lower[1]);
}

/// A look against a picture: what one step of Gauss-Newton needs.
struct Comparison {
  Vector2d step_px;    ///< by which the look should move
  double correlation;  ///< zero-mean normalized
};

/// Least squares I(w + t) + grad I dt = gain T + offset over dt, gain and offset, linear in all.
/// `places_px` are those of the look's pixels in the picture, 2 x n; nothing where less than half
/// of them are in it.
std::optional<Comparison> compare(const cv::Mat& picture,
                                  const Look& look,
                                  const Matrix2Xd& places_px,
                                  const Vector2d& shift_px) {
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  double squares = 0;
  for (Eigen::Index k = 0; k < places_px.cols(); ++k) {
    const auto s = sample(picture, places_px.col(k) + shift_px);
    if (!s) continue;
    const Eigen::Vector4d row((*s)[1], (*s)[2], -look.gray[k], -1);
    A += row * row.transpose();
    b -= row * (*s)[0];
    squares += static_cast<double>((*s)[0]) * (*s)[0];
  }
  const double n = A(3, 3);
  if (2 * n < static_cast<double>(places_px.cols())) return std::nullopt;
  const double covariance = b(2) - A(2, 3) * b(3) / n;
  const double variances = (squares - b(3) * b(3) / n) * (A(2, 2) - A(2, 3) * A(2, 3) / n);
  const Eigen::Vector4d solution = A.ldlt().solve(b);
  return Comparison{solution.head<2>(), variances > 0 ? covariance / std::sqrt(variances) : 0};
}

/// Where H and the lens take undistorted pixels of the reference picture: raw pixels.
Matrix2Xd carried(const Camera& camera, const Matrix3d& H, const Matrix2Xd& undistorted_px) {
  Matrix2Xd places(2, undistorted_px.cols());
  for (Eigen::Index k = 0; k < places.cols(); ++k)
    places.col(k) = distort(camera, transfer(H, undistorted_px.col(k)));
  return places;
}

/// By how much the look is off its prediction; nothing where it is not found.
std::optional<Vector2d> search(const cv::Mat& picture,
                               const Look& look,
                               const Matrix2Xd& places_px,
                               const AnchorOptions& options) {
  Vector2d shift = Vector2d::Zero();
  for (int step = 0; step < kMostSteps; ++step) {
    const auto compared = compare(picture, look, places_px, shift);
    if (!compared) return std::nullopt;
    shift += compared->step_px;
    if (!(shift.norm() <= options.farthest_px)) return std::nullopt;
    if (compared->step_px.norm() > kConverged_px) continue;
    return compared->correlation >= options.least_correlation ? std::optional(shift) : std::nullopt;
  }
  return std::nullopt;
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

/// Median distance between the places of tracks that both have; 0 where there are none.
double median_distance(const Matrix2Xd& a, const Matrix2Xd& b) {
  std::vector<double> distances;
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    const double distance = (a.col(j) - b.col(j)).norm();
    if (std::isfinite(distance)) distances.push_back(distance);
  }
  return distances.empty() ? 0 : median(std::move(distances));
}

}  // namespace

Anchors make_anchors(const cv::Mat& gray,
                     const Matrix2Xd& raw_px,
                     const Camera& camera,
                     const AnchorOptions& options) {
  const cv::Mat smoothed = smooth(gray, options);
  const int half = options.half_patch_px;
  Anchors anchors{camera, Matrix2Xd(2, raw_px.cols()), {}};
  for (Eigen::Index j = 0; j < raw_px.cols(); ++j) {
    anchors.undistorted_px.col(j) = undistort(camera, raw_px.col(j));
    const cv::Point center(cvRound(raw_px(0, j)), cvRound(raw_px(1, j)));
    const cv::Rect patch = cv::Rect(center.x - half, center.y - half, 2 * half + 1, 2 * half + 1) &
                           cv::Rect(0, 0, gray.cols, gray.rows);
    Look look{Matrix2Xd(2, patch.area()), Eigen::VectorXd(patch.area())};
    for (int k = 0; k < patch.area(); ++k) {
      const cv::Point pixel = patch.tl() + cv::Point(k % patch.width, k / patch.width);
      look.undistorted_px.col(k) = undistort(camera, Vector2d(pixel.x, pixel.y));
      look.gray[k] = smoothed.at<float>(pixel);
    }
    look.gray.array() -= look.gray.mean();
    anchors.looks.push_back(std::move(look));
  }
  return anchors;
}

Matrix2Xd hold(const Anchors& anchors,
               const cv::Mat& gray,
               const Matrix2Xd& followed_px,
               const AnchorOptions& options) {
  const cv::Mat picture = with_slopes(smooth(gray, options));
  Matrix2Xd held = followed_px;
  for (int round = 0; round < options.most_rounds; ++round) {
    const auto plane = plane_homography(anchors, held, options.ransac);
    if (!plane) break;
    const Matrix2Xd corners = carried(anchors.camera, plane->H, anchors.undistorted_px);
    const Matrix2Xd before = held;
    for (Eigen::Index j = 0; j < held.cols(); ++j) {
      if (!plane->inlier[j]) continue;
      const Look& look = anchors.looks[j];
      const auto shift =
          search(picture, look, carried(anchors.camera, plane->H, look.undistorted_px), options);
      held.col(j).setConstant(std::numeric_limits<double>::quiet_NaN());
      if (shift) held.col(j) = corners.col(j) + *shift;
    }
    if (median_distance(before, held) < options.settled_px) break;
  }
  return held;
}

}  // namespace gpo
