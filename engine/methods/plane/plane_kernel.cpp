// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_kernel.h"

#include "engine/base/processor.h"

#include <cstring>

namespace gpo {
namespace {

void resize(FrameObservations& f, std::size_t size) {
  for (auto* array : {&f.ray_x, &f.ray_y, &f.u, &f.v, &f.mask}) array->resize(size);
}

/// Pads to whole vectors with copies of the first inlier of weight zero.
void pad(FrameObservations& f) {
  const std::size_t size = (f.count + kKernelWidth - 1) / kKernelWidth * kKernelWidth;
  resize(f, f.count);
  for (auto* array : {&f.ray_x, &f.ray_y, &f.u, &f.v})
    array->resize(size, array->empty() ? 0 : array->front());
  f.mask.resize(size, 0);
}

FrameObservations gathered(const Window& window, int frame, const std::vector<bool>& inlier) {
  FrameObservations f;
  if (frame == 0) return f;
  const Eigen::Matrix3d& K = window.K;
  const Eigen::Matrix2Xd& from = window.points_px[0];
  const Eigen::Matrix2Xd& to = window.points_px[frame];
  const double to_x = 1 / K(0, 0);
  const double to_y = 1 / K(1, 1);
  resize(f, window.track_count() + kKernelWidth);
  for (int j = 0; j < window.track_count(); ++j) {
    if (!inlier[j]) continue;
    f.ray_x[f.count] = to_x * (from(0, j) - K(0, 2));
    f.ray_y[f.count] = to_y * (from(1, j) - K(1, 2));
    f.u[f.count] = to(0, j) - K(0, 2);
    f.v[f.count] = to(1, j) - K(1, 2);
    f.mask[f.count] = 1;
    f.track.push_back(j);
    ++f.count;
  }
  pad(f);
  return f;
}

// Four doubles: one register of AVX2, two of the baseline. The calling convention of functions that
// take or return them depends on the instruction set; hence one long body.
using Vector = double __attribute__((vector_size(32)));

/// Sums over the observations; n normal, p rotation, t translation, g gradient.
enum Sum : int {
  // clang-format off
  n00, n01, n11,
  t00, t11, t02, t12, t22,
  n0t0, n0t1, n0t2, n1t0, n1t1, n1t2,
  gn0, gn1, gt0, gt1, gt2, squares,
  p00, p01, p02, p11, p12, p22,
  n0p0, n0p1, n0p2, n1p0, n1p1, n1p2,
  p0t0, p0t1, p0t2, p1t0, p1t1, p1t2, p2t0, p2t1, p2t2,
  gp0, gp1, gp2,
  // clang-format on
  kSums
};
constexpr int kSumsWithoutRotation = p00;

struct Sums {
  double of[kSums] = {};
  double least_depth = 0;
};

/// With y = A x_1, A = R_cw - tau_c n^T, (x, y) = y / y_z and h = n.x_1:
///   dy = -tau_c (x_1.N u) + y x phi - h t,  dp = (f / y_z) (dy_xy - (x, y) dy_z).
/// The signs of u and t are flipped here and restored in `unpacked`.
template <bool kRotating>  // NOLINTNEXTLINE(readability-function-size): see `Vector`
[[gnu::always_inline]] inline void accumulate(const FrameObservations& f,
                                              const FrameState& s,
                                              Sums& sums) {
  const Eigen::Matrix3d A = s.R_cw - s.tau_c * s.normal.transpose();
  constexpr int kUsed = kRotating ? kSums : kSumsWithoutRotation;
  Vector sum[kUsed] = {};
  Vector least = {1e300, 1e300, 1e300, 1e300};
  for (std::size_t k = 0; k < f.u.size(); k += kKernelWidth) {
    Vector X, Y, U, V, w;
    std::memcpy(&X, &f.ray_x[k], sizeof(Vector));
    std::memcpy(&Y, &f.ray_y[k], sizeof(Vector));
    std::memcpy(&U, &f.u[k], sizeof(Vector));
    std::memcpy(&V, &f.v[k], sizeof(Vector));
    std::memcpy(&w, &f.mask[k], sizeof(Vector));
    const Vector depth = A(2, 0) * X + A(2, 1) * Y + A(2, 2);
    least = depth < least ? depth : least;
    const Vector inverse = 1.0 / depth;
    const Vector x = (A(0, 0) * X + A(0, 1) * Y + A(0, 2)) * inverse;
    const Vector y = (A(1, 0) * X + A(1, 1) * Y + A(1, 2)) * inverse;
    const Vector wfx = w * s.fx;
    const Vector wfy = w * s.fy;
    const Vector rx = wfx * x - w * U;
    const Vector ry = wfy * y - w * V;
    const Vector h = s.normal(0) * X + s.normal(1) * Y + s.normal(2);
    const Vector g0 = s.tangents(0, 0) * X + s.tangents(1, 0) * Y + s.tangents(2, 0);
    const Vector g1 = s.tangents(0, 1) * X + s.tangents(1, 1) * Y + s.tangents(2, 1);
    // The columns of t: (a, 0, -a x) and (0, b, -b y); those of u: (c, d) times g0 or g1.
    const Vector fx = wfx * inverse;
    const Vector fy = wfy * inverse;
    const Vector a = fx * h;
    const Vector b = fy * h;
    const Vector c = fx * (s.tau_c(0) - x * s.tau_c(2));
    const Vector d = fy * (s.tau_c(1) - y * s.tau_c(2));
    const Vector ax = a * x;
    const Vector by = b * y;
    const Vector ccdd = c * c + d * d;
    const Vector ca = c * a;
    const Vector db = d * b;
    const Vector ct2 = c * ax + d * by;
    const Vector cr = c * rx + d * ry;
    sum[n00] += ccdd * g0 * g0;
    sum[n01] += ccdd * g0 * g1;
    sum[n11] += ccdd * g1 * g1;
    sum[t00] += a * a;
    sum[t11] += b * b;
    sum[t02] -= a * ax;
    sum[t12] -= b * by;
    sum[t22] += ax * ax + by * by;
    sum[n0t0] += g0 * ca;
    sum[n0t1] += g0 * db;
    sum[n0t2] -= g0 * ct2;
    sum[n1t0] += g1 * ca;
    sum[n1t1] += g1 * db;
    sum[n1t2] -= g1 * ct2;
    sum[gn0] += g0 * cr;
    sum[gn1] += g1 * cr;
    sum[gt0] += a * rx;
    sum[gt1] += b * ry;
    sum[gt2] -= ax * rx + by * ry;
    sum[squares] += rx * rx + ry * ry;
    if constexpr (kRotating) {
      const Vector px0 = wfx * x * y;
      const Vector px1 = -wfx * (1.0 + x * x);
      const Vector px2 = wfx * y;
      const Vector py0 = wfy * (1.0 + y * y);
      const Vector py1 = -wfy * x * y;
      const Vector py2 = -wfy * x;
      const Vector cp0 = c * px0 + d * py0;
      const Vector cp1 = c * px1 + d * py1;
      const Vector cp2 = c * px2 + d * py2;
      sum[p00] += px0 * px0 + py0 * py0;
      sum[p01] += px0 * px1 + py0 * py1;
      sum[p02] += px0 * px2 + py0 * py2;
      sum[p11] += px1 * px1 + py1 * py1;
      sum[p12] += px1 * px2 + py1 * py2;
      sum[p22] += px2 * px2 + py2 * py2;
      sum[n0p0] += g0 * cp0;
      sum[n0p1] += g0 * cp1;
      sum[n0p2] += g0 * cp2;
      sum[n1p0] += g1 * cp0;
      sum[n1p1] += g1 * cp1;
      sum[n1p2] += g1 * cp2;
      sum[p0t0] += px0 * a;
      sum[p0t1] += py0 * b;
      sum[p0t2] -= px0 * ax + py0 * by;
      sum[p1t0] += px1 * a;
      sum[p1t1] += py1 * b;
      sum[p1t2] -= px1 * ax + py1 * by;
      sum[p2t0] += px2 * a;
      sum[p2t1] += py2 * b;
      sum[p2t2] -= px2 * ax + py2 * by;
      sum[gp0] += px0 * rx + py0 * ry;
      sum[gp1] += px1 * rx + py1 * ry;
      sum[gp2] += px2 * rx + py2 * ry;
    }
  }
  for (int k = 0; k < kUsed; ++k) sums.of[k] = (sum[k][0] + sum[k][1]) + (sum[k][2] + sum[k][3]);
  sums.least_depth = least[0];
  for (int k = 1; k < 4; ++k)
    sums.least_depth = least[k] < sums.least_depth ? least[k] : sums.least_depth;
}

template <bool kRotating>
GPO_AVX2_FMA void accumulate_avx2_fma(const FrameObservations& f, const FrameState& s, Sums& sums) {
  accumulate<kRotating>(f, s, sums);
}

FrameNormals unpacked(const Sums& sums) {
  const double* s = sums.of;
  FrameNormals normals;
  // clang-format off
  normals.JtJ << s[n00],   s[n01],   -s[n0p0], -s[n0p1], -s[n0p2], s[n0t0],  s[n0t1],  s[n0t2],
                 s[n01],   s[n11],   -s[n1p0], -s[n1p1], -s[n1p2], s[n1t0],  s[n1t1],  s[n1t2],
                 -s[n0p0], -s[n1p0], s[p00],   s[p01],   s[p02],   -s[p0t0], -s[p0t1], -s[p0t2],
                 -s[n0p1], -s[n1p1], s[p01],   s[p11],   s[p12],   -s[p1t0], -s[p1t1], -s[p1t2],
                 -s[n0p2], -s[n1p2], s[p02],   s[p12],   s[p22],   -s[p2t0], -s[p2t1], -s[p2t2],
                 s[n0t0],  s[n1t0],  -s[p0t0], -s[p1t0], -s[p2t0], s[t00],   0,        s[t02],
                 s[n0t1],  s[n1t1],  -s[p0t1], -s[p1t1], -s[p2t1], 0,        s[t11],   s[t12],
                 s[n0t2],  s[n1t2],  -s[p0t2], -s[p1t2], -s[p2t2], s[t02],   s[t12],   s[t22];
  normals.Jtr << -s[gn0], -s[gn1], s[gp0], s[gp1], s[gp2], -s[gt0], -s[gt1], -s[gt2];
  // clang-format on
  normals.cost = 0.5 * s[squares];
  normals.in_front = sums.least_depth > 0;
  return normals;
}

}  // namespace

int PlaneObservations::count() const {
  int sum = 0;
  for (int k = 0; k < plane_count(); ++k)
    for (const FrameObservations& frame : plane(k)) sum += frame.count;
  return sum;
}

FrameObservations frame_observations(const Window& window, int frame) {
  return gathered(window, frame, window.inlier[frame]);
}

PlaneObservations plane_observations(const Window& window, std::span<const int> others) {
  PlaneObservations observations{window.K(0, 0), window.K(1, 1), {}};
  for (int i = 0; i < window.frame_count(); ++i)
    observations.frames.push_back(frame_observations(window, i));
  for (const int plane : others) {
    auto& frames = observations.others.emplace_back();
    for (int i = 0; i < window.frame_count(); ++i)
      frames.push_back(gathered(window, i, window.planes[plane].inlier[i]));
  }
  return observations;
}

FrameNormals frame_normals_baseline(const FrameObservations& observations,
                                    const FrameState& state,
                                    Rotating rotating) {
  Sums sums;
  if (rotating == Rotating::yes) {
    accumulate<true>(observations, state, sums);
  } else {
    accumulate<false>(observations, state, sums);
  }
  return unpacked(sums);
}

FrameNormals frame_normals_avx2_fma(const FrameObservations& observations,
                                    const FrameState& state,
                                    Rotating rotating) {
  Sums sums;
  if (rotating == Rotating::yes) {
    accumulate_avx2_fma<true>(observations, state, sums);
  } else {
    accumulate_avx2_fma<false>(observations, state, sums);
  }
  return unpacked(sums);
}

FrameNormals frame_normals(const FrameObservations& observations,
                           const FrameState& state,
                           Rotating rotating) {
  static const auto version = has_avx2_fma() ? frame_normals_avx2_fma : frame_normals_baseline;
  return version(observations, state, rotating);
}

}  // namespace gpo
