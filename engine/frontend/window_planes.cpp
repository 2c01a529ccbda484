// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/window_planes.h"

#include "engine/geometry/homography.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <random>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::ArrayXd;
using Eigen::Matrix2Xd;
using Eigen::Matrix3d;

constexpr int kLeastSeen = 8;
constexpr int kMostRounds = 8;
constexpr double kGoodDraws = 25;
/// A plane has so many times the tracks that chance would put there: half of those that miss its
/// gate by up to twice the gate. Of a cloud of points the best hypothesis has two to three times.
constexpr double kLeastOverChance = 4.8;
constexpr double kLeastOverChanceOfMore = 2.5;  // of a further plane: that there are any is known
constexpr int kSpentTracks = 4;                 // any four tracks have a homography
constexpr double kNearlyAll = 0.9;      // of the tracks near one plane: they are noisy, not far
constexpr double kWellExplained = 0.5;  // of the tracks, by planes
constexpr double kFarMore = 1.3;

/// Tracks in the reference picture and in a later one [px].
struct Pairs {
  std::vector<int> tracks;
  Matrix2Xd from, to;
};

Pairs pairs_of(const std::vector<Matrix2Xd>& points_px, int frame, const std::vector<int>& among) {
  Pairs pairs;
  for (const int j : among)
    if (points_px[0].col(j).allFinite() && points_px[frame].col(j).allFinite())
      pairs.tracks.push_back(j);
  pairs.from = points_px[0](Eigen::all, pairs.tracks);
  pairs.to = points_px[frame](Eigen::all, pairs.tracks);
  return pairs;
}

