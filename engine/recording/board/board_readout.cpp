// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/parallel.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/board/board.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <thread>

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

/// Corners that move.
struct MovingCorners {
  Corners seen, velocities_px_s;
};

/// Squared reprojection errors of frames at three readout times [px^2]: the middle one, and one
/// step less and more.
using Squares = Eigen::Array3d;

Squares squares_at(const MovingCorners& corners,
                   const Board& board,
                   const Camera& camera,
                   const Readout& middle,
                   double step_s) {
  Squares squares;
  for (int k = 0; k < 3; ++k) {
    const double readout_s = middle.seconds + (k - 1) * step_s;
    const auto moved = at_time_stamp(corners.seen, corners.velocities_px_s, camera, readout_s);
    const auto pose = board_pose(moved, board, camera, std::numeric_limits<double>::infinity());
    const auto count = std::ranges::count_if(moved, [](const auto& px) { return px.allFinite(); });
    squares[k] = pose ? std::pow(pose->uncertainty.rms_px, 2) * static_cast<double>(count)
                      : std::numeric_limits<double>::quiet_NaN();
  }
  return squares;
}

std::vector<MovingCorners> moving_corners(const BoardCorners& corners,
                                          std::span<const int> frames,
                                          std::span<const std::int64_t> timestamps_ns) {
  std::vector<MovingCorners> moving;
  for (const int frame : frames) {
    const auto found = corners.find(frame);
    if (found == corners.end() || found->second.empty()) continue;
    auto velocities_px_s = corner_velocities(corners, frame, timestamps_ns);
    if (!velocities_px_s.empty()) moving.push_back({found->second, std::move(velocities_px_s)});
  }
  return moving;
}

/// Squares by frame, without those that fit far worse than the others.
std::vector<Squares> squares_of_frames(const std::vector<MovingCorners>& moving,
                                       const Board& board,
                                       const Camera& camera,
                                       const Readout& middle,
                                       double step_s) {
  constexpr double kMostTimesMedian = 9;
  std::vector<Squares> all(moving.size());
  in_parallel(static_cast<int>(moving.size()),
              static_cast<int>(std::thread::hardware_concurrency()),
              [&](int k) { all[k] = squares_at(moving[k], board, camera, middle, step_s); });
  std::erase_if(all, [](const Squares& one) { return !one.isFinite().all(); });
  std::vector<double> least;
  for (const Squares& one : all) least.push_back(one.minCoeff());
  if (all.empty()) return all;
  const double most = kMostTimesMedian * median(std::move(least));
  std::erase_if(all, [&](const Squares& one) { return one.minCoeff() > most; });
  return all;
}

/// Returns the camera with an error of one standard deviation of each focal length and of the
/// principal point's coordinates, those of a typical calibration if they are unknown.
std::vector<Camera> other_cameras(const Camera& camera) {
  std::vector<Camera> others(4, camera);
  const double typical_px = kTypicalLensShare * camera.width;
  const auto sigma = [&](std::size_t k, double typical) {
    return camera.sigmas.empty() ? typical : camera.sigmas[k];
  };
  others[0].fx += sigma(0, kTypicalLensShare * camera.fx);
  others[1].fy += sigma(1, kTypicalLensShare * camera.fy);
  others[2].cx += sigma(2, typical_px);
  others[3].cy += sigma(3, typical_px);
  return others;
}

/// Returns the readout time with the least sum of the squares around `middle`, and its standard
/// deviation by the least squares; nullopt if there is none.
std::optional<Readout> readout_near(const std::vector<Squares>& frames,
                                    const Readout& middle,
                                    double step_s,
                                    double freedom_per_frame) {
  Squares sum = Squares::Zero();
  for (const Squares& one : frames) sum += one;
  const auto shift =
      least_readout(sum, step_s, freedom_per_frame * static_cast<double>(frames.size()));
  if (!shift) return std::nullopt;
  return Readout{middle.seconds + shift->seconds, shift->sigma_s};
}

/// The standard deviation without one of several blocks of time each.
double jackknife_sigma_s(const std::vector<Squares>& frames, double step_s) {
  constexpr int kBlocks = 5;
  const int count = static_cast<int>(frames.size());
  Eigen::Array<double, kBlocks, 1> estimates;
  for (int block = 0; block < kBlocks; ++block) {
    Squares sum = Squares::Zero();
    for (int i = 0; i < count; ++i)
      if (i * kBlocks / count != block) sum += frames[i];
    const auto without = least_readout(sum, step_s, 1);
    if (!without) return std::numeric_limits<double>::infinity();
    estimates[block] = without->seconds;
  }
  return std::sqrt((estimates - estimates.mean()).square().sum() * (kBlocks - 1) / kBlocks);
}

}  // namespace

std::optional<Readout> least_readout(const Eigen::Array3d& squares_px2,
                                     double step_s,
                                     double freedom) {
  const auto [less, middle, more] = std::tuple(squares_px2[0], squares_px2[1], squares_px2[2]);
  const double bend = less - 2 * middle + more;
  if (!(bend > 0) || !std::isfinite(bend)) return std::nullopt;
  // The sum of squares is S + bend / 2 (s / step)^2, its unit variance S / freedom.
  return Readout{0.5 * step_s * (less - more) / bend,
                 step_s * std::sqrt(2 * middle / bend / freedom)};
}

std::optional<Readout> readout_from_board(const BoardCorners& corners,
                                          std::span<const int> frames,
                                          std::span<const std::int64_t> timestamps_ns,
                                          const Board& board,
                                          const Camera& camera) {
  constexpr std::size_t kLeastFrames = 10;
  constexpr double kLeastSigma_s = 1e-3;
  constexpr double kMost_s = 0.1, kSignificantSigmas = 3;
  constexpr double kOfRealBoards = 2;  // errors in windows of real recordings in these sigmas
  constexpr double kFirstStep_s = 0.01, kLastStep_s = 0.003;
  const auto moving = moving_corners(corners, frames, timestamps_ns);
  if (moving.size() < kLeastFrames) return std::nullopt;
  const double freedom = 2.0 * static_cast<double>(moving.front().seen.size()) - 6;
  const auto significant = [&](const std::optional<Readout>& one) {
    return one && std::abs(one->seconds) < kMost_s &&
           std::abs(one->seconds) > kSignificantSigmas * std::max(one->sigma_s, kLeastSigma_s);
  };
  std::optional<Readout> found = Readout{};
  std::vector<Squares> squares;
  for (const double step_s : {kFirstStep_s, kLastStep_s}) {
    squares = squares_of_frames(moving, board, camera, *found, step_s);
    if (squares.size() < kLeastFrames) return std::nullopt;
    found = readout_near(squares, *found, step_s, freedom);
    if (!significant(found)) return std::nullopt;
  }
  double lens_variance = 0;
  for (const Camera& other : other_cameras(camera)) {
    const auto by_other = readout_near(
        squares_of_frames(moving, board, other, *found, kLastStep_s), *found, kLastStep_s, freedom);
    if (!by_other) return std::nullopt;
    lens_variance += std::pow(by_other->seconds - found->seconds, 2);
  }
  // A bent board moves its corners alike in all frames, by no more than the residuals.
  const double shared_s = found->sigma_s * std::sqrt(static_cast<double>(squares.size()));
  const double noise_s =
      std::max({shared_s, jackknife_sigma_s(squares, kLastStep_s), kLeastSigma_s});
  found->sigma_s = kOfRealBoards * std::hypot(noise_s, std::sqrt(lens_variance));
  return significant(found) ? found : std::nullopt;
}

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
