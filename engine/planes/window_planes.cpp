// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/homography.h"
#include "engine/geometry/statistics.h"
#include "engine/planes/inliers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::ArrayXd;
using Eigen::Matrix2Xd;
using Eigen::Matrix3d;

constexpr double kLeastGate = 0.6;        // share of the gate below which every track agrees
constexpr double kGateToMedian = 2;       // gate in between, in medians of the plane's own tracks
constexpr int kJudgingFrames = 6;         // in which tracks are judged, spread over the window
constexpr int kLeastHypotheses = 300;     // from four neighboring tracks, for each plane
constexpr int kMostHypotheses = 3000;     // if few tracks agree with the best one
constexpr int kLeastTracks = 8;           // on the first plane
constexpr int kLeastMore = 18;            // on each further one
constexpr double kLeastShareMore = 0.06;  // share of all tracks of each further one
constexpr std::size_t kMostPlanes = 5;
constexpr int kLeastSeen = 8;
constexpr int kMostRounds = 8;
constexpr double kGoodDraws = 25;
/// Least ratio of a plane's tracks to those expected by chance: half of the tracks that miss its
/// gate by up to twice the gate. The best hypothesis for a cloud of points reaches two to three.
constexpr double kLeastOverChance = 4.8;
constexpr double kLeastOverChanceOfMore = 2.5;  // for a further plane
constexpr int kSpentTracks = 4;                 // any four tracks have a homography
constexpr double kNearlyAll = 0.9;              // share near one plane: they are noisy, not off it
constexpr double kWellExplained = 0.5;          // share of the tracks that planes explain
constexpr double kFarMore = 1.3;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Pairs {
  std::vector<int> tracks;
  Matrix2Xd from, to;  ///< in the reference frame and in a later one [px]
  ArrayXd variance;    ///< squared factors of the gate (`Window::gate_factor`)
};

/// Tracks with the noise of their observations (`Window::noise_ratio`).
struct Points {
  const std::vector<Matrix2Xd>& px;
  const std::vector<Eigen::VectorXd>& noise_ratio;
};

Pairs pairs_of(const Points& points, int frame, const std::vector<int>& among) {
  Pairs pairs;
  for (const int j : among)
    if (points.px[0].col(j).allFinite() && points.px[frame].col(j).allFinite())
      pairs.tracks.push_back(j);
  pairs.from = points.px[0](Eigen::all, pairs.tracks);
  pairs.to = points.px[frame](Eigen::all, pairs.tracks);
  pairs.variance = ArrayXd::Ones(std::ssize(pairs.tracks));
  if (!points.noise_ratio.empty())
    pairs.variance = (0.5 * (points.noise_ratio[0](pairs.tracks).array().square() +
                             points.noise_ratio[frame](pairs.tracks).array().square()))
                         .max(1);
  return pairs;
}