std::vector<int> numbers_below(int count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::vector<int> spread_frames(int frames, int wanted) {
  const int n = std::min(wanted, frames - 1);
  std::vector<int> chosen;
  for (int k = 1; k <= n; ++k) chosen.push_back((frames - 1) * k / n);
  return chosen;
}

/// Squared transfer errors [px^2]; infinite where H turns a point around.
ArrayXd squared_errors(const Matrix3d& H, const Matrix2Xd& from, const Matrix2Xd& to) {
  const auto x = from.row(0).array();
  const auto y = from.row(1).array();
  const Eigen::Array<double, 1, Eigen::Dynamic> depth = H(2, 0) * x + H(2, 1) * y + H(2, 2);
  const auto u = (H(0, 0) * x + H(0, 1) * y + H(0, 2)) / depth - to.row(0).array();
  const auto v = (H(1, 0) * x + H(1, 1) * y + H(1, 2)) / depth - to.row(1).array();
  const double infinity = std::numeric_limits<double>::infinity();
  return (depth * H(2, 2) > 0).select(u * u + v * v, infinity).transpose();
}

/// Judges hypotheses by all pairs, thousands of times: single precision, no memory taken.
class Judge {
 public:
  Judge(const Pairs& pairs, double gate_px)
      : x_(pairs.from.row(0).cast<float>().transpose()),
        y_(pairs.from.row(1).cast<float>().transpose()),
        u_(pairs.to.row(0).cast<float>().transpose()),
        v_(pairs.to.row(1).cast<float>().transpose()),
        a_square_px2_(static_cast<float>(1 / (gate_px * gate_px))) {}

  /// Not how many agree, but how closely (MSAC, Torr and Zisserman 2000): at little parallax one
  /// homography passes near the tracks of two planes, and through those of one.
  double score(const Matrix3d& hypothesis) {
    const Eigen::Matrix3f H = (hypothesis / hypothesis(2, 2)).cast<float>();
    depth_ = H(2, 0) * x_ + H(2, 1) * y_ + H(2, 2);
    du_ = (H(0, 0) * x_ + H(0, 1) * y_ + H(0, 2)) / depth_ - u_;
    dv_ = (H(1, 0) * x_ + H(1, 1) * y_ + H(1, 2)) / depth_ - v_;
    const auto loss = 1 - a_square_px2_ * (du_.square() + dv_.square());
    return (depth_ > 0).select(loss.max(0), 0).sum();
  }

 private:
  Eigen::ArrayXf x_, y_, u_, v_;
  float a_square_px2_;
  Eigen::ArrayXf depth_, du_, dv_;
};

/// For each pair the others, the nearest quarter of them in the reference picture.
std::vector<std::vector<int>> neighborhoods(const Pairs& pairs) {
  const int n = static_cast<int>(pairs.tracks.size());
  const int size = std::min(std::max(3, n / 4), n - 1);
  // Distances lie beside the numbers that are sorted by them, thousands of times.
  struct Other {
    double square_px2;
    int number;
  };
  std::vector<Other> others(n - 1);
  std::vector<std::vector<int>> near(n);
  for (int k = 0; k < n; ++k) {
    for (int j = 0, at = 0; j < n; ++j)
      if (j != k) others[at++] = {(pairs.from.col(j) - pairs.from.col(k)).squaredNorm(), j};
    const auto nearest = others.begin() + std::min(size, n - 2);
    std::ranges::nth_element(others, nearest, {}, &Other::square_px2);
    for (int j = 0; j < size; ++j) near[k].push_back(others[j].number);
  }
  return near;
}

/// So many that four neighbors of a plane with such a share of the tracks are drawn some ten times:
/// those that lie near each other tell its homography badly.
int hypotheses_needed(double share, const PlaneOptions& options) {
  const double wanted = kGoodDraws / (share * share * share);
  return wanted < options.most_hypotheses
             ? std::max(options.least_hypotheses, static_cast<int>(wanted))
             : options.most_hypotheses;
}

/// Tracks of the hypothesis with which most agree in one frame; four neighbors make one.
std::vector<int> best_hypothesis(const Pairs& pairs,
                                 const PlaneOptions& options,
                                 std::mt19937_64& random) {
  const int n = static_cast<int>(pairs.tracks.size());
  if (n < kLeastSeen) return {};
  const auto near = neighborhoods(pairs);
  const double gate_px = options.least_gate * options.gate_px;
  const auto draw = [&](std::size_t below) { return static_cast<std::size_t>(random() % below); };
  Judge judge(pairs, gate_px);
  double most = 0;
  ArrayXd best;
  int needed = options.most_hypotheses;
  for (int h = 0; h < needed; ++h) {
    const int seed = static_cast<int>(draw(n));
    std::array<int, 4> four{seed, -1, -1, -1};
    for (int k = 1; k < 4;) {
      const int drawn = near[seed][draw(near[seed].size())];
      if (std::ranges::find(four, drawn) == four.end()) four[k++] = drawn;
    }
    const Matrix3d H =
        homography_through_four(pairs.from(Eigen::all, four), pairs.to(Eigen::all, four));
    if (!H.allFinite()) continue;
    const double score = judge.score(H);
    if (!(score > most)) continue;
    most = score;
    best = squared_errors(H, pairs.from, pairs.to);
    const auto agreeing = static_cast<double>((best <= gate_px * gate_px).count());
    needed = hypotheses_needed(agreeing / n, options);
  }
  std::vector<int> tracks;
  for (int k = 0; k < best.size(); ++k)
    if (best[k] <= gate_px * gate_px) tracks.push_back(pairs.tracks[k]);
  return tracks;
}

/// A plane as it is found: its tracks, and how far each of all tracks is from it.
struct Found {
  std::vector<int> tracks;
  ArrayXd rms_px;  ///< over the judging frames that see the track; infinite: none of them does
  double gate_px = 0;
};

class Search {
 public:
  Search(const std::vector<Matrix2Xd>& points_px, const PlaneOptions& options)
      : points_px_(points_px), options_(options) {
    for (const int i : spread_frames(static_cast<int>(points_px.size()), options.judging_frames))
      frames_.push_back(pairs_of(points_px, i, numbers_below(track_count())));
  }

  int track_count() const { return static_cast<int>(points_px_[0].cols()); }

  /// Root mean square transfer errors from the homographies of these tracks, refitted in every
  /// judging frame; infinite of all where they do not give them.
  ArrayXd errors_from(const std::vector<int>& tracks) const {
    const double infinity = std::numeric_limits<double>::infinity();
    std::vector<bool> chosen(track_count(), false);
    for (const int j : tracks) chosen[j] = true;
    ArrayXd squares = ArrayXd::Zero(track_count());
    ArrayXd seen = ArrayXd::Zero(track_count());
    for (const Pairs& pairs : frames_) {
      std::vector<int> own;
      for (int k = 0; k < static_cast<int>(pairs.tracks.size()); ++k)
        if (chosen[pairs.tracks[k]]) own.push_back(k);
      if (static_cast<int>(own.size()) < kLeastSeen) continue;
      // Least algebraic error is near enough to the least one for a gate of pixels, and a fifth of
      // its time.
      const auto H = fit_homography(pairs.from(Eigen::all, own), pairs.to(Eigen::all, own));
      if (!H) return ArrayXd::Constant(track_count(), infinity);
      squares(pairs.tracks) += squared_errors(*H, pairs.from, pairs.to);
      seen(pairs.tracks) += 1;
    }
    return (seen > 0).select((squares / seen.max(1)).sqrt(), infinity);
  }

  /// From a first choice of tracks to one that stands still, among those that are free.
  Found settled(std::vector<int> tracks, const std::vector<int>& free) const {
    Found found;
    for (int round = 0; round < kMostRounds; ++round) {
      found.rms_px = errors_from(tracks);
      std::vector<double> own;
      own.reserve(tracks.size());
      for (const int j : tracks) own.push_back(found.rms_px[j]);
      if (own.empty()) return {};
      found.gate_px = std::clamp(options_.gate_to_median * median(std::move(own)),
                                 options_.least_gate * options_.gate_px,
                                 options_.gate_px);
      found.tracks.clear();
      for (const int j : free)
        if (found.rms_px[j] <= found.gate_px) found.tracks.push_back(j);
      if (found.tracks == tracks) break;
      tracks = found.tracks;
    }
    return found;
  }

  /// Whether its tracks stand out among those that are free.
  bool stands_out(const Found& found,
                  const std::vector<int>& free,
                  double least_over_chance) const {
    const auto just_off = std::ranges::count_if(free, [&](int j) {
      return found.rms_px[j] > found.gate_px && found.rms_px[j] <= 3 * found.gate_px;
    });
    const auto near = static_cast<double>(found.tracks.size()) + static_cast<double>(just_off);
    if (near >= kNearlyAll * track_count()) return true;
    const double chance = 0.5 * static_cast<double>(just_off);
    return static_cast<double>(found.tracks.size()) - kSpentTracks >= least_over_chance * chance;
  }

  /// Share of a plane's tracks that stay where the gate is halved, its homographies refitted.
  double stability(const std::vector<int>& tracks) const {
    const ArrayXd rms_px = errors_from(tracks);
    std::vector<double> own;
    own.reserve(tracks.size());
    for (const int j : tracks) own.push_back(rms_px[j]);
    const double gate_px = std::clamp(options_.gate_to_median * median(std::move(own)),
                                      options_.least_gate * options_.gate_px,
                                      options_.gate_px);
    std::vector<int> near;
    for (const int j : tracks)
      if (rms_px[j] <= gate_px / 2) near.push_back(j);
    const ArrayXd refitted_px = errors_from(near);
    const auto stay =
        std::ranges::count_if(tracks, [&](int j) { return refitted_px[j] <= gate_px / 2; });
    return static_cast<double>(stay) / static_cast<double>(tracks.size());
  }

  TrackPlanes planes() const {
    std::vector<int> judged;
    for (const Pairs& pairs : frames_)
      judged.insert(judged.end(), pairs.tracks.begin(), pairs.tracks.end());
    std::ranges::sort(judged);
    judged.erase(std::unique(judged.begin(), judged.end()), judged.end());
    std::vector<int> free = judged;
    std::mt19937_64 random(options_.seed);
    const int widest = widest_frame(
        points_px_, spread_frames(static_cast<int>(points_px_.size()), options_.judging_frames));
    TrackPlanes result;
    std::vector<std::vector<int>>& planes = result.planes;
    while (widest > 0 && static_cast<int>(planes.size()) < options_.most_planes) {
      const Pairs pairs = pairs_of(points_px_, widest, free);
      const Found found = settled(best_hypothesis(pairs, options_, random), free);
      const int least = planes.empty() ? options_.least_tracks : least_more();
      result.largest_refused = static_cast<int>(found.tracks.size());
      const double over_chance = planes.empty() ? kLeastOverChance : kLeastOverChanceOfMore;
      if (result.largest_refused < least || !stands_out(found, free, over_chance)) break;
      planes.push_back(found.tracks);
      std::erase_if(free, [&](int j) { return std::ranges::binary_search(found.tracks, j); });
    }
    std::ranges::stable_sort(planes,
                             [](const auto& a, const auto& b) { return a.size() > b.size(); });
    for (const std::vector<int>& plane : planes) result.stability.push_back(stability(plane));
    return result;
  }

 private:
  int least_more() const {
    return std::max(options_.least_more,
                    static_cast<int>(std::ceil(options_.least_share_more * track_count())));
  }

  const std::vector<Matrix2Xd>& points_px_;
  const PlaneOptions& options_;
  std::vector<Pairs> frames_;  ///< those that judge
};

double motion_px(const Pairs& pairs) {
  std::vector<double> lengths;
  for (Eigen::Index k = 0; k < pairs.from.cols(); ++k)
    lengths.push_back((pairs.to.col(k) - pairs.from.col(k)).norm());
  return median(std::move(lengths));
}

double explained(const TrackPlanes& found) {
  double sum = 0;
  for (const std::vector<int>& plane : found.planes) sum += static_cast<double>(plane.size());
  return sum;
}

}  // namespace

