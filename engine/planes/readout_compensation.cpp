// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/planes/readout_compensation.h"

#include "engine/geometry/homography.h"
#include "engine/geometry/lens_residual.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr int kReach = 2;               // frames on each side whose points determine a velocity
constexpr int kFarReach = 4;            // the same where noise matters more than acceleration
constexpr int kOfParabola = 4;          // observations from which on a parabola is fitted
constexpr int kEvaluated = 10;          // frames, spread over the window
constexpr int kLeastFittedTracks = 20;  // on a plane in a frame
constexpr int kRegions = 4;             // in each direction of the reference image
constexpr int kReweightings = 2;        // robust weights
constexpr int kLensTerms = 2 * kLensMonomials;
constexpr double kLens_px = 1;  // prior of each, at the corners
constexpr int kUnknowns = 1 + kLensTerms;
constexpr double kHuberSigmas = 2.5;
constexpr double kMostOfNoise = 0.5;  // share of the information on the row delay
constexpr double kLeastNoise_px = 0.03;
constexpr double kMostReadout_s = 0.04;
constexpr double kUnit_s = 1e-5;            // unit of the row delay
constexpr double kSignificantSigmas = 4.5;  // least significance of a row delay
constexpr double kLeastLikelySigmas = 2;    // the same of row delays to try
constexpr int kTriedSigmas = 3;             // range of row delays to try
constexpr double kTriedReadouts_s[] = {0.01, 0.02, 0.03, -0.01, -0.02, -0.03};

/// Weights of observations for the slope at time 0 of the parabola, or line, through them.
VectorXd slope_weights(const VectorXd& times_s) {
  const int terms = times_s.size() >= kOfParabola ? 3 : 2;
  if (times_s.size() < 2) return VectorXd::Zero(times_s.size());
  MatrixXd powers(times_s.size(), terms);
  powers.col(0).setOnes();
  for (int k = 1; k < terms; ++k) powers.col(k) = powers.col(k - 1).cwiseProduct(times_s);
  const MatrixXd moments = powers.transpose() * powers;
  return powers * moments.ldlt().solve(VectorXd::Unit(terms, 1));
}

/// Returns the tracks' velocities in a frame [px/s], below them their sigmas for unit noise [1/s].
Eigen::Matrix3Xd velocities(const std::vector<Matrix2Xd>& points_px,
                            const std::vector<std::int64_t>& timestamps_ns,
                            int frame,
                            int reach) {
  const int last = static_cast<int>(points_px.size()) - 1;
  const int from = std::clamp(frame - reach, 0, std::max(0, last - 2 * reach));
  const int to = std::min(last, from + 2 * reach);
  Eigen::Matrix3Xd result = Eigen::Matrix3Xd::Zero(3, points_px[0].cols());
  // For the estimate, the frame's own noise would correlate with the velocity at the window's ends.
  const bool with_own = reach == kReach;
  std::vector<int> frames, of_weights;
  VectorXd weights;
  for (Eigen::Index j = 0; j < points_px[0].cols(); ++j) {
    frames.clear();
    for (int i = from; i <= to; ++i)
      if ((i != frame || with_own) && points_px[i].col(j).allFinite()) frames.push_back(i);
    if (frames != of_weights) {
      VectorXd times_s(frames.size());
      for (std::size_t k = 0; k < frames.size(); ++k)
        times_s[k] = 1e-9 * static_cast<double>(timestamps_ns[frames[k]] - timestamps_ns[frame]);
      weights = slope_weights(times_s);
      of_weights = frames;
    }
    for (std::size_t k = 0; k < frames.size(); ++k)
      result.col(j).head<2>() += weights[k] * points_px[frames[k]].col(j);
    result(2, j) = weights.norm();
  }
  return result;
}

/// Displacement of an observation for a unit of the row delay, and of each lens term.
Eigen::Matrix<double, 2, kUnknowns> displacements(const Window& window,
                                                  int frame,
                                                  int track,
                                                  const Vector2d& velocity_px_s) {
  const Vector2d center_px = window.K.topRightCorner<2, 1>();
  Eigen::Matrix<double, 2, kUnknowns> result;
  result.col(0) = kUnit_s * window.row_of(frame, track) * velocity_px_s;
  const Vector2d q = (window.points_px[frame].col(track) - center_px) / center_px.norm();
  const LensMonomials lens = lens_monomials(q);
  for (int k = 0; k < kLensTerms; ++k) {
    result.col(1 + k).setZero();
    result(k % 2, 1 + k) = lens(k / 2);
  }
  return result;
}

