// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/parallel.h"
#include "engine/base/stop.h"
#include "engine/calibration/plane/plane_lens.h"
#include "engine/geometry/homography.h"
#include "engine/planes/inliers.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Vector2d;

// k1 of a lens with a diagonal field of view of 70 deg.
constexpr std::array kDistortions{0.0, -0.7, -0.5, -0.35, -0.2, -0.1, 0.1};
constexpr int kDistortionWindows = 3;
constexpr double kClearlyMore = 1.1;  // tracks than without distortion
constexpr int kWindowFrames = 20;     // until corners are detected again
constexpr int kLeastTracks = 20;      // on the plane
constexpr double kChainGate = 3;  // see window_planes; wide, as the lens is a guess [pixel_unit]

Window window_of(const Tracks& tracks, const Camera& camera) {
  const std::vector<std::int64_t> times(tracks.start + tracks.frame_count(), 0);
  return make_window(
      tracks,
      camera,
      times,
      {.ransac = {.threshold_px = kChainGate * pixel_unit(camera)}, .inliers = Inliers::planes});
}

/// Tracks in every step-th image; start and frames count in steps. nullopt if there are none.
std::optional<Tracks> tracks_at(const ChainImages& images,
                                const Camera& camera,
                                int start,
                                int frames) {
  const auto gray = [&](int k) { return images.cache.gray(k * images.step); };
  auto tracks = track_window(gray, camera, {start, frames}, Tracking::anchored, {current_stop()});
  check_stop();
  if (tracks && tracks->track_count() == 0) tracks.reset();
  return tracks;
}