std::vector<int> numbers_below(int count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::vector<int> spread_frames(int frames) {
  const int n = std::min(kJudgingFrames, frames - 1);
  std::vector<int> chosen;
  for (int k = 1; k <= n; ++k) chosen.push_back((frames - 1) * k / n);
  return chosen;
}

/// Returns squared transfer errors over their relative variance [px^2]; infinite if H maps a point
/// behind the camera.
ArrayXd squared_errors(const Matrix3d& H, const Pairs& pairs) {
  const auto& [tracks, from, to, variance] = pairs;
  const auto x = from.row(0).array();
  const auto y = from.row(1).array();
  const Eigen::Array<double, 1, Eigen::Dynamic> depth = H(2, 0) * x + H(2, 1) * y + H(2, 2);
  const auto u = (H(0, 0) * x + H(0, 1) * y + H(0, 2)) / depth - to.row(0).array();
  const auto v = (H(1, 0) * x + H(1, 1) * y + H(1, 2)) / depth - to.row(1).array();
  return (depth * H(2, 2) > 0).select(u * u + v * v, kInfinity).transpose() / variance;
}

double motion_px(const Pairs& pairs) {
  const Eigen::RowVectorXd lengths = (pairs.to - pairs.from).colwise().norm();
  return median({lengths.begin(), lengths.end()});
}

/// The frame with the largest median motion among those that see half of all tracks; else 0.
int widest_frame(const Points& points) {
  const std::vector<Matrix2Xd>& points_px = points.px;
  const std::vector<int> all = numbers_below(static_cast<int>(points_px[0].cols()));
  const Eigen::Index wanted = std::max<Eigen::Index>(kLeastSeen, points_px[0].cols() / 2);
  int widest = 0;
  double most_px = 0;
  for (const int i : spread_frames(static_cast<int>(points_px.size()))) {
    const Pairs pairs = pairs_of(points, i, all);
    if (pairs.from.cols() < kLeastSeen) continue;
    if (pairs.from.cols() < wanted && widest > 0) break;
    const double px = motion_px(pairs);
    if (px < most_px) continue;
    most_px = px;
    widest = i;
  }
  return widest;
}

/// Scores hypotheses by all pairs, thousands of times: single precision, no allocation.
class Judge {
 public:
  Judge(const Pairs& pairs, double gate_px)
      : x_(pairs.from.row(0).cast<float>().transpose()),
        y_(pairs.from.row(1).cast<float>().transpose()),
        u_(pairs.to.row(0).cast<float>().transpose()),
        v_(pairs.to.row(1).cast<float>().transpose()),
        over_gate_px2_((1 / (gate_px * gate_px) / pairs.variance).cast<float>()) {}

  /// MSAC (Torr and Zisserman 2000) rather than a count: at little parallax one homography is near
  /// the tracks of two planes, but exact for those of one.
  double score(const Matrix3d& hypothesis) {
    const Eigen::Matrix3f H = (hypothesis / hypothesis(2, 2)).cast<float>();
    depth_ = H(2, 0) * x_ + H(2, 1) * y_ + H(2, 2);
    du_ = (H(0, 0) * x_ + H(0, 1) * y_ + H(0, 2)) / depth_ - u_;
    dv_ = (H(1, 0) * x_ + H(1, 1) * y_ + H(1, 2)) / depth_ - v_;
    const auto loss = 1 - over_gate_px2_ * (du_.square() + dv_.square());
    return (depth_ > 0).select(loss.max(0), 0).sum();
  }

 private:
  Eigen::ArrayXf x_, y_, u_, v_;
  Eigen::ArrayXf over_gate_px2_;  ///< 1 / squared gate
  Eigen::ArrayXf depth_, du_, dv_;
};

std::vector<std::vector<int>> neighborhoods(const Pairs& pairs) {
  const int n = static_cast<int>(pairs.tracks.size());
  const int size = std::min(std::max(3, n / 4), n - 1);
  // Precomputed distances, as sorting compares them thousands of times.
  std::vector<std::pair<double, int>> others(n - 1);  // squared distance [px^2], pair
  std::vector<std::vector<int>> near(n);
  for (int k = 0; k < n; ++k) {
    for (int j = 0, at = 0; j < n; ++j)
      if (j != k) others[at++] = {(pairs.from.col(j) - pairs.from.col(k)).squaredNorm(), j};
    const auto nearest = others.begin() + std::min(size, n - 2);
    std::ranges::nth_element(others, nearest, {}, &std::pair<double, int>::first);
    for (int j = 0; j < size; ++j) near[k].push_back(others[j].second);
  }
  return near;
}

/// Hypotheses for about ten good samples of a plane with this share of the tracks.
int hypotheses_needed(double share) {
  const double wanted = kGoodDraws / (share * share * share);
  return wanted < kMostHypotheses ? std::max(kLeastHypotheses, static_cast<int>(wanted))
                                  : kMostHypotheses;
}

std::vector<int> best_hypothesis(const Pairs& pairs, double gate_px, std::mt19937_64& random) {
  const int n = static_cast<int>(pairs.tracks.size());
  if (n < kLeastSeen) return {};
  const auto near = neighborhoods(pairs);
  const auto draw = [&](std::size_t below) { return static_cast<std::size_t>(random() % below); };
  Judge judge(pairs, gate_px);
  double most = 0;
  ArrayXd best;
  int needed = kMostHypotheses;
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
    best = squared_errors(H, pairs);
    const auto agreeing = static_cast<double>((best <= gate_px * gate_px).count());
    needed = hypotheses_needed(agreeing / n);
  }
  std::vector<int> tracks;
  for (int k = 0; k < best.size(); ++k)
    if (best[k] <= gate_px * gate_px) tracks.push_back(pairs.tracks[k]);
  return tracks;
}