/// Residuals of a plane in one frame, two per track.
struct Block {
  std::vector<int> region;
  VectorXd residuals;
  VectorXd noise;  ///< variances of the derivatives by the row delay, for unit noise of the points
  Eigen::Matrix<double, Eigen::Dynamic, kUnknowns> by_unknowns;
  Eigen::Matrix<double, Eigen::Dynamic, 8> by_homography;
};

int region_of(const Vector2d& p, const Vector2d& size_px) {
  const auto cell = [](double share) {
    return std::clamp(static_cast<int>(kRegions * share), 0, kRegions - 1);
  };
  return cell(p.x() / size_px.x()) + kRegions * cell(p.y() / size_px.y());
}

void add_block(const Window& window,
               const std::vector<int>& plane,
               int frame,
               const Eigen::Matrix3Xd& first_px_s,
               const Eigen::Matrix3Xd& px_s,
               std::vector<Block>& blocks) {
  std::vector<int> seen;
  for (const int j : plane)
    if (window.points_px[frame].col(j).allFinite()) seen.push_back(j);
  if (static_cast<int>(seen.size()) < kLeastFittedTracks) return;
  const Matrix2Xd from = window.points_px[0](Eigen::all, seen);
  const Matrix2Xd to = window.points_px[frame](Eigen::all, seen);
  const auto H = fit_homography(from, to);
  if (!H) return;
  const Vector2d center_px = window.K.topRightCorner<2, 1>();
  const Vector2d size_px = image_size_px(window);
  const double scale_px = 0.5 * size_px.norm();
  const auto n = static_cast<Eigen::Index>(seen.size());
  Block block;
  block.residuals.resize(2 * n);
  block.noise.resize(2 * n);
  block.by_unknowns.resize(2 * n, Eigen::NoChange);
  block.by_homography.resize(2 * n, Eigen::NoChange);
  for (Eigen::Index k = 0; k < n; ++k) {
    const int j = seen[k];
    const Eigen::Vector3d y = *H * from.col(k).homogeneous();
    const Vector2d moved = y.hnormalized();
    Eigen::Matrix<double, 2, 3> d_pixel;
    d_pixel << 1, 0, -moved.x(), 0, 1, -moved.y();
    const Eigen::Matrix2d J = d_pixel * H->leftCols<2>() / y.z();
    block.region.push_back(region_of(from.col(k), size_px));
    block.residuals.segment<2>(2 * k) = to.col(k) - moved;
    block.by_unknowns.middleRows<2>(2 * k) =
        displacements(window, frame, j, px_s.col(j).head<2>()) -
        J * displacements(window, 0, j, first_px_s.col(j).head<2>());
    const double own = window.row_of(frame, j) * px_s(2, j);
    const double first = window.row_of(0, j) * first_px_s(2, j);
    block.noise.segment<2>(2 * k).setConstant(kUnit_s * kUnit_s *
                                              (own * own + 0.5 * J.squaredNorm() * first * first));
    const Vector2d a = (from.col(k) - center_px) / scale_px;
    const Vector2d b = (moved - center_px) / scale_px;
    block.by_homography.middleRows<2>(2 * k) << a.x(), a.y(), 1, 0, 0, 0, -b.x() * a.x(),
        -b.x() * a.y(), 0, 0, 0, a.x(), a.y(), 1, -b.y() * a.x(), -b.y() * a.y();
  }
  blocks.push_back(std::move(block));
}

struct Estimate {
  double row_delay_s = 0;
  double sigma_s = 0;
};

using Unknowns = Eigen::Vector<double, kUnknowns>;

Block projected(const Block& block, const VectorXd& weights) {
  const auto& A = block.by_homography;
  const MatrixXd A_w = A.transpose() * weights.asDiagonal();
  const auto solver = (A_w * A).eval().ldlt();
  Block result = block;
  result.residuals -= A * solver.solve(A_w * block.residuals);
  result.by_unknowns -= A * solver.solve(A_w * block.by_unknowns);
  return result;
}

