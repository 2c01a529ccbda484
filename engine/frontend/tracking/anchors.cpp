// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/tracker.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kNeighbors = 60;    // nearest to a track in the reference frame
constexpr double kStart = 3;      // error by the template's own shape of weight 1/4 [patch_unit]
constexpr double kAgreement = 1;  // the same by the shape fitted to neighbors
constexpr int kRounds = 3;        // rounds of reweighting
constexpr double kMiddleWeight = 100;  // weight of the template's middle; that of a corner is 1
constexpr double kUnit_px = 100;       // scales the monomials
constexpr std::array kCorners{0, 2, 6, 8};  // node indices

Vector2d node(int k, int half) { return {half * (k % 3 - 1), half * (k / 3 - 1)}; }

/// Homography that keeps d = 0 finite (15b): (1 + v.d) p = A d + c.
struct LocalHomography {
  Eigen::Matrix<double, 2, 3> affine = Eigen::Matrix<double, 2, 3>::Zero();  ///< (A c)
  Vector2d v = Vector2d::Zero();
  Vector2d operator()(const Vector2d& d) const { return affine * d.homogeneous() / (1 + v.dot(d)); }
};

using Monomials = Eigen::Matrix<double, 6, 1>;

Monomials monomials(const Vector2d& d) {
  return (Monomials() << 1, d.x(), d.y(), d.x() * d.x(), d.x() * d.y(), d.y() * d.y()).finished();
}

/// Weighted sums of the monomials of d times 1, p_x, p_y, |p|^2.
using Moments = Eigen::Matrix<double, 6, 4>;

/// Returns the sums of (dx, dy, 1) (dx, dy, 1)^T times the factor of the column.
Matrix3d outer(const Moments& moments, int column) {
  const auto m = moments.col(column);
  Matrix3d sum;
  sum << m(3), m(4), m(1), m(4), m(5), m(2), m(1), m(2), m(0);
  return sum;
}

/// Solves (15b) by least squares; v by the Schur complement of `affine`.
LocalHomography fitted(const Moments& moments) {
  const Matrix3d inverse = outer(moments, 0).inverse();
  const Matrix3d X = outer(moments, 1);
  const Matrix3d Y = outer(moments, 2);
  const Matrix3d P = outer(moments, 3);
  const auto Xd = X.leftCols<2>();
  const auto Yd = Y.leftCols<2>();
  const Vector3d x = inverse * X.col(2);
  const Vector3d y = inverse * Y.col(2);
  const Matrix2d schur =
      P.topLeftCorner<2, 2>() - Xd.transpose() * inverse * Xd - Yd.transpose() * inverse * Yd;
  const Vector2d right = Xd.transpose() * x + Yd.transpose() * y - P.col(2).head<2>();
  LocalHomography H;
  H.v = schur.inverse() * right;
  H.affine << (x + inverse * Xd * H.v).transpose(), (y + inverse * Yd * H.v).transpose();
  return H;
}

struct Places {
  Eigen::ArrayXd x, y;  ///< neighbors, from the template's middle; 0 if not seen [100 px]
  Eigen::ArrayXd seen;  ///< 1 or 0
};

Places places_of(const std::vector<int>& neighbors,
                 const Matrix2Xd& undistorted_px,
                 const Vector2d& origin) {
  const auto count = std::ssize(neighbors);
  Places places{Eigen::ArrayXd(count), Eigen::ArrayXd(count), Eigen::ArrayXd(count)};
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    const Vector2d p = (undistorted_px.col(neighbors[k]) - origin) / kUnit_px;
    const bool seen = p.allFinite();
    places.seen[k] = seen ? 1 : 0;
    places.x[k] = seen ? p.x() : 0;
    places.y[k] = seen ? p.y() : 0;
  }
  return places;
}