struct FoundPlane {
  std::vector<int> tracks;
  ArrayXd rms_px;  ///< one per track, over the judging frames that see it; infinite: none does
  double gate_px = 0;
};

class Search {
 public:
  Search(const Points& points, double least_gate_px, double gate_px)
      : points_(points), least_gate_px_(least_gate_px), gate_px_(gate_px) {
    for (const int i : spread_frames(static_cast<int>(points.px.size())))
      frames_.push_back(pairs_of(points, i, numbers_below(track_count())));
  }

  int track_count() const { return static_cast<int>(points_.px[0].cols()); }

  /// Returns every track's RMS transfer error by refitted homographies; infinite if a fit fails.
  ArrayXd errors_from(const std::vector<int>& tracks) const {
    std::vector<bool> chosen(track_count(), false);
    for (const int j : tracks) chosen[j] = true;
    ArrayXd squares = ArrayXd::Zero(track_count());
    ArrayXd seen = ArrayXd::Zero(track_count());
    for (const Pairs& pairs : frames_) {
      std::vector<int> own;
      for (int k = 0; k < static_cast<int>(pairs.tracks.size()); ++k)
        if (chosen[pairs.tracks[k]]) own.push_back(k);
      if (static_cast<int>(own.size()) < kLeastSeen) continue;
      // The algebraic fit is accurate enough for a gate of pixels, in a fifth of the time.
      const auto H = fit_homography(pairs.from(Eigen::all, own), pairs.to(Eigen::all, own));
      if (!H) return ArrayXd::Constant(track_count(), kInfinity);
      squares(pairs.tracks) += squared_errors(*H, pairs);
      seen(pairs.tracks) += 1;
    }
    return (seen > 0).select((squares / seen.max(1)).sqrt(), kInfinity);
  }

  double gate_of(const std::vector<int>& tracks, const ArrayXd& rms_px) const {
    const ArrayXd own = rms_px(tracks);
    return std::clamp(kGateToMedian * median({own.begin(), own.end()}), least_gate_px_, gate_px_);
  }

  FoundPlane settled(std::vector<int> tracks, const std::vector<int>& free) const {
    FoundPlane found;
    for (int round = 0; round < kMostRounds; ++round) {
      if (tracks.empty()) return {};
      found.rms_px = errors_from(tracks);
      found.gate_px = gate_of(tracks, found.rms_px);
      found.tracks.clear();
      for (const int j : free)
        if (found.rms_px[j] <= found.gate_px) found.tracks.push_back(j);
      if (found.tracks == tracks) break;
      tracks = found.tracks;
    }
    return found;
  }