int widest_frame(const std::vector<Matrix2Xd>& points_px, const std::vector<int>& frames) {
  const std::vector<int> all = numbers_below(static_cast<int>(points_px[0].cols()));
  const Eigen::Index wanted = std::max<Eigen::Index>(kLeastSeen, points_px[0].cols() / 2);
  int widest = 0;
  double most_px = 0;
  for (const int i : frames) {
    const Pairs pairs = pairs_of(points_px, i, all);
    if (pairs.from.cols() < kLeastSeen) continue;
    if (pairs.from.cols() < wanted && widest > 0) break;
    const double px = motion_px(pairs);
    if (px < most_px) continue;
    most_px = px;
    widest = i;
  }
  return widest;
}

TrackPlanes window_planes(const std::vector<Matrix2Xd>& points_px, const PlaneOptions& options) {
  if (points_px.size() < 2 || points_px[0].cols() < kLeastSeen) return {};
  TrackPlanes fine = Search(points_px, options).planes();
  const auto judged = static_cast<double>(points_px[0].cols());
  if (explained(fine) >= kWellExplained * judged) return fine;
  // Tracks may be as noisy as the gate: then a wider one explains far more of them.
  PlaneOptions wide = options;
  wide.least_gate = 1;
  TrackPlanes coarse = Search(points_px, wide).planes();
  return explained(coarse) > kFarMore * explained(fine) ? coarse : fine;
}

}  // namespace gpo