double noise_of(const std::vector<VectorXd>& errors) {
  std::vector<double> lengths;
  for (const VectorXd& e : errors)
    for (Eigen::Index k = 0; k < e.size(); k += 2) lengths.push_back(e.segment<2>(k).norm());
  return std::max(median(std::move(lengths)) / kMedianOfRayleigh, kLeastNoise_px);
}

VectorXd huber_weights(const VectorXd& errors, double sigma_px) {
  VectorXd weights(errors.size());
  for (Eigen::Index k = 0; k < weights.size(); k += 2)
    weights.segment<2>(k).setConstant(
        huber_weight(errors.segment<2>(k).norm(), kHuberSigmas * sigma_px));
  return weights;
}

/// Standard deviation of the first unknown for errors that differ only between regions.
double sigma_of_first(const std::vector<Block>& blocks,
                      const std::vector<VectorXd>& weighted_errors,
                      const Unknowns& influence,
                      double sigma_px) {
  VectorXd of_regions = VectorXd::Zero(kRegions * kRegions);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const VectorXd terms = weighted_errors[b].cwiseProduct(blocks[b].by_unknowns * influence);
    for (std::size_t k = 0; k < blocks[b].region.size(); ++k)
      of_regions[blocks[b].region[k]] += terms[2 * k] + terms[2 * k + 1];
  }
  return std::max(of_regions.norm(), sigma_px * std::sqrt(influence[0]));
}

Estimate estimate(const std::vector<Block>& blocks) {
  Estimate result;
  std::vector<VectorXd> errors;
  for (const Block& block : blocks) errors.push_back(block.residuals);
  for (int round = 0; round < kReweightings; ++round) {
    const double sigma_px = noise_of(errors);
    Eigen::Matrix<double, kUnknowns, kUnknowns> N =
        std::pow(sigma_px / kLens_px, 2) * Unknowns::Ones().asDiagonal().toDenseMatrix();
    N(0, 0) = 0;
    Unknowns right = Unknowns::Zero();
    double noise = 0;
    std::vector<Block> free;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      errors[b] = huber_weights(errors[b], sigma_px);
      free.push_back(projected(blocks[b], errors[b]));
      const MatrixXd G_w = free[b].by_unknowns.transpose() * errors[b].asDiagonal();
      N += G_w * free[b].by_unknowns;
      right += G_w * free[b].residuals;
      noise += errors[b].dot(blocks[b].noise);
    }
    // Noise of the derivatives would shrink the estimate. Residuals have the noise of two points.
    const double own = 1 / N.ldlt().solve(Unknowns::Unit(0))[0];
    N(0, 0) -= std::min(0.5 * sigma_px * sigma_px * noise, kMostOfNoise * own);
    const auto solver = N.ldlt();
    const Unknowns x = solver.solve(right);
    std::vector<VectorXd> weighted;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const VectorXd weights = errors[b];
      errors[b] = free[b].residuals - free[b].by_unknowns * x;
      weighted.push_back(weights.cwiseProduct(errors[b]));
    }
    const double sigma = sigma_of_first(free, weighted, solver.solve(Unknowns::Unit(0)), sigma_px);
    result = {kUnit_s * x[0], kUnit_s * sigma};
  }
  return result;
}

std::vector<std::vector<int>> sets_of(const Window& window) {
  std::vector<std::vector<int>> sets;
  for (const WindowPlane& plane : window.planes) sets.push_back(plane.tracks);
  if (sets.empty()) sets.push_back(window.inlier_tracks(0));
  return sets;
}

bool is_plausible(const Window& window, double row_delay_s) {
  return std::abs(row_delay_s) * window.row_count() < kMostReadout_s;
}

std::optional<Estimate> estimated_from(const Window& window) {
  const int last = window.frame_count() - 1;
  const auto velocities_in = [&](int frame) {
    return velocities(window.points_px, window.timestamps_ns, frame, kFarReach);
  };
  const Eigen::Matrix3Xd first_px_s = velocities_in(0);
  std::vector<Block> blocks;
  // Earlier frames share observations with the reference frame's velocities.
  for (int frame = last; frame > 2 * kFarReach; frame -= std::max(1, last / kEvaluated)) {
    const Eigen::Matrix3Xd px_s = velocities_in(frame);
    for (const std::vector<int>& set : sets_of(window))
      add_block(window, set, frame, first_px_s, px_s, blocks);
  }
  return blocks.empty() ? std::nullopt : std::optional(estimate(blocks));
}

