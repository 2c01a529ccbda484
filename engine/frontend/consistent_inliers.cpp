// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/consistent_inliers.h"

#include "engine/geometry/homography.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;

/// Where a Gaussian's upper quartile is.
constexpr double kQuartileSigmas = 0.6745;

std::vector<int> indices(const std::vector<bool>& flags) {
  std::vector<int> of_true;
  for (std::size_t j = 0; j < flags.size(); ++j) {
    if (flags[j]) of_true.push_back(static_cast<int>(j));
  }
  return of_true;
}

/// The homographies of the inliers; whether there are enough in every frame.
bool fit(PlaneTracks& tracks,
         const std::vector<Matrix2Xd>& points_px,
         const ConsistencyOptions& options) {
  for (std::size_t i = 1; i < points_px.size(); ++i) {
    const std::vector<int> inliers = indices(tracks.inlier[i]);
    if (static_cast<int>(inliers.size()) < options.least_inliers) return false;
    tracks.H_i1[i] = refine_homography(
        tracks.H_i1[i], points_px[0](Eigen::all, inliers), points_px[i](Eigen::all, inliers));
  }
  return true;
}

/// Transfer errors of the tracks, frames x tracks, in standard deviations of one coordinate of
/// their frame's inliers; NaN where not seen. Beside it, how large an error still agrees, one a
/// frame.
struct Errors {
  Eigen::ArrayXXd normalized;
  Eigen::ArrayXd gate;
};

Errors errors_of(const PlaneTracks& tracks,
                 const std::vector<Matrix2Xd>& points_px,
                 const ConsistencyOptions& options) {
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
        std::max(median(std::move(of_inliers_px)) / kMedianOfRayleigh, options.least_sigma_px);
    errors.normalized.row(i) /= sigma_px;
    errors.gate[i] = std::min(options.sigmas, options.threshold_px / sigma_px);
  }
  return errors;
}

/// The mean square is over the frames that see the track, each error at most its gate.
TrackConsistency consistency_of(const Errors& errors, Eigen::Index track, double share) {
  TrackConsistency result;
  double sum = 0;
  for (Eigen::Index i = 1; i < errors.gate.size(); ++i) {
    const double error = errors.normalized(i, track);
    if (std::isnan(error)) continue;
    ++result.seen;
    result.agreeing += error <= errors.gate[i] ? 1 : 0;
    sum += std::pow(std::min(error, errors.gate[i]), 2);
  }
  if (result.agreeing > 0 && result.agreeing >= share * result.seen)
    result.mean_square = sum / result.seen;
  return result;
}

/// Above it a mean square stands out among the others; never below that of pure noise. Their spread
/// is that of the upper half, as drift makes some tracks much worse than the median one, not
/// better.
double largest_mean_square(const std::vector<TrackConsistency>& tracks, double sigmas) {
  std::vector<double> values;
  for (const TrackConsistency& track : tracks) {
    if (track.mean_square) values.push_back(*track.mean_square);
  }
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const double middle = values[values.size() / 2];
  const double upper_quartile = values[3 * values.size() / 4];
  return std::max(middle + sigmas * (upper_quartile - middle) / kQuartileSigmas, 2.0);
}

std::vector<TrackConsistency> consistency(const Errors& errors, const ConsistencyOptions& options) {
  std::vector<TrackConsistency> tracks;
  for (Eigen::Index j = 0; j < errors.normalized.cols(); ++j)
    tracks.push_back(consistency_of(errors, j, options.share));
  const double largest = largest_mean_square(tracks, options.sigmas_of_track);
  for (TrackConsistency& track : tracks) track.largest_mean_square = largest;
  return tracks;
}

/// The inliers, one a frame and track; none in the reference frame.
std::vector<std::vector<bool>> choose(const Errors& errors, const ConsistencyOptions& options) {
  const Eigen::Index tracks = errors.normalized.cols();
  const std::vector<TrackConsistency> of_tracks = consistency(errors, options);
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

std::optional<PlaneTracks> consistent_inliers(const std::vector<Matrix2Xd>& points_px,
                                              PlaneTracks found,
                                              const ConsistencyOptions& options) {
  for (int round = 0;; ++round) {
    if (!fit(found, points_px, options)) return std::nullopt;
    auto inlier = choose(errors_of(found, points_px, options), options);
    if (inlier == found.inlier || round == options.most_rounds) return found;
    found.inlier = std::move(inlier);
  }
}

std::vector<TrackConsistency> consistency(const std::vector<Matrix2Xd>& points_px,
                                          const PlaneTracks& found,
                                          const ConsistencyOptions& options) {
  return consistency(errors_of(found, points_px, options), options);
}

}  // namespace gpo
