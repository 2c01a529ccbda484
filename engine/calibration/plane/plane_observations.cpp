// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/plane_lens.h"
#include "engine/geometry/decompositions.h"
#include "engine/geometry/homography.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kUnplaced = std::numeric_limits<double>::quiet_NaN();
constexpr int kLeastCommon = 8;    // placed points of a view
constexpr double kBadHalf = 0.01;  // badness of a view that counts half of the maximum
constexpr int kRings = 14;         // rings of normals, from the axis to 84 degrees
constexpr double kRing_rad = 6 * std::numbers::pi / 180;
constexpr double kLeastSlope = 0.02;  // sine of the angle between ray and plane
constexpr double kMostBehind = 0.03;  // share of the points
constexpr double kApart_rad = 0.25;   // angle between two guesses of a normal, at least

Matrix2Xd undistorted_from_center(const PlaneView& view, const Camera& camera) {
  Matrix2Xd points(2, view.raw_px.cols());
  const Vector2d middle(camera.cx, camera.cy);
  for (Eigen::Index k = 0; k < points.cols(); ++k)
    points.col(k) = undistort(camera, view.raw_px.col(k)) - middle;
  return points;
}

std::vector<int> placed(const PlaneView& view, const Matrix2Xd& seen, const Matrix2Xd& points) {
  std::vector<int> columns;
  for (int k = 0; k < static_cast<int>(view.points.size()); ++k)
    if (points.col(view.points[k]).allFinite() && seen.col(k).allFinite()) columns.push_back(k);
  return columns;
}

std::optional<Matrix3d> homography_to(const PlaneView& view,
                                      const Matrix2Xd& seen,
                                      const Matrix2Xd& points) {
  constexpr int kRounds = 3;
  constexpr double kMostMedians = 3;
  std::vector<int> columns = placed(view, seen, points);
  std::optional<Matrix3d> H;
  for (int round = 0; round < kRounds && std::ssize(columns) >= kLeastCommon; ++round) {
    std::vector<int> numbers;
    for (const int k : columns) numbers.push_back(view.points[k]);
    const Matrix2Xd from = points(Eigen::all, numbers);
    const Matrix2Xd to = seen(Eigen::all, columns);
    H = fit_homography(from, to);
    if (!H) return std::nullopt;
    std::vector<double> errors;
    for (Eigen::Index k = 0; k < from.cols(); ++k)
      errors.push_back((transfer(*H, from.col(k)) - to.col(k)).norm());
    const double most = kMostMedians * median(errors);
    std::vector<int> near;
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (errors[k] <= most) near.push_back(columns[k]);
    columns = std::move(near);
  }
  return H;
}

/// Places the other points of a view, unless they are behind the mosaic's image or far outside.
void place_points(const PlaneView& view,
                  const Matrix2Xd& seen,
                  const Matrix3d& H,
                  double farthest_px,
                  Matrix2Xd& points) {
  const Matrix3d back = H.inverse();
  // The sign that most placed points have is in front.
  double sign = 0;
  for (const int k : placed(view, seen, points))
    sign += back.row(2).dot(seen.col(k).homogeneous()) > 0 ? 1 : -1;
  for (std::size_t k = 0; k < view.points.size(); ++k) {
    auto point = points.col(view.points[k]);
    if (point.allFinite() || !seen.col(static_cast<Eigen::Index>(k)).allFinite()) continue;
    const Vector3d there = back * seen.col(static_cast<Eigen::Index>(k)).homogeneous();
    if (there.z() * sign > 0 && there.hnormalized().norm() <= farthest_px)
      point = there.hnormalized();
  }
}

/// 0 if the first two columns of a homography from a plane are orthogonal and equally long.
double badness(const Vector3d& a, const Vector3d& b) {
  const double dot = a.dot(b);
  const double aa = a.squaredNorm();
  const double bb = b.squaredNorm();
  return (4 * dot * dot + (aa - bb) * (aa - bb)) / ((aa + bb) * (aa + bb));
}

