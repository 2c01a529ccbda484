// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/inliers.h"

#include "engine/geometry/homography.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;

std::vector<bool> agreeing_pairs(const Matrix3d& H,
                                 const Matrix2Xd& from,
                                 const Matrix2Xd& to,
                                 double threshold_px) {
  std::vector<bool> inlier(from.cols());
  for (Eigen::Index j = 0; j < from.cols(); ++j) {
    const Eigen::Vector3d y = H * from.col(j).homogeneous();
    inlier[j] = y.z() * H(2, 2) > 0 && (y.hnormalized() - to.col(j)).norm() <= threshold_px;
  }
  return inlier;
}

/// Returns whether more than `most` pairs agree with H, up to rounding. Stops as soon as they
/// cannot, in a tenth of the time that fitting and `agreeing_pairs` take.
bool more_agree(const Matrix3d& H,
                const Matrix2Xd& from,
                const Matrix2Xd& to,
                double threshold_px,
                std::ptrdiff_t most) {
  std::ptrdiff_t may_refuse = from.cols() - most;
  for (Eigen::Index j = 0; j < from.cols() && may_refuse > 0; ++j) {
    const Eigen::Vector3d y = H * from.col(j).homogeneous();
    const Eigen::Vector2d error = y.head<2>() - y.z() * to.col(j);
    const double radius = threshold_px * y.z();
    if (!(y.z() * H(2, 2) > 0 && error.squaredNorm() <= radius * radius)) --may_refuse;
  }
  return may_refuse > 0;
}

std::vector<int> indices(const std::vector<bool>& flags) {
  std::vector<int> of_true;
  for (std::size_t j = 0; j < flags.size(); ++j)
    if (flags[j]) of_true.push_back(static_cast<int>(j));
  return of_true;
}

std::array<int, 4> draw_four(std::mt19937_64& random, int n) {
  std::array<int, 4> sample{};
  for (int k = 0; k < 4;) {
    // Not std::uniform_int_distribution, whose numbers differ between standard libraries.
    sample[k] = static_cast<int>(random() % static_cast<std::uint64_t>(n));
    if (std::find(sample.begin(), sample.begin() + k, sample[k]) == sample.begin() + k) ++k;
  }
  return sample;
}

int iterations_needed(double inlier_ratio, const RansacOptions& options) {
  const double good_sample = std::pow(inlier_ratio, 4);
  if (good_sample >= 1) return 1;
  const double needed = std::log(1 - options.confidence) / std::log1p(-good_sample);
  return needed < options.most_iterations ? static_cast<int>(std::ceil(needed))
                                          : options.most_iterations;
}

constexpr double kQuartileSigmas = 0.6745;  // upper quartile of a Gaussian
constexpr double kSigmas = 3.5;          // largest error of an agreeing track, beside the threshold
constexpr double kLeastSigma_px = 0.03;  // one coordinate of a frame's tracks
constexpr double kSigmasOfTrack = 3;     // excess of a mean square over the median track's
constexpr std::size_t kLeastInliers = 8;  // in each frame
constexpr int kMostSelections = 10;       // rounds of fitting and selection

bool fit(PlaneTracks& tracks, const std::vector<Matrix2Xd>& points_px) {
  for (std::size_t i = 1; i < points_px.size(); ++i) {
    const std::vector<int> inliers = indices(tracks.inlier[i]);
    if (inliers.size() < kLeastInliers) return false;
    tracks.H_i1[i] = refine_homography(
        tracks.H_i1[i], points_px[0](Eigen::all, inliers), points_px[i](Eigen::all, inliers));
  }
  return true;
}

struct Errors {
  /// Transfer errors in standard deviations of one coordinate of their frame's inliers, frames x
  /// tracks; NaN: not seen.
  Eigen::ArrayXXd normalized;
  Eigen::ArrayXd gate;  ///< largest error of an agreeing track, one a frame
};

Errors errors_of(const PlaneTracks& tracks,
                 const std::vector<Matrix2Xd>& points_px,
                 double threshold_px) {
  const auto frames = static_cast<Eigen::Index>(points_px.size());
  Errors errors{Eigen::ArrayXXd(frames, points_px[0].cols()), Eigen::ArrayXd(frames)};
  for (Eigen::Index i = 1; i < frames; ++i) {
    std::vector<double> of_inliers_px;
    for (Eigen::Index j = 0; j < points_px[0].cols(); ++j) {
      const double error_px =
          (transfer(tracks.H_i1[i], points_px[0].col(j)) - points_px[i].col(j)).norm();
      errors.normalized(i, j) = error_px;
      if (tracks.inlier[i][j]) of_inliers_px.push_back(error_px);
    }
    const double sigma_px =
        std::max(median(std::move(of_inliers_px)) / kMedianOfRayleigh, kLeastSigma_px);
    errors.normalized.row(i) /= sigma_px;
    errors.gate[i] = std::min(kSigmas, threshold_px / sigma_px);
  }
  return errors;
}

