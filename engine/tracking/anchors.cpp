// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/tracking/tracker.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Step {
  Anchors& anchors;
  const cv::Mat& image;
  const Matrix2Xd& before_px;
  const AnchorOptions& options;
  std::vector<Warp> before = anchors.warps;  ///< in the image before
  FollowedTracks aligned{before_px.cols()};

  bool was_seen(int j) const { return before_px.col(j).allFinite(); }
  bool is_seen(int j) const { return aligned.raw_px.col(j).allFinite(); }
  Vector2d motion_px(int j) const { return aligned.raw_px.col(j) - before_px.col(j); }

  bool repeats() const { return anchors.periods_px.size() > 0; }
  /// Half of a period or more would be a jump; a third leaves a margin.
  double farthest_px(int j) const {
    const double most = options.search.farthest_px;
    return repeats() ? std::min(most, anchors.periods_px[j] / 3) : most;
  }

  void take(int j, const Found& found) {
    aligned.ends[j] = found.end;
    if (found.end) {
      aligned.raw_px.col(j).setConstant(kNaN);
    } else {
      anchors.warps[j] = found.warp;
      aligned.raw_px.col(j) = found.warp(anchors.corners_px.col(j));
    }
  }
};

Found search_from(const Step& step, int j, const Vector2d& motion_px) {
  const PatchTemplate& patch = step.anchors.patches[j];
  Warp start = step.before[j];
  start.center += motion_px;
  SearchOptions options = step.options.search;
  options.farthest_px = step.farthest_px(j);
  const Found found = search(step.image, patch, start, MotionModel::affine, options);
  // An occluder of a part of the template may distort an affine alignment: then only shift it.
  return found.end ? search(step.image, patch, start, MotionModel::shift, options) : found;
}

std::vector<Vector2d> motions_around(const Step& step, int j) {
  std::vector<Vector2d> motions;
  for (const int k : step.anchors.neighborhoods[j].neighbors)
    if (step.is_seen(k)) motions.push_back(step.motion_px(k));
  return motions;
}

Vector2d median_motion(std::vector<Vector2d> motions) {
  Vector2d median;
  const auto middle = motions.begin() + std::ssize(motions) / 2;
  for (int axis = 0; axis < 2; ++axis) {
    std::ranges::nth_element(motions, middle, {}, [&](const Vector2d& m) { return m[axis]; });
    median[axis] = (*middle)[axis];
  }
  return median;
}

bool moves_with_neighbors(const Step& step, int j) {
  const double most = step.farthest_px(j) * step.farthest_px(j);
  const Vector2d motion = step.motion_px(j);
  int alike = 0;
  for (const int k : step.anchors.neighborhoods[j].neighbors) {
    // False for a lost neighbor (NaN).
    if ((step.motion_px(k) - motion).squaredNorm() <= most) ++alike;
    if (alike == step.options.least_alike) return true;
  }
  return false;
}

bool are_enough(const Step& step, const std::vector<Vector2d>& around) {
  return std::ssize(around) / 2 >= step.options.least_alike;
}

/// A track that moves unlike its neighbors has jumped. Returns nullopt if it has not, or is alone.
std::optional<TrackEnd> jump(const Step& step, int j) {
  if (moves_with_neighbors(step, j)) return std::nullopt;
  const std::vector<Vector2d> around = motions_around(step, j);
  if (!are_enough(step, around)) return std::nullopt;
  std::vector<double> off_px;
  for (const Vector2d& motion : around) off_px.push_back((motion - step.motion_px(j)).norm());
  const auto decisive = off_px.begin() + step.options.least_alike - 1;
  std::ranges::nth_element(off_px, decisive);
  double limit = std::max(step.options.search.farthest_px,
                          step.options.most_unlike * median_motion(around).norm());
  if (step.repeats()) limit = step.farthest_px(j);
  if (*decisive <= limit) return std::nullopt;
  return TrackEnd{.reason = LossReason::far_from_prediction, .value = *decisive, .limit = limit};
}