/// Right-handed axes: two in the plane, and z towards it. The normal points to the camera.
Matrix3d plane_frame(const Vector3d& normal) {
  Matrix3d R;
  const Vector3d z = -normal;
  R.col(0) = Vector3d::UnitY().cross(z).normalized();
  R.col(1) = z.cross(R.col(0));
  R.col(2) = z;
  return R;
}

Matrix3d scaled_by(const Matrix3d& H, double focal_px) {
  const Vector3d K(focal_px, focal_px, 1);
  return K.cwiseInverse().asDiagonal() * H * K.asDiagonal();
}

Eigen::Matrix<double, 6, 1> pose_of(Matrix3d H, const Vector2d& seen_point) {
  if (H.row(2).dot(seen_point.homogeneous()) < 0) H = -H;
  const double scale = 0.5 * (H.col(0).norm() + H.col(1).norm());
  H /= scale;
  Matrix3d M;
  M << H.col(0), H.col(1), H.col(0).cross(H.col(1));
  Eigen::Matrix<double, 6, 1> pose;
  pose << so3_log(nearest_rotation(M)), H.col(2);
  return pose;
}

constexpr int kLeastViewsOfPoint = 3;
constexpr int kLeastPoints = 8;             // in a view
constexpr int kFewViews = 16;               // per plane, to compare starts
constexpr int kFewPoints = 70;              // the same
constexpr double kMostViewMedian = 3;       // relative to the median of all views
constexpr double kMedianOfNormal = 0.6745;  // median absolute value of a standard normal variable

PlaneView part_of(const PlaneView& view, const auto& is_kept) {
  std::vector<int> columns, points;
  for (int k = 0; k < static_cast<int>(view.points.size()); ++k) {
    if (!is_kept(k)) continue;
    columns.push_back(k);
    points.push_back(view.points[k]);
  }
  return {view.frame,
          std::move(points),
          view.raw_px(Eigen::all, columns),
          view.flow_px(Eigen::all, columns)};
}

void clean(ObservedPlane& plane) {
  for (bool changed = true; changed;) {
    changed = false;
    const std::vector<int> counts = views_of_points(plane);
    for (PlaneView& view : plane.views) {
      const std::size_t before = view.points.size();
      view = part_of(view, [&](int k) { return counts[view.points[k]] >= kLeastViewsOfPoint; });
      if (std::ssize(view.points) < kLeastPoints) view = {view.frame, {}, Eigen::Matrix2Xd(2, 0)};
      changed |= view.points.size() != before;
    }
  }
}

double median_of(const Eigen::VectorXd& errors) {
  return errors.size() == 0 ? 0 : median({errors.begin(), errors.end()});
}

}  // namespace

PlaneMosaic plane_mosaic(const ObservedPlane& plane, const Camera& camera) {
  const auto count = std::ssize(plane.views);
  PlaneMosaic mosaic{Matrix2Xd::Constant(2, plane.points, kUnplaced),
                     std::vector<Matrix3d>(count, Matrix3d::Constant(kUnplaced))};
  std::vector<Matrix2Xd> seen;
  std::vector<int> left;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    seen.push_back(undistorted_from_center(plane.views[i], camera));
    left.push_back(static_cast<int>(i));
  }
  if (left.empty()) return mosaic;
  const auto size = [&](int i) { return plane.views[i].points.size(); };
  int next = *std::ranges::max_element(left, {}, size);
  mosaic.points(Eigen::all, plane.views[next].points) = seen[next];
  mosaic.H_i_m[next].setIdentity();
  const double farthest_px = 6.0 * camera.width;
  const auto common = [&](int i) { return placed(plane.views[i], seen[i], mosaic.points).size(); };
  std::erase(left, next);
  while (!left.empty()) {
    next = *std::ranges::max_element(left, {}, common);
    std::erase(left, next);
    const auto H = homography_to(plane.views[next], seen[next], mosaic.points);
    if (!H) continue;
    mosaic.H_i_m[next] = *H;
    place_points(plane.views[next], seen[next], *H, farthest_px, mosaic.points);
  }
  return mosaic;
}

