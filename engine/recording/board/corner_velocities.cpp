// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/recording/board/board.h"

#include <cmath>

namespace gpo {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

/// Returns whether the corners move evenly from `a` over `b` to `c`. Photos do not, nor do boards
/// whose corners are numbered from another end.
bool moves_evenly(const Corners& a, const Corners& b, const Corners& c) {
  constexpr double kMostChange = 0.5, kMostChange_px = 2;
  std::vector<double> excess;
  for (std::size_t j = 0; j < b.size(); ++j) {
    const double moved = (c[j] - a[j]).norm();
    const double change = (c[j] - 2 * b[j] + a[j]).norm();
    if (std::isfinite(change)) excess.push_back(change - kMostChange * moved - kMostChange_px);
  }
  return !excess.empty() && median(std::move(excess)) < 0;
}

/// Returns the derivative at time 0 of the polynomial through the values at 0 and at other times,
/// as weights of the differences from the value at 0 (Lagrange).
std::vector<double> slope_weights(const std::vector<double>& times_s) {
  std::vector<double> weights;
  for (const double t : times_s) {
    double weight = 1 / t;
    for (const double other : times_s)
      if (other != t) weight *= other / (other - t);
    weights.push_back(weight);
  }
  return weights;
}

/// Returns the frames that determine the velocities in a frame: two before and two after it, one of
/// each, or two on one side; empty if the corners do not move evenly there.
std::vector<int> neighbors(const BoardCorners& corners, int frame) {
  const auto even = [&](int a, int b, int c) {
    for (const int one : {a, b, c}) {
      const auto found = corners.find(one);
      if (found == corners.end() || found->second.empty()) return false;
    }
    return moves_evenly(corners.at(a), corners.at(b), corners.at(c));
  };
  const int f = frame;
  if (even(f - 1, f, f + 1)) {
    if (even(f - 2, f, f + 2)) return {f - 2, f - 1, f + 1, f + 2};
    return {f - 1, f + 1};
  }
  if (even(f, f + 1, f + 2)) return {f + 1, f + 2};
  if (even(f - 2, f - 1, f)) return {f - 2, f - 1};
  return {};
}

}  // namespace

std::vector<Eigen::Vector2d> corner_velocities(const BoardCorners& corners,
                                               int frame,
                                               std::span<const std::int64_t> timestamps_ns) {
  const std::vector<int> others = neighbors(corners, frame);
  if (others.empty()) return {};
  std::vector<double> times_s(others.size());
  for (std::size_t k = 0; k < others.size(); ++k)
    times_s[k] = 1e-9 * static_cast<double>(timestamps_ns[others[k]] - timestamps_ns[frame]);
  const std::vector<double> weights = slope_weights(times_s);
  const Corners& here = corners.at(frame);
  Corners velocities(here.size(), Eigen::Vector2d::Zero());
  for (std::size_t k = 0; k < others.size(); ++k)
    for (std::size_t j = 0; j < here.size(); ++j)
      velocities[j] += weights[k] * (corners.at(others[k])[j] - here[j]);
  return velocities;
}

std::vector<Eigen::Vector2d> at_time_stamp(std::vector<Eigen::Vector2d> corners,
                                           const std::vector<Eigen::Vector2d>& velocities_px_s,
                                           const Camera& camera,
                                           double readout_s) {
  const double row_delay_s = readout_s / (readout_lines(camera) - 1);
  for (std::size_t j = 0; j < corners.size(); ++j)
    corners[j] -= row_delay_s * row_from_middle(camera, corners[j]) * velocities_px_s[j];
  return corners;
}

}  // namespace gpo