std::vector<cv::Point2f> places(const Window& window, const std::vector<int>& tracks, int frame) {
  std::vector<cv::Point2f> points;
  for (const int j : tracks) {
    const auto p = window.points_px[frame].col(j);
    if (p.allFinite()) points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  return points;
}

int plane_within(const Window& window, const std::vector<cv::Point2f>& hull) {
  if (hull.size() < 3) return 0;
  int best = 0;
  std::ptrdiff_t most = -1;
  for (std::size_t k = 0; k < window.planes.size(); ++k) {
    const auto points = places(window, window.planes[k].tracks, 0);
    const auto inside = std::ranges::count_if(
        points, [&](const cv::Point2f& p) { return cv::pointPolygonTest(hull, p, false) >= 0; });
    if (inside <= most) continue;
    most = inside;
    best = static_cast<int>(k);
  }
  return best;
}

int last_known(const WindowPlane& plane) {
  int last = 0;
  for (std::size_t i = 1; i < plane.H_i1.size(); ++i) {
    if (!plane.H_i1[i].allFinite() || std::ranges::count(plane.inlier[i], true) < kLeastTracks)
      break;
    last = static_cast<int>(i);
  }
  return last;
}

constexpr double kNotFound = std::numeric_limits<double>::quiet_NaN();
constexpr int kLeastFound = 12;  // to refine a homography
constexpr int kPasses = 2;
constexpr int kMostReferences = 8;   // with points to find
constexpr double kLeastArea = 0.15;  // area of a warped patch relative to its own [-]
constexpr double kMostArea = 6;      // the same
constexpr double kLinkGate = 4;      // from the others' homography, wide as above [pixel_unit]

struct Sample {
  int frame;
  Matrix3d H_i_first;
  cv::Mat soft;
};

struct Patches {
  int frame;
  Matrix3d H_r_first;
  std::vector<PatchTemplate> patches;
  std::vector<Nodes> nodes_px;
  Matrix2Xd undistorted_px;
  Matrix2Xd corners_px;  ///< relative to the patch centers
};

Patches patches_of(const PlaneReference& reference,
                   const Matrix3d& H_r_first,
                   const cv::Mat& soft,
                   const Camera& camera) {
  Patches all{reference.frame, H_r_first, {}, {}, {}, {}};
  all.undistorted_px = all.corners_px = reference.raw_px;
  for (Eigen::Index j = 0; j < reference.raw_px.cols(); ++j) {
    const Vector2d center = reference.raw_px.col(j).array().round();
    all.patches.push_back(make_patch_template(
        make_patch(soft,
                   cv::Point(static_cast<int>(center.x()), static_cast<int>(center.y())),
                   kHalfPatch_px)));
    all.nodes_px.push_back(patch_nodes(camera, center));
    all.undistorted_px.col(j) = undistort(camera, reference.raw_px.col(j));
    all.corners_px.col(j) -= center;
  }
  return all;
}

Matrix2Xd found_by(const Patches& patches,
                   const Matrix3d& H,
                   const cv::Mat& soft,
                   const Camera& camera) {
  const SearchOptions options = anchor_options(camera).search;
  Matrix2Xd found = Matrix2Xd::Constant(2, patches.undistorted_px.cols(), kNotFound);
  for (Eigen::Index j = 0; j < found.cols(); ++j) {
    const auto warp = warp_by(camera, H, patches.nodes_px[j]);
    if (!warp || !is_inside(soft.size(), patches.patches[j].patch, *warp)) continue;
    const double area = warp->linear.determinant();
    if (area < kLeastArea || area > kMostArea) continue;
    const Found hit = search(soft, patches.patches[j], *warp, MotionModel::shift, options);
    if (!hit.end) found.col(j) = hit.warp(patches.corners_px.col(j));
  }
  return found;
}

/// Homography by the positions, whose outliers become NaN; nullopt if too few agree.
std::optional<Matrix3d> refined(const Patches& patches, Matrix2Xd& found, const Camera& camera) {
  std::vector<int> columns;
  Matrix2Xd undistorted_px(2, found.cols());
  for (int j = 0; j < found.cols(); ++j) {
    if (!found.col(j).allFinite()) continue;
    undistorted_px.col(j) = undistort(camera, found.col(j));
    if (undistorted_px.col(j).allFinite()) columns.push_back(j);
  }
  if (std::ssize(columns) < kLeastFound) return std::nullopt;
  const auto robust = homography_ransac(patches.undistorted_px(Eigen::all, columns),
                                        undistorted_px(Eigen::all, columns),
                                        {.threshold_px = kLinkGate * pixel_unit(camera)});
  if (!robust || std::ranges::count(robust->inlier, true) < kLeastFound) return std::nullopt;
  const Matrix2Xd all = found;
  found.setConstant(kNotFound);
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (robust->inlier[k]) found.col(columns[k]) = all.col(columns[k]);
  return robust->H;
}

std::vector<Matrix2Xd> in_all_samples(const Patches& patches,
                                      const std::vector<Sample>& samples,
                                      const Camera& camera) {
  std::vector<Matrix2Xd> all(samples.size(),
                             Matrix2Xd::Constant(2, patches.undistorted_px.cols(), kNotFound));
  const auto first = std::ranges::lower_bound(samples, patches.frame, {}, &Sample::frame);
  const auto walk = [&](std::ptrdiff_t begin, std::ptrdiff_t end, std::ptrdiff_t step) {
    Matrix3d correction = Matrix3d::Identity();  // for the last sample's homography
    Matrix3d chained = patches.H_r_first;
    for (std::ptrdiff_t i = begin; i != end; i += step) {
      check_stop();
      Matrix3d H = samples[i].H_i_first * chained.inverse() * correction;
      for (int pass = 0; pass < kPasses; ++pass) {
        Matrix2Xd found = found_by(patches, H, samples[i].soft, camera);
        const auto better = refined(patches, found, camera);
        if (!better) break;
        H = *better;
        all[i] = std::move(found);
      }
      correction = H / H.norm();
      chained = samples[i].H_i_first;
    }
  };
  walk(first - samples.begin(), std::ssize(samples), 1);
  walk(first - samples.begin() - 1, -1, -1);
  return all;
}

void append(const std::vector<Matrix2Xd>& found,
            const std::vector<Sample>& samples,
            ObservedPlane& plane) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    PlaneView& view = plane.views[i];
    std::vector<int> columns;
    for (int j = 0; j < found[i].cols(); ++j)
      if (found[i].col(j).allFinite()) columns.push_back(j);
    const Eigen::Index before = view.raw_px.cols();
    view.raw_px.conservativeResize(2, before + std::ssize(columns));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      view.raw_px.col(before + static_cast<Eigen::Index>(k)) = found[i].col(columns[k]);
      view.points.push_back(plane.points + columns[k]);
    }
  }
  plane.points += static_cast<int>(found.front().cols());
}

Matrix2Xd flow_of(const PlaneView& view, const PlaneChain& chain, const Camera& camera) {
  Matrix2Xd flow_px = Matrix2Xd::Zero(2, view.raw_px.cols());
  const auto here = chain.H_i_first.find(view.frame);
  const auto before = here == chain.H_i_first.begin() ? here : std::prev(here);
  const auto after = std::next(here) == chain.H_i_first.end() ? here : std::next(here);
  const Matrix3d H_before = before->second * here->second.inverse();
  const Matrix3d H_after = after->second * here->second.inverse();
  for (Eigen::Index k = 0; k < flow_px.cols(); ++k) {
    const Eigen::Vector3d p = undistort(camera, view.raw_px.col(k)).homogeneous();
    const Vector2d distance_px = distort(camera, (H_after * p).hnormalized()) -
                                 distort(camera, (H_before * p).hnormalized());
    if (distance_px.allFinite())
      flow_px.col(k) = distance_px / std::max(1, after->first - before->first);
  }
  return flow_px;
}

}  // namespace