std::vector<Vector3d> likely_normals(const PlaneMosaic& mosaic, double focal_px, int most) {
  std::vector<Matrix3d> homographies;
  for (const Matrix3d& H : mosaic.H_i_m)
    if (H.allFinite()) homographies.push_back(scaled_by(H, focal_px));
  std::vector<std::pair<double, Vector3d>> all;
  for (int ring = 0; ring <= kRings; ++ring) {
    const double slant = ring * kRing_rad;
    const int around =
        std::max(1, static_cast<int>(2 * std::numbers::pi * std::sin(slant) / kRing_rad));
    for (int k = 0; k < around; ++k) {
      const double azimuth = 2 * std::numbers::pi * k / around;
      const Vector3d normal(std::sin(slant) * std::cos(azimuth),
                            std::sin(slant) * std::sin(azimuth),
                            -std::cos(slant));
      const Matrix3d frame = plane_frame(normal);
      double sum = 0;
      for (const Matrix3d& H : homographies) {
        const double bad = badness(H * frame.col(0), H * frame.col(1));
        sum += bad / (bad + kBadHalf) / static_cast<double>(homographies.size());
      }
      all.emplace_back(sum, normal);
    }
  }
  std::ranges::sort(all, {}, &std::pair<double, Vector3d>::first);
  std::vector<Vector3d> best;
  for (const auto& [sum, normal] : all) {
    if (std::ssize(best) == most) break;
    if (std::ranges::all_of(best, [&normal = normal](const Vector3d& other) {
          return radians(angle_deg(normal, other)) >= kApart_rad;
        }))
      best.push_back(normal);
  }
  return best;
}

std::optional<AdjustedPlane> start_of(const PlaneMosaic& mosaic,
                                      double focal_px,
                                      const Vector3d& normal) {
  const Matrix3d frame = plane_frame(normal);
  AdjustedPlane plane{Eigen::Matrix3Xd::Zero(3, mosaic.points.cols()), {}};
  Vector2d one = Vector2d::Constant(kUnplaced);
  int behind = 0;
  for (Eigen::Index j = 0; j < mosaic.points.cols(); ++j) {
    if (!mosaic.points.col(j).allFinite()) continue;
    const Vector3d ray =
        mosaic.points.col(j).homogeneous().cwiseProduct(Vector3d(1 / focal_px, 1 / focal_px, 1));
    const double slope = -normal.dot(ray);
    behind += slope < kLeastSlope ? 1 : 0;
    const Vector2d place = (frame.transpose() * ray / std::max(slope, kLeastSlope)).head<2>();
    plane.points.col(j).head<2>() = place;
    if (!one.allFinite() || place.norm() < one.norm()) one = place;
  }
  if (behind > kMostBehind * static_cast<double>(mosaic.points.cols())) return std::nullopt;
  for (const Matrix3d& H : mosaic.H_i_m)
    plane.poses.push_back(H.allFinite() ? pose_of(scaled_by(H, focal_px) * frame, one)
                                        : Eigen::Matrix<double, 6, 1>::Zero());
  return plane;
}

std::vector<ObservedPlane> cleaned(std::vector<ObservedPlane> planes) {
  for (ObservedPlane& plane : planes) clean(plane);
  std::erase_if(planes,
                [](const ObservedPlane& plane) { return counts_of({plane}).observations == 0; });
  return planes;
}

