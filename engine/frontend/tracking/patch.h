// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/tracks.h"

#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

constexpr int kSmoothedGain = 64;  ///< value of one gray level in a smoothed image

/// Smooths an image by (1 6 1)/8 along both axes for interpolation. CV_8UC1 -> CV_16UC1.
cv::Mat smooth_image(const cv::Mat& gray);

/// Returns the image at half the size: each pixel is the mean of four. CV_16UC1, as `image`.
cv::Mat halved(const cv::Mat& image);

using SmoothedPyramid = std::vector<cv::Mat>;

SmoothedPyramid smoothed_pyramid(const cv::Mat& gray);

/// Coarse-to-fine motion of places between images [px], invariant to gain and offset: accurate to
/// tenths of a pixel, a guess in areas without texture. `raw_px` is 2 x n, finite.
Eigen::Matrix2Xd coarse_flow(const SmoothedPyramid& from,
                             const SmoothedPyramid& to,
                             const Eigen::Matrix2Xd& raw_px);

constexpr int kPatchKernelWidth = 8;

/// Whole pixels around a place, padded to the kernel's width; outside zero but for the offsets.
struct Patch {
  std::vector<float> dx;          ///< from its middle [px]
  std::vector<float> dy;          ///< [px]
  std::vector<float> slope_x;     ///< [brightness / px]
  std::vector<float> slope_y;     ///< [brightness / px]
  std::vector<float> brightness;  ///< without its mean
  std::vector<float> one;         ///< 1 in the image
  int half = 0;                   ///< largest dx and dy [px]
};

Patch make_patch(const cv::Mat& image, const cv::Point& middle, int half);

/// Sums of the products of a template's columns: slopes along x and y; slope along x times dx, dy;
/// slope along y times dx, dy; brightness; 1.
using PatchNormalMatrix = Eigen::Matrix<double, 8, 8>;
PatchNormalMatrix patch_normal_matrix(const Patch& patch);

/// Maps the pixel at d to center + linear d + quadratic (d_x^2, d_x d_y, d_y^2).
struct Warp {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< [px]
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Eigen::Matrix<double, 2, 3> quadratic = Eigen::Matrix<double, 2, 3>::Zero();  ///< [1 / px]

  Eigen::Vector2d operator()(const Eigen::Vector2d& d) const {
    return center + linear * d +
           quadratic * Eigen::Vector3d(d.x() * d.x(), d.x() * d.y(), d.y() * d.y());
  }
};

bool is_inside(const cv::Size& image, const Patch& patch, const Warp& warp);

/// Returns the template with all pixels outside of the image set to zero, offsets included.
Patch inside_part(const cv::Size& image, const Patch& patch, const Warp& warp);

/// Sums over a template's pixels of an image's brightness I at the warped places.
struct PatchSums {
  Eigen::Matrix<float, 8, 1> products = Eigen::Matrix<float, 8, 1>::Zero();
  float squares = 0;  ///< sum of I^2
};

/// One bilinear pass over a template inside the image (OpenCV's `remap` rounds to 1/32 px).
PatchSums patch_sums(const cv::Mat& image, const Patch& patch, const Warp& warp);

/// The same for a pure shift and padded rows; without the products of dx and dy.
PatchSums shifted_sums(const cv::Mat& image, const Patch& patch, const Eigen::Vector2d& center);

// The versions that these choose from; the last two only if `has_avx2_fma`.
PatchSums patch_sums_baseline(const cv::Mat& image, const Patch& patch, const Warp& warp);
PatchSums shifted_sums_baseline(const cv::Mat& image,
                                const Patch& patch,
                                const Eigen::Vector2d& center);
PatchSums patch_sums_avx2_fma(const cv::Mat& image, const Patch& patch, const Warp& warp);
PatchSums shifted_sums_avx2_fma(const cv::Mat& image,
                                const Patch& patch,
                                const Eigen::Vector2d& center);

struct SearchOptions {
  double farthest_px = 5;          ///< largest distance from the prediction [px]
  double least_correlation = 0.7;  ///< for an accepted match, zero-mean normalized [-]
  double edge = 0.25;  ///< a template is an edge below this ratio of the squared slopes along its
                       ///< weakest and strongest directions [-]
  double least_detail = 0.4;  ///< see `detail_along_edge` [-]
};

struct PatchTemplate {
  Patch patch;
  PatchNormalMatrix normal;
  Eigen::LDLT<PatchNormalMatrix> affine;  ///< factors of the normal matrix
  Eigen::LDLT<Eigen::Matrix4d> shift;     ///< factors of its part without the terms of dx and dy
  Eigen::Vector2d along_edge;             ///< unit vector of the weakest slope
  double edge;                            ///< see SearchOptions
};

PatchTemplate make_patch_template(Patch patch);

enum class MotionModel { shift, affine };

/// Alignment result, or why there is none; the end's frame is 0.
struct Found {
  Warp warp = {};
  std::optional<TrackEnd> end = std::nullopt;
};

/// Inverse compositional Gauss-Newton, invariant to gain and offset (engine/method.md, 15a).
Found search(const cv::Mat& image,
             const PatchTemplate& patch_template,
             const Warp& start,
             MotionModel unknown,
             const SearchOptions& options = {});

/// Regression of the image's slopes along the template's edge on its own (engine/method.md, 15c).
/// Near 0 it is an edge with noise. nullopt if a part of the template is outside of the image.
std::optional<double> detail_along_edge(const cv::Mat& image,
                                        const PatchTemplate& patch_template,
                                        const Warp& warp);

}  // namespace gpo