  bool stands_out(const FoundPlane& found,
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

  /// Share of a plane's tracks that remain at half the gate, with refitted homographies.
  double stability(const std::vector<int>& tracks) const {
    const ArrayXd rms_px = errors_from(tracks);
    const double gate_px = gate_of(tracks, rms_px);
    std::vector<int> near;
    for (const int j : tracks)
      if (rms_px[j] <= gate_px / 2) near.push_back(j);
    const ArrayXd refitted_px = errors_from(near);
    const auto stay =
        std::ranges::count_if(tracks, [&](int j) { return refitted_px[j] <= gate_px / 2; });
    return static_cast<double>(stay) / static_cast<double>(tracks.size());
  }

  TrackPlanes planes(std::uint64_t seed) const {
    std::vector<int> judged;
    for (const Pairs& pairs : frames_)
      judged.insert(judged.end(), pairs.tracks.begin(), pairs.tracks.end());
    std::ranges::sort(judged);
    judged.erase(std::unique(judged.begin(), judged.end()), judged.end());
    std::vector<int> free = judged;
    std::mt19937_64 random(seed);
    const int widest = widest_frame(points_);
    TrackPlanes result;
    std::vector<std::vector<int>>& planes = result.planes;
    while (widest > 0 && planes.size() < kMostPlanes) {
      const Pairs pairs = pairs_of(points_, widest, free);
      const FoundPlane found = settled(best_hypothesis(pairs, least_gate_px_, random), free);
      const int least = planes.empty() ? kLeastTracks : least_more();
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
    return std::max(kLeastMore, static_cast<int>(std::ceil(kLeastShareMore * track_count())));
  }

  const Points points_;
  double least_gate_px_, gate_px_;
  std::vector<Pairs> frames_;  ///< judging frames
};

double explained(const TrackPlanes& found) {
  double sum = 0;
  for (const std::vector<int>& plane : found.planes) sum += static_cast<double>(plane.size());
  return sum;
}

/// `noise_ratio` as `Window::noise_ratio`.
TrackPlanes planes_of(const std::vector<Matrix2Xd>& points_px,
                      double gate_px,
                      std::uint64_t seed,
                      const std::vector<Eigen::VectorXd>& noise_ratio) {
  if (points_px.size() < 2 || points_px[0].cols() < kLeastSeen) return {};
  const Points points{points_px, noise_ratio};
  TrackPlanes fine = Search(points, kLeastGate * gate_px, gate_px).planes(seed);
  const auto judged = static_cast<double>(points_px[0].cols());
  if (explained(fine) >= kWellExplained * judged) return fine;
  // Tracks may be as noisy as the gate: then a wider gate explains far more of them.
  TrackPlanes coarse = Search(points, gate_px, gate_px).planes(seed);
  return explained(coarse) > kFarMore * explained(fine) ? coarse : fine;
}

}  // namespace

std::vector<PlaneErrors> plane_errors(const Window& window) {
  std::vector<PlaneErrors> planes;
  const Search search({window.points_px, window.noise_ratio},
                      kLeastGate * window.threshold_px,
                      window.threshold_px);
  for (const WindowPlane& plane : window.planes) {
    const ArrayXd rms_px = search.errors_from(plane.tracks);
    // The search may have used the wider gate, or have stopped before it settled.
    const double worst_px = rms_px(plane.tracks).maxCoeff();
    planes.push_back({rms_px.matrix(), std::max(search.gate_of(plane.tracks, rms_px), worst_px)});
  }
  return planes;
}

TrackPlanes window_planes(const std::vector<Matrix2Xd>& points_px,
                          double gate_px,
                          std::uint64_t seed,
                          const std::vector<Eigen::VectorXd>& noise_ratio,
                          const std::vector<bool>& on_first_plane) {
  if (on_first_plane.empty()) return planes_of(points_px, gate_px, seed, noise_ratio);
  const auto planes_among = [&](bool on_first) {
    std::vector<int> chosen;
    for (int j = 0; j < std::ssize(on_first_plane); ++j)
      if (on_first_plane[j] == on_first) chosen.push_back(j);
    std::vector<Matrix2Xd> points;
    for (const Matrix2Xd& frame : points_px) points.emplace_back(frame(Eigen::all, chosen));
    std::vector<Eigen::VectorXd> ratios;
    for (const Eigen::VectorXd& frame : noise_ratio) ratios.emplace_back(frame(chosen));
    TrackPlanes found = planes_of(points, gate_px, seed, ratios);
    for (std::vector<int>& plane : found.planes)
      std::ranges::transform(plane, plane.begin(), [&](int k) { return chosen[k]; });
    return found;
  };
  TrackPlanes found = planes_among(true);
  if (found.planes.empty()) return found;
  const TrackPlanes others = planes_among(false);
  found.planes.resize(1);
  found.stability.resize(1);
  found.planes.insert(found.planes.end(), others.planes.begin(), others.planes.end());
  found.stability.insert(found.stability.end(), others.stability.begin(), others.stability.end());
  return found;
}

}  // namespace gpo