/// Estimates the row delay [s/row] from the residuals of the homographies of the window's planes,
/// or of its inliers. Returns 0 unless it is plausible and significant beside errors that
/// neighboring tracks share and those of a lens, cubic polynomials of the position.
double visible_row_delay_s(const Window& window) {
  const auto found = estimated_from(window);
  if (!found || std::abs(found->row_delay_s) < kSignificantSigmas * found->sigma_s) return 0;
  return is_plausible(window, found->row_delay_s) ? found->row_delay_s : 0;
}

Window with_points(Window window, std::vector<Matrix2Xd> points_px) {
  window.points_px = std::move(points_px);
  const auto refit = [&](const std::vector<std::vector<bool>>& inlier,
                         std::vector<Matrix3d>& H_i1) {
    for (int i = 1; i < window.frame_count(); ++i) {
      std::vector<int> own;
      for (int j = 0; j < window.track_count(); ++j)
        if (inlier[i][j]) own.push_back(j);
      if (own.size() < 4) continue;
      H_i1[i] = refine_homography(
          H_i1[i], window.points_px[0](Eigen::all, own), window.points_px[i](Eigen::all, own));
    }
  };
  for (WindowPlane& plane : window.planes) refit(plane.inlier, plane.H_i1);
  refit(window.inlier, window.H_i1);
  return window;
}

std::size_t tracks_on_planes(const Window& window) {
  std::size_t sum = 0;
  for (const WindowPlane& plane : window.planes) sum += plane.tracks.size();
  return sum;
}

}  // namespace

std::vector<Matrix2Xd> without_readout(const Window& window,
                                       std::vector<Matrix2Xd> points_px,
                                       double row_delay_s) {
  const std::vector<Matrix2Xd> seen_px = points_px;
  for (int i = 0; i < window.frame_count(); ++i) {
    const Eigen::Matrix3Xd px_s = velocities(seen_px, window.timestamps_ns, i, kReach);
    for (int j = 0; j < window.track_count(); ++j)
      points_px[i].col(j) -= row_delay_s * window.row_of(i, j) * px_s.col(j).head<2>();
  }
  return points_px;
}

Window at_time_stamps(Window window) {
  if (window.selection_row_delay_s == 0) return window;
  auto points_px = without_readout(window, window.points_px, window.selection_row_delay_s);
  return with_points(std::move(window), std::move(points_px));
}

std::vector<double> likely_row_delays_s(const Window& window) {
  std::vector<double> likely;
  const auto found = estimated_from(window);
  if (!found || std::abs(found->row_delay_s) < kLeastLikelySigmas * found->sigma_s) return likely;
  for (int k = -kTriedSigmas; k <= kTriedSigmas; ++k) {
    const double row_delay_s = found->row_delay_s + k * found->sigma_s;
    if (is_plausible(window, row_delay_s)) likely.push_back(row_delay_s);
  }
  return likely;
}

Window with_late_rows(const Window& window, const std::function<Window(double)>& select) {
  const auto selected = [&](double row_delay_s) {
    if (row_delay_s == 0) return window;
    Window late = with_points(select(row_delay_s), window.points_px);
    late.lens_moves_px = window.lens_moves_px;
    late.static_tracks = window.static_tracks;
    late.row_delay = window.row_delay;
    late.rows = window.rows;
    late.image_rows = window.image_rows;
    late.readout_direction = window.readout_direction;
    late.selection_row_delay_s = row_delay_s;
    return late;
  };
  if (window.row_delay) return selected(window.row_delay->mean_s);
  if (window.inliers != Inliers::planes || !window.planes.empty())
    return selected(visible_row_delay_s(window));
  Window best = window;
  for (const double readout_s : kTriedReadouts_s) {
    Window tried = selected(readout_s / window.row_count());
    if (tracks_on_planes(tried) > tracks_on_planes(best)) best = std::move(tried);
  }
  return best.planes.empty() ? window : selected(visible_row_delay_s(best));
}

}  // namespace gpo