Eigen::ArrayXd weights(const LocalHomography& H,
                       const Neighborhood& around,
                       const Places& places,
                       double agreement_px) {
  const auto dx = around.monomials.row(1).transpose().array();
  const auto dy = around.monomials.row(2).transpose().array();
  const auto& A = H.affine;
  const double squares = (kUnit_px / agreement_px) * (kUnit_px / agreement_px);
  const Eigen::ArrayXd inverse = (1 + H.v.x() * dx + H.v.y() * dy).inverse();
  const Eigen::ArrayXd x = (A(0, 0) * dx + A(0, 1) * dy + A(0, 2)) * inverse - places.x;
  const Eigen::ArrayXd y = (A(1, 0) * dx + A(1, 1) * dy + A(1, 2)) * inverse - places.y;
  return places.seen * (1 + squares * (x.square() + y.square())).inverse().square();
}

Moments moments_of(const Neighborhood& around,
                   const Places& places,
                   const Eigen::ArrayXd& weights) {
  Eigen::Matrix<double, Eigen::Dynamic, 4> factors(weights.size(), 4);
  factors.col(0) = weights;
  factors.col(1) = weights * places.x;
  factors.col(2) = weights * places.y;
  factors.col(3) = weights * (places.x.square() + places.y.square());
  return around.monomials.lazyProduct(factors);
}