std::vector<ObservedPlane> filtered(
    std::vector<ObservedPlane> planes,
    const std::function<bool(std::size_t, std::size_t, int)>& is_kept) {
  for (std::size_t p = 0; p < planes.size(); ++p) {
    for (std::size_t i = 0; i < planes[p].views.size(); ++i)
      planes[p].views[i] = part_of(planes[p].views[i], [&](int k) { return is_kept(p, i, k); });
    clean(planes[p]);
  }
  return planes;
}

std::vector<ObservedPlane> thinned(const std::vector<ObservedPlane>& planes) {
  std::vector<ObservedPlane> few = planes;
  std::vector<std::vector<bool>> chosen;  // points of each plane
  for (ObservedPlane& plane : few) {
    std::erase_if(plane.views, [](const PlaneView& view) { return view.points.empty(); });
    plane.views = spread(plane.views, kFewViews);
    const std::vector<int> counts = views_of_points(plane);
    std::vector<int> often;
    for (int j = 0; j < plane.points; ++j)
      if (counts[j] >= kLeastViewsOfPoint) often.push_back(j);
    const std::size_t step = std::max<std::size_t>(1, often.size() / kFewPoints);
    chosen.emplace_back(plane.points, false);
    for (std::size_t k = 0; k < often.size(); k += step) chosen.back()[often[k]] = true;
  }
  return cleaned(filtered(few, [&](std::size_t p, std::size_t i, int k) {
    return chosen[p][few[p].views[i].points[k]];
  }));
}

std::vector<ObservedPlane> without_far(const std::vector<ObservedPlane>& planes,
                                       const ViewErrors& errors,
                                       double most_px,
                                       std::vector<int>& left_out) {
  std::vector<double> medians;
  for (const auto& views : errors)
    for (const Eigen::VectorXd& view : views)
      if (view.size() > 0) medians.push_back(median_of(view));
  if (medians.empty()) return planes;
  const double most_median_px = kMostViewMedian * median(medians);
  std::set<std::pair<std::size_t, std::size_t>> far;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    for (std::size_t i = 0; i < planes[p].views.size(); ++i) {
      if (median_of(errors[p][i]) <= most_median_px) continue;
      left_out.push_back(planes[p].views[i].frame);
      far.emplace(p, i);
    }
  }
  return filtered(planes, [&](std::size_t p, std::size_t i, int k) {
    return !far.contains({p, i}) && errors[p][i][k] <= most_px;
  });
}

std::vector<double> finite(const ViewErrors& errors) {
  std::vector<double> all;
  for (const auto& views : errors)
    for (const Eigen::VectorXd& view : views)
      std::ranges::copy_if(
          view, std::back_inserter(all), [](double e) { return std::isfinite(e); });
  return all;
}

double noise_of(const ViewErrors& errors) {
  const std::vector<double> all = finite(errors);
  return all.empty() ? 1 : median(all) / kMedianOfRayleigh;
}

double height_of(const std::vector<ObservedPlane>& planes, const Adjustment& adjustment) {
  std::vector<double> heights;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const std::vector<int> counts = views_of_points(planes[p]);
    for (int j = 0; j < planes[p].points; ++j)
      if (counts[j] > 0) heights.push_back(std::abs(adjustment.planes[p].points(2, j)));
  }
  return heights.empty() ? 0 : median(heights) / kMedianOfNormal;
}

std::vector<int> views_of_points(const ObservedPlane& plane) {
  std::vector<int> counts(plane.points, 0);
  for (const PlaneView& view : plane.views)
    for (const int j : view.points) ++counts[j];
  return counts;
}

PlaneCounts counts_of(const std::vector<ObservedPlane>& planes) {
  PlaneCounts counts;
  for (const ObservedPlane& plane : planes) {
    for (const PlaneView& view : plane.views) {
      counts.observations += static_cast<int>(view.points.size());
      counts.views += view.points.empty() ? 0 : 1;
    }
    for (const int views : views_of_points(plane)) counts.points += views > 0 ? 1 : 0;
  }
  return counts;
}

}  // namespace gpo
