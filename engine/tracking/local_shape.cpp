// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/processor.h"
#include "engine/tracking/tracker.h"

#include <algorithm>
#include <array>
#include <cstring>

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

Vector2d node(int k) { return {kHalfPatch_px * (k % 3 - 1), kHalfPatch_px * (k / 3 - 1)}; }

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

// Four numbers: one register of AVX2, two of the baseline. One long body, as in plane_kernel.cpp.
using Doubles = double __attribute__((vector_size(32)));
constexpr std::size_t kAtOnce = 4;  // neighbors

/// Places of neighbors from the template's middle, padded to whole vectors.
struct Places {
  std::vector<double> x, y;  ///< 0 if not seen [100 px]
  std::vector<double> seen;  ///< 1 or 0
};

Places places_of(const Neighborhood& around,
                 const Matrix2Xd& undistorted_px,
                 const Vector2d& origin) {
  const std::size_t padded = around.dx.size();
  Places places{
      std::vector<double>(padded), std::vector<double>(padded), std::vector<double>(padded)};
  for (std::size_t k = 0; k < around.neighbors.size(); ++k) {
    const Vector2d p = (undistorted_px.col(around.neighbors[k]) - origin) / kUnit_px;
    if (!p.allFinite()) continue;
    places.seen[k] = 1;
    places.x[k] = p.x();
    places.y[k] = p.y();
  }
  return places;
}

/// Adds the moments of neighbors weighted by their agreement with a homography (Geman and
/// McClure).
[[gnu::always_inline]] inline void add_moments(const LocalHomography& H,
                                               const Neighborhood& around,
                                               const Places& places,
                                               double agreement_px,
                                               Moments& moments) {
  const auto& A = H.affine;
  const double squares = (kUnit_px / agreement_px) * (kUnit_px / agreement_px);
  Doubles sum[24] = {};
  for (std::size_t k = 0; k < around.dx.size(); k += kAtOnce) {
    Doubles dx, dy, x, y, seen;
    std::memcpy(&dx, &around.dx[k], sizeof(Doubles));
    std::memcpy(&dy, &around.dy[k], sizeof(Doubles));
    std::memcpy(&x, &places.x[k], sizeof(Doubles));
    std::memcpy(&y, &places.y[k], sizeof(Doubles));
    std::memcpy(&seen, &places.seen[k], sizeof(Doubles));
    const Doubles inverse = 1 / (1 + H.v.x() * dx + H.v.y() * dy);
    const Doubles off_x = (A(0, 0) * dx + A(0, 1) * dy + A(0, 2)) * inverse - x;
    const Doubles off_y = (A(1, 0) * dx + A(1, 1) * dy + A(1, 2)) * inverse - y;
    const Doubles excess = 1 + squares * (off_x * off_x + off_y * off_y);
    const Doubles weight = seen / (excess * excess);
    const Doubles factors[4] = {weight, weight * x, weight * y, weight * (x * x + y * y)};
    const Doubles products[6] = {Doubles{} + 1, dx, dy, dx * dx, dx * dy, dy * dy};
#pragma GCC unroll 4
    for (int column = 0; column < 4; ++column)
#pragma GCC unroll 6
      for (int row = 0; row < 6; ++row) sum[6 * column + row] += factors[column] * products[row];
  }
  for (int i = 0; i < 24; ++i)
    moments(i % 6, i / 6) += (sum[i][0] + sum[i][1]) + (sum[i][2] + sum[i][3]);
}

GPO_AVX2_FMA void add_moments_avx2_fma(const LocalHomography& H,
                                       const Neighborhood& around,
                                       const Places& places,
                                       double agreement_px,
                                       Moments& moments) {
  add_moments(H, around, places, agreement_px, moments);
}

Warp through(const Nodes& nodes_px, const Vector2d& center_px) {
  const auto n = [&](int k) { return nodes_px.col(k); };
  constexpr double h = kHalfPatch_px;
  Warp warp{center_px};
  warp.linear << (n(5) - n(3)) / (2 * h), (n(7) - n(1)) / (2 * h);
  warp.quadratic << (n(5) + n(3) - 2 * n(4)) / (2 * h * h),
      (n(8) - n(6) - n(2) + n(0)) / (4 * h * h), (n(7) + n(1) - 2 * n(4)) / (2 * h * h);
  return warp;
}

}  // namespace

std::vector<Neighborhood> make_neighborhoods(const Camera& camera, const Matrix2Xd& raw_px) {
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
    around.dx.resize((count + kAtOnce - 1) / kAtOnce * kAtOnce);
    around.dy.resize(around.dx.size());
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      around.dx[k] = (undistorted_px(0, near[k]) - origin.x()) / kUnit_px;
      around.dy[k] = (undistorted_px(1, near[k]) - origin.y()) / kUnit_px;
    }
    around.neighbors = std::move(near);
    around.nodes_px = patch_nodes(camera, middle).colwise() - origin;
  }
  return all;
}

Nodes patch_nodes(const Camera& camera, const Vector2d& middle_px) {
  Nodes nodes;
  for (int k = 0; k < 9; ++k) nodes.col(k) = undistort(camera, middle_px + node(k));
  return nodes;
}

std::optional<Warp> warp_by(const Camera& camera, const Matrix3d& H, const Nodes& nodes_px) {
  Nodes there;
  const double sign = H.row(2).dot(nodes_px.col(4).homogeneous());
  for (int k = 0; k < 9; ++k) {
    const Vector3d p = H * nodes_px.col(k).homogeneous();
    if (!(p.z() * sign > 0)) return std::nullopt;
    there.col(k) = distort(camera, p.hnormalized());
  }
  if (!there.allFinite()) return std::nullopt;
  const Warp warp = through(there, there.col(4));
  return warp.linear.determinant() > 0 ? std::optional(warp) : std::nullopt;
}

Warp shaped(const Camera& camera,
            const Warp& warp,
            const Matrix2Xd& undistorted_px,
            const Neighborhood& around) {
  const Vector2d origin = undistort(camera, warp.center);
  // The template's middle has a large weight, or neighbors on another surface would outvote it.
  Moments own = Moments::Zero();
  own(0, 0) = kMiddleWeight;
  for (const int k : kCorners) {
    const Vector2d p = (undistort(camera, warp(node(k))) - origin) / kUnit_px;
    own += monomials(around.nodes_px.col(k) / kUnit_px) *
           Eigen::RowVector4d(1, p.x(), p.y(), p.squaredNorm());
  }
  const Places places = places_of(around, undistorted_px, origin);
  LocalHomography H = fitted(own);
  for (int round = 0; round < kRounds; ++round) {
    const double agreement_px = (round == 0 ? kStart : kAgreement) * patch_unit(camera);
    Moments moments = own;
    if (has_avx2_fma())
      add_moments_avx2_fma(H, around, places, agreement_px, moments);
    else
      add_moments(H, around, places, agreement_px, moments);
    H = fitted(moments);
  }
  Nodes nodes;
  for (int k = 0; k < 9; ++k)
    nodes.col(k) = distort(camera, origin + kUnit_px * H(around.nodes_px.col(k) / kUnit_px));
  return nodes.allFinite() ? through(nodes, warp.center) : warp;
}

double patch_unit(const Camera& camera) { return std::max(1.0, pixel_unit(camera)); }

}  // namespace gpo