Warp through(const Nodes& nodes_px, const Vector2d& center_px, int half) {
  const auto n = [&](int k) { return nodes_px.col(k); };
  const double h = half;
  Warp warp{center_px};
  warp.linear << (n(5) - n(3)) / (2 * h), (n(7) - n(1)) / (2 * h);
  warp.quadratic << (n(5) + n(3) - 2 * n(4)) / (2 * h * h),
      (n(8) - n(6) - n(2) + n(0)) / (4 * h * h), (n(7) + n(1) - 2 * n(4)) / (2 * h * h);
  return warp;
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Step {
  Anchors& anchors;
  const cv::Mat& image;
  const Matrix2Xd& before_px;
  const AnchorOptions& options;
  AlignedTracks aligned{Matrix2Xd::Constant(2, before_px.cols(), kNaN),
                        std::vector<std::optional<TrackEnd>>(before_px.cols())};

  bool was_seen(int j) const { return before_px.col(j).allFinite(); }
  bool is_seen(int j) const { return aligned.raw_px.col(j).allFinite(); }
  Vector2d motion_px(int j) const { return aligned.raw_px.col(j) - before_px.col(j); }

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
  Warp start = step.anchors.warps[j];
  start.center += motion_px;
  const Found found = search(step.image, patch, start, MotionModel::affine, step.options.search);
  // An occluder of a part of the template may distort an affine alignment: then only shift it.
  return found.end ? search(step.image, patch, start, MotionModel::shift, step.options.search)
                   : found;
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
  const double most = step.options.search.farthest_px * step.options.search.farthest_px;
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
  const double limit = std::max(step.options.search.farthest_px,
                                step.options.most_unlike * median_motion(around).norm());
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
    const Warp start = shaped(camera,
                              step.anchors.warps[j],
                              undistorted_px,
                              step.options.half_patch_px,
                              step.anchors.neighborhoods[j]);
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
cv::Point pixel_at(const Vector2d& middle, const cv::Mat& image, int half) {
  const Vector2d size(image.cols, image.rows);
  const bool near =
      (middle.array() >= -half).all() && (middle.array() < (size.array() + half)).all();
  if (!near) return {-half - 1, -half - 1};
  return {static_cast<int>(middle.x()), static_cast<int>(middle.y())};
}

}  // namespace

std::vector<Neighborhood> make_neighborhoods(const Camera& camera,
                                             const Matrix2Xd& raw_px,
                                             int half) {
  Matrix2Xd undistorted_px(2, raw_px.cols());
  std::vector<int> known;
  for (int j = 0; j < raw_px.cols(); ++j) {
    undistorted_px.col(j) = undistort(camera, raw_px.col(j));
    if (undistorted_px.col(j).allFinite()) known.push_back(j);
  }
  std::vector<Neighborhood> all(raw_px.cols());
  for (int j = 0; j < raw_px.cols(); ++j) {
    const Vector2d middle = raw_px.col(j).array().round();
    const Vector2d origin = undistort(camera, middle);
    const auto distance = [&](int k) { return (undistorted_px.col(k) - origin).squaredNorm(); };
    std::vector<int> near = known;
    std::erase(near, j);
    const auto count = std::min<std::ptrdiff_t>(kNeighbors, std::ssize(near));
    std::ranges::partial_sort(near, near.begin() + count, {}, distance);
    near.resize(count);
    Neighborhood& around = all[j];
    around.monomials.resize(6, count);
    for (std::ptrdiff_t k = 0; k < count; ++k)
      around.monomials.col(k) = monomials((undistorted_px.col(near[k]) - origin) / kUnit_px);
    around.neighbors = std::move(near);
    around.nodes_px = patch_nodes(camera, middle, half).colwise() - origin;
  }
  return all;
}

Nodes patch_nodes(const Camera& camera, const Vector2d& middle_px, int half) {
  Nodes nodes;
  for (int k = 0; k < 9; ++k) nodes.col(k) = undistort(camera, middle_px + node(k, half));
  return nodes;
}

std::optional<Warp> warp_by(const Camera& camera,
                            const Matrix3d& H,
                            const Nodes& nodes_px,
                            int half) {
  Nodes there;
  const double sign = H.row(2).dot(nodes_px.col(4).homogeneous());
  for (int k = 0; k < 9; ++k) {
    const Vector3d p = H * nodes_px.col(k).homogeneous();
    if (!(p.z() * sign > 0)) return std::nullopt;
    there.col(k) = distort(camera, p.hnormalized());
  }
  if (!there.allFinite()) return std::nullopt;
  const Warp warp = through(there, there.col(4), half);
  return warp.linear.determinant() > 0 ? std::optional(warp) : std::nullopt;
}

Warp shaped(const Camera& camera,
            const Warp& warp,
            const Matrix2Xd& undistorted_px,
            int half,
            const Neighborhood& around) {
  const Vector2d origin = undistort(camera, warp.center);
  // The template's middle has a large weight, or neighbors on another surface would outvote it.
  Moments own = Moments::Zero();
  own(0, 0) = kMiddleWeight;
  for (const int k : kCorners) {
    const Vector2d p = (undistort(camera, warp(node(k, half))) - origin) / kUnit_px;
    own += monomials(around.nodes_px.col(k) / kUnit_px) *
           Eigen::RowVector4d(1, p.x(), p.y(), p.squaredNorm());
  }
  const Places places = places_of(around.neighbors, undistorted_px, origin);
  LocalHomography H = fitted(own);
  for (int round = 0; round < kRounds; ++round) {
    const double agreement_px = (round == 0 ? kStart : kAgreement) * patch_unit(camera);
    H = fitted(own + moments_of(around, places, weights(H, around, places, agreement_px)));
  }
  Nodes nodes;
  for (int k = 0; k < 9; ++k)
    nodes.col(k) = distort(camera, origin + kUnit_px * H(around.nodes_px.col(k) / kUnit_px));
  return nodes.allFinite() ? through(nodes, warp.center, half) : warp;
}

double patch_unit(const Camera& camera) { return std::max(1.0, pixel_unit(camera)); }

AnchorOptions anchor_options(const Camera& camera) {
  AnchorOptions options;
  options.search.farthest_px *= patch_unit(camera);
  return options;
}

Anchors make_anchors(const cv::Mat& image,
                     const Matrix2Xd& raw_px,
                     const Camera& camera,
                     const AnchorOptions& options) {
  const int half = options.half_patch_px;
  Anchors anchors{.camera = camera,
                  .patches = {},
                  .corners_px = raw_px,
                  .neighborhoods = make_neighborhoods(camera, raw_px, half),
                  .warps = {}};
  for (Eigen::Index j = 0; j < raw_px.cols(); ++j) {
    const Vector2d middle = raw_px.col(j).array().round();
    anchors.patches.push_back(
        make_patch_template(make_patch(image, pixel_at(middle, image, half), half)));
    anchors.corners_px.col(j) -= middle;
    anchors.warps.push_back({middle});
  }
  return anchors;
}

AlignedTracks align_tracks(Anchors& anchors,
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
