// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/processor.h"
#include "engine/window/tracks.h"

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// Smooths an image by (1 6 1)/8 along both axes (a standard deviation of 0.5 px) so that it can be
/// interpolated: CV_16UC1, 64 times the gray level. `gray` is CV_8UC1.
cv::Mat smooth_image(const cv::Mat& gray);

/// Returns the image at half the size: each pixel is the mean of four. CV_16UC1, as `image`.
cv::Mat halved(const cv::Mat& image);

/// Smoothed images, each of half the size of the one before.
using SmoothedPyramid = std::vector<cv::Mat>;

/// `gray` is CV_8UC1.
SmoothedPyramid smoothed_pyramid(const cv::Mat& gray);

/// Estimates the motion of places from one image to the next [px]: from coarse to fine down to half
/// the size, invariant to gain and offset of the exposure. Accurate to a few tenths of a pixel; a
/// guess in areas without texture. `raw_px` is 2 x n, finite.
Eigen::Matrix2Xd coarse_flow(const SmoothedPyramid& from,
                             const SmoothedPyramid& to,
                             const Eigen::Matrix2Xd& raw_px);

/// Motions of places from one image to the next.
struct PlaceMotions {
  Eigen::Matrix2Xd px;  ///< 2 x places
  /// Correlation of each place with the image before, at half the size; -1 if not compared.
  Eigen::VectorXd correlations;
};

/// Refines rough motions of places, each from its level of the pyramid down to half the size and no
/// farther than its `farthest_px` from its start.
PlaceMotions refined_motions(const SmoothedPyramid& from,
                             const SmoothedPyramid& to,
                             const Eigen::Matrix2Xd& raw_px,
                             const Eigen::Matrix2Xd& start_px,
                             const std::vector<int>& levels,
                             const Eigen::VectorXd& farthest_px);

/// Returns the largest motion that `coarse_flow` looks for [px].
double farthest_motion_px(const SmoothedPyramid& pyramid);

/// Number of template pixels that are summed at a time.
constexpr int kPatchKernelWidth = 8;

/// Patch template: the whole pixels around a place in a smoothed image, by rows, each padded to a
/// multiple of the kernel's width. Padding is zero, and so are pixels outside of the image in all
/// but the offsets.
struct Patch {
  std::vector<float> dx;          ///< from its middle [px]
  std::vector<float> dy;          ///< [px]
  std::vector<float> slope_x;     ///< [brightness / px]
  std::vector<float> slope_y;     ///< [brightness / px]
  std::vector<float> brightness;  ///< without its mean
  std::vector<float> one;         ///< 1 in the image
  int half = 0;                   ///< largest dx and dy [px]
  int row = 0;                    ///< pixels of a row with its padding
  bool is_complete = false;       ///< no pixel is outside of the image
};

/// Makes a template of the pixels from `-half` to `half` around a pixel.
Patch make_patch(const cv::Mat& image, const cv::Point& middle, int half);

/// Sums of the products of a template's columns: slopes along x and y; slope along x times dx, dy;
/// slope along y times dx, dy; brightness; 1.
using PatchNormalMatrix = Eigen::Matrix<double, 8, 8>;
PatchNormalMatrix patch_normal_matrix(const Patch& patch);

/// Maps a template into an image: the pixel at d from its middle is at
/// center + linear d + quadratic (d_x^2, d_x d_y, d_y^2).
struct Warp {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< [px]
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Eigen::Matrix<double, 2, 3> quadratic = Eigen::Matrix<double, 2, 3>::Zero();  ///< [1 / px]

  Eigen::Vector2d operator()(const Eigen::Vector2d& d) const {
    return center + linear * d +
           quadratic * Eigen::Vector3d(d.x() * d.x(), d.x() * d.y(), d.y() * d.y());
  }
};

/// Returns the largest distance along x and y of a warped template from the warp's center [px].
inline Eigen::Vector2d reach_px(const Patch& patch, const Warp& warp) {
  return patch.half * warp.linear.cwiseAbs().rowwise().sum() +
         patch.half * patch.half * warp.quadratic.cwiseAbs().rowwise().sum();
}

/// Returns whether an image contains all pixels of a warped template.
bool is_inside(const cv::Size& image, const Patch& patch, const Warp& warp);

/// Returns the template with all pixels that the warp puts outside of the image set to zero,
/// offsets included. The warp's center must be inside.
Patch inside_part(const cv::Size& image, const Patch& patch, const Warp& warp);

/// Sums over a template's pixels of an image's brightness I at the warped places.
struct PatchSums {
  /// Sums of I times each of the template's columns.
  Eigen::Matrix<float, 8, 1> products = Eigen::Matrix<float, 8, 1>::Zero();
  float squares = 0;  ///< sum of I^2
};

enum class MotionModel { shift, affine };

/// Computes the sums in one pass over a template that is inside the smoothed image, with bilinear
/// interpolation and the widest registers of this processor. (OpenCV's `remap` rounds places to
/// 1/32 px.) For a shift the products of dx and dy may be missing.
PatchSums patch_sums(const cv::Mat& image,
                     const Patch& patch,
                     const Warp& warp,
                     MotionModel unknown,
                     bool avx2_fma = has_avx2_fma());

/// The same for a pure shift and a template without padding, whose last row and column may be
/// missing; without the products of dx and dy.
PatchSums shifted_sums(const cv::Mat& image,
                       const Patch& patch,
                       const Eigen::Vector2d& center,
                       bool avx2_fma = has_avx2_fma());

/// Copies the pixels around `middle` into a template like that of `shifted_sums`, all of them
/// inside. Returns the sums of products of slopes along x and y, brightness and 1.
Eigen::Matrix4d take_pixels(const cv::Mat& image,
                            const cv::Point& middle,
                            Patch& patch,
                            bool avx2_fma = has_avx2_fma());

struct SearchOptions {
  double farthest_px = 5;          ///< largest distance from the prediction [px]
  double least_correlation = 0.7;  ///< for an accepted match, zero-mean normalized [-]
  double edge = 0.25;  ///< a template is an edge below this ratio of the squared slopes along its
                       ///< weakest and strongest directions [-]
  double least_detail = 0.4;  ///< see `detail_along_edge` [-]
};

/// A template prepared for repeated searches.
struct PatchTemplate {
  Patch patch;
  PatchNormalMatrix normal;
  PatchNormalMatrix affine;    ///< inverse of the normal matrix
  Eigen::Matrix4d shift;       ///< inverse of its part without the terms of dx and dy
  Eigen::Vector2d along_edge;  ///< unit vector of the weakest slope
  double edge;                 ///< see SearchOptions
};

PatchTemplate make_patch_template(Patch patch);

/// Alignment result, or why there is none; the end's frame is 0.
struct Found {
  Warp warp = {};
  std::optional<TrackEnd> end = std::nullopt;
};

/// Aligns a template with a smoothed image, starting at `start`: inverse compositional Gauss-Newton
/// over the warp's center, or center and linear part, invariant to gain and offset of the exposure
/// (engine/method.md, 15a).
Found search(const cv::Mat& image,
             const PatchTemplate& patch_template,
             const Warp& start,
             MotionModel unknown,
             const SearchOptions& options = {});

/// Returns how much of a template's detail along its edge the image repeats (engine/method.md,
/// 15c): the regression of the image's slopes on the template's; 1: all of it. Near 0 the template
/// is an edge with noise, which correlates wherever it slides. Returns nullopt if a part of the
/// template is outside of the image.
std::optional<double> detail_along_edge(const cv::Mat& image,
                                        const PatchTemplate& patch_template,
                                        const Warp& warp);

}  // namespace gpo