/// Averages the square over all frames that see the track, each error limited to its gate.
TrackConsistency consistency_of(const Errors& errors, Eigen::Index track) {
  TrackConsistency result;
  double sum = 0;
  for (Eigen::Index i = 1; i < errors.gate.size(); ++i) {
    const double error = errors.normalized(i, track);
    if (std::isnan(error)) continue;
    ++result.seen;
    result.agreeing += error <= errors.gate[i] ? 1 : 0;
    sum += std::pow(std::min(error, errors.gate[i]), 2);
  }
  if (result.agreeing > 0 && result.agreeing >= kConsistentShare * result.seen)
    result.mean_square = sum / result.seen;
  return result;
}

/// Returns the limit of the mean squares, never below that of pure noise. Their spread is estimated
/// from the upper half, as drift makes some tracks much worse than the median one, not better.
double largest_mean_square(const std::vector<TrackConsistency>& tracks) {
  std::vector<double> values;
  for (const TrackConsistency& track : tracks)
    if (track.mean_square) values.push_back(*track.mean_square);
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const double middle = values[values.size() / 2];
  const double upper_quartile = values[3 * values.size() / 4];
  return std::max(middle + kSigmasOfTrack * (upper_quartile - middle) / kQuartileSigmas, 2.0);
}

std::vector<TrackConsistency> consistency(const Errors& errors) {
  std::vector<TrackConsistency> tracks;
  for (Eigen::Index j = 0; j < errors.normalized.cols(); ++j)
    tracks.push_back(consistency_of(errors, j));
  const double largest = largest_mean_square(tracks);
  for (TrackConsistency& track : tracks) track.largest_mean_square = largest;
  return tracks;
}

std::vector<std::vector<bool>> choose(const Errors& errors) {
  const Eigen::Index tracks = errors.normalized.cols();
  const std::vector<TrackConsistency> of_tracks = consistency(errors);
  std::vector<std::vector<bool>> inlier(errors.gate.size(), std::vector<bool>(tracks, false));
  for (Eigen::Index j = 0; j < tracks; ++j) {
    const auto& [seen, agreeing, mean_square, largest] = of_tracks[j];
    if (!mean_square || *mean_square > largest) continue;
    for (Eigen::Index i = 1; i < errors.gate.size(); ++i)
      inlier[i][j] = errors.normalized(i, j) <= errors.gate[i];
  }
  return inlier;
}

}  // namespace

std::optional<RobustHomography> homography_ransac(const Matrix2Xd& from,
                                                  const Matrix2Xd& to,
                                                  const RansacOptions& options) {
  const int n = static_cast<int>(from.cols());
  if (n < 4) return std::nullopt;
  RobustHomography best{Matrix3d::Identity(), std::vector<bool>(n, !options.enabled)};
  if (!options.enabled) {
    const auto H = fit_homography(from, to);
    if (H) best.H = refine_homography(*H, from, to);
    return H ? std::optional(best) : std::nullopt;
  }
  std::mt19937_64 random(options.seed);
  std::ptrdiff_t most = 0;
  int needed = options.most_iterations;
  for (int iteration = 0; iteration < needed; ++iteration) {
    const std::array<int, 4> sample = draw_four(random, n);
    const Matrix3d H_4 = homography_through_four(from(Eigen::all, sample), to(Eigen::all, sample));
    if (!more_agree(H_4, from, to, options.threshold_px, most)) continue;
    const auto H = fit_homography(from(Eigen::all, sample), to(Eigen::all, sample));
    if (!H) continue;
    std::vector<bool> inlier = agreeing_pairs(*H, from, to, options.threshold_px);
    const auto count = std::ranges::count(inlier, true);
    if (count <= most) continue;
    most = count;
    best = {*H, std::move(inlier)};
    needed = iterations_needed(static_cast<double>(count) / n, options);
  }
  // Refinement on the inliers gains pairs that the sample's noise had rejected, and loses others.
  for (int round = 0; round < 3 && most >= 4; ++round) {
    const std::vector<int> own = indices(best.inlier);
    best.H = refine_homography(best.H, from(Eigen::all, own), to(Eigen::all, own));
    std::vector<bool> inlier = agreeing_pairs(best.H, from, to, options.threshold_px);
    most = std::ranges::count(inlier, true);
    if (inlier == best.inlier) break;
    best.inlier = std::move(inlier);
  }
  return most >= 4 ? std::optional(best) : std::nullopt;
}

std::optional<PlaneTracks> consistent_inliers(const std::vector<Matrix2Xd>& points_px,
                                              PlaneTracks found,
                                              double threshold_px) {
  for (int round = 0;; ++round) {
    if (!fit(found, points_px)) return std::nullopt;
    auto inlier = choose(errors_of(found, points_px, threshold_px));
    if (inlier == found.inlier || round == kMostSelections) return found;
    found.inlier = std::move(inlier);
  }
}

std::vector<TrackConsistency> consistency(const std::vector<Matrix2Xd>& points_px,
                                          const PlaneTracks& found,
                                          double threshold_px) {
  return consistency(errors_of(found, points_px, threshold_px));
}

}  // namespace gpo