void follow_neighbors(Step& step) {
  const Step first = step;
  for (int j = 0; j < step.before_px.cols(); ++j) {
    if (!step.was_seen(j)) continue;
    if (step.is_seen(j)) {
      const auto end = jump(first, j);
      if (!end) continue;
      step.take(j, {.end = end});
    }
    const std::vector<Vector2d> around = motions_around(first, j);
    if (!are_enough(first, around)) continue;
    const std::optional<TrackEnd> end = step.aligned.ends[j];
    step.take(j, search_from(step, j, median_motion(around)));
    if (!step.is_seen(j) || jump(step, j)) step.take(j, {.end = end});
  }
}

/// Takes each template's shape from its neighbors' motion, which is more accurate than its own.
void take_shape(Step& step) {
  const Camera& camera = step.anchors.camera;
  Matrix2Xd undistorted_px = step.aligned.raw_px;
  for (int j = 0; j < step.before_px.cols(); ++j)
    if (step.is_seen(j)) undistorted_px.col(j) = undistort(camera, step.aligned.raw_px.col(j));
  for (int j = 0; j < step.before_px.cols(); ++j) {
    if (!step.is_seen(j)) continue;
    const Warp start =
        shaped(camera, step.anchors.warps[j], undistorted_px, step.anchors.neighborhoods[j]);
    const PatchTemplate& patch = step.anchors.patches[j];
    step.take(j, search(step.image, patch, start, MotionModel::shift, step.options.search));
  }
}

void lose_sliding_edges(Step& step) {
  const SearchOptions& options = step.options.search;
  for (int j = 0; j < step.before_px.cols(); ++j) {
    if (!step.is_seen(j) || !(step.anchors.patches[j].edge < options.edge)) continue;
    const auto detail =
        detail_along_edge(step.image, step.anchors.patches[j], step.anchors.warps[j]);
    if (detail && !(*detail >= options.least_detail))
      step.take(j,
                {.end = TrackEnd{.reason = LossReason::low_correlation,
                                 .value = *detail,
                                 .limit = options.least_detail}});
  }
}

/// Returns the pixel at a place, or one whose patch is outside if it is far away or unknown.
cv::Point pixel_at(const Vector2d& middle, const cv::Mat& image) {
  const Vector2d size(image.cols, image.rows);
  const bool near = (middle.array() >= -kHalfPatch_px).all() &&
                    (middle.array() < (size.array() + kHalfPatch_px)).all();
  if (!near) return {-kHalfPatch_px - 1, -kHalfPatch_px - 1};
  return {static_cast<int>(middle.x()), static_cast<int>(middle.y())};
}

}  // namespace

AnchorOptions anchor_options(const Camera& camera) {
  AnchorOptions options;
  options.search.farthest_px *= patch_unit(camera);
  return options;
}

Anchors make_anchors(const cv::Mat& image, const Matrix2Xd& raw_px, const Camera& camera) {
  Anchors anchors{.camera = camera,
                  .patches = {},
                  .corners_px = raw_px,
                  .neighborhoods = make_neighborhoods(camera, raw_px),
                  .warps = {},
                  .periods_px = {}};
  for (Eigen::Index j = 0; j < raw_px.cols(); ++j) {
    const Vector2d middle = raw_px.col(j).array().round();
    anchors.patches.push_back(
        make_patch_template(make_patch(image, pixel_at(middle, image), kHalfPatch_px)));
    anchors.corners_px.col(j) -= middle;
    anchors.warps.push_back({middle});
  }
  return anchors;
}

FollowedTracks align_tracks(Anchors& anchors,
                            const cv::Mat& image,
                            const Matrix2Xd& before_px,
                            const Matrix2Xd& flow_px,
                            const AnchorOptions& options) {
  Step step{.anchors = anchors, .image = image, .before_px = before_px, .options = options};
  for (int j = 0; j < before_px.cols(); ++j)
    if (step.was_seen(j)) step.take(j, search_from(step, j, flow_px.col(j)));
  follow_neighbors(step);
  take_shape(step);
  lose_sliding_edges(step);
  return std::move(step.aligned);
}

}  // namespace gpo