Camera with_likely_distortion(const ChainImages& images, const Camera& guess) {
  const int count = images.count();
  const int frames = std::min(kWindowFrames, count);
  std::vector<Tracks> windows;
  for (int k = 0; k < kDistortionWindows; ++k) {
    const int start = k * std::max(0, count - frames) / (kDistortionWindows - 1);
    if (auto tracks = tracks_at(images, guess, start, frames))
      windows.push_back(*std::move(tracks));
  }
  Camera best = guess;
  best.distortion = Distortion::radial_tangential;
  if (best.coefficients.empty()) best.coefficients = {0, 0, 0, 0};
  double most = 0;
  for (const double k1 : kDistortions) {
    Camera camera = best;
    camera.coefficients = {k1, 0, 0, 0};
    double on_plane = 0;
    for (const Tracks& tracks : windows) {
      check_stop();
      const Window window = window_of(tracks, camera);
      if (!window.planes.empty()) on_plane += static_cast<double>(window.planes[0].tracks.size());
    }
    if (k1 != 0) on_plane /= kClearlyMore;
    if (on_plane <= most) continue;
    most = on_plane;
    best = camera;
  }
  return best;
}

std::vector<PlaneChain> plane_chains(const ChainImages& images, const Camera& camera) {
  const int count = images.count();
  std::vector<PlaneChain> chains;
  std::vector<cv::Point2f> hull;  // around the plane's tracks at the end of the last window
  int start = 0;
  while (start + 1 < count) {
    if (images.progress) images.progress(start, count);
    const int frames = std::min(kWindowFrames + 1, count - start);
    const auto tracks = tracks_at(images, camera, start, frames);
    const Window window = tracks ? window_of(*tracks, camera) : Window{};
    int last = 0;
    if (!window.planes.empty()) {
      const WindowPlane& plane = window.planes[plane_within(window, hull)];
      last = last_known(plane);
      if (last > 0) {
        if (hull.empty()) {
          chains.emplace_back();
          chains.back().H_i_first[start * images.step].setIdentity();
        }
        PlaneChain& chain = chains.back();
        const Matrix3d to_start = chain.H_i_first.at(start * images.step);
        for (int i = 1; i <= last; ++i) {
          const Matrix3d H = plane.H_i1[i] * to_start;
          chain.H_i_first[(start + i) * images.step] = H / H.norm();
        }
        chain.references.push_back(
            {start * images.step, tracks->raw_px[0](Eigen::all, plane.tracks)});
        hull.clear();
        cv::convexHull(places(window, plane.tracks, last), hull);
      }
    }
    if (last == 0) hull.clear();
    start += std::max(1, last);
  }
  return chains;
}

ObservedPlane linked_views(const FrameCache& images,
                           const PlaneChain& chain,
                           const Camera& camera,
                           int most_views) {
  std::vector<std::pair<int, Matrix3d>> frames(chain.H_i_first.begin(), chain.H_i_first.end());
  std::vector<Sample> samples;
  ObservedPlane plane;
  for (const auto& [frame, H] : spread(frames, most_views)) {
    check_stop();
    samples.push_back({frame, H, smooth_image(images.gray(frame))});
    plane.views.push_back({frame, {}, Matrix2Xd(2, 0)});
  }
  std::vector<Patches> patches;
  for (const PlaneReference& reference : spread(chain.references, kMostReferences)) {
    const cv::Mat soft = smooth_image(images.gray(reference.frame));
    patches.push_back(patches_of(reference, chain.H_i_first.at(reference.frame), soft, camera));
  }
  std::vector<std::vector<Matrix2Xd>> found(patches.size());
  in_parallel(static_cast<int>(patches.size()),
              static_cast<int>(std::thread::hardware_concurrency()),
              [&](int r) { found[r] = in_all_samples(patches[r], samples, camera); });
  for (const auto& of_reference : found) append(of_reference, samples, plane);
  for (PlaneView& view : plane.views) view.flow_px = flow_of(view, chain, camera);
  return plane;
}

}  // namespace gpo
