// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/tracking/repetition.h"

#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr int kHalfCompared = 8;       // half the side of a template [px of its level]
constexpr int kReferenceTracks = 24;   // compared in the reference image
constexpr int kStepTracks = 32;        // compared from image to image
constexpr double kLeastContrast = 64;  // least contrast of a template, one gray level
constexpr int kHalvings = 2;           // from the reference image's level to the coarsest
// Least correlation of the median track with a second place. It is 0.55 to 0.68 on random texture
// and in rooms, 0.80 to 0.99 on tiles of 26 to 75 px, bricks, dots and chessboards.
constexpr double kAlike = 0.75;
constexpr double kAlikeOnFine = 0.85;  // the same at half the size, for periods below 15 px
constexpr int kFineReach = 16;         // distance of second places there [px of its level]
constexpr double kAbout = 0.1;         // less correlation by which a nearer place looks as similar
constexpr double kLeast_px = 3;        // least distance of a second place [px of its level]
constexpr int kAround = 5;             // tracks whose median is a track's period
constexpr double kResolved_px = 6;     // least period on a level [px of the level]
constexpr double kCoarse = 0.3;  // less correlation of motions that are refined, on the first level
constexpr double kFine = 0.15;   // the same of motions that are compared, at half the size
constexpr double kLeastCompared =
    0.8;  // least correlation of a track that is compared, at half the size
// Less difference of correlations is that of resampling: one motion may be by whole pixels.
constexpr double kIndistinct = 0.01;
constexpr int kMostMotions = 12;
// The perspective changes motions by more than such a period, so that they have nothing in common.
constexpr double kShort_px = 16;
constexpr float kOutside = -2;  // value of a map where nothing was compared

std::vector<int> spread(Eigen::Index tracks, Eigen::Index count) {
  std::vector<int> some;
  const Eigen::Index step = std::max<Eigen::Index>(1, tracks / count);
  for (Eigen::Index j = 0; j < tracks; j += step) some.push_back(static_cast<int>(j));
  return some;
}

cv::Point on_level(const Vector2d& raw_px, int level) {
  const Vector2d px = std::ldexp(1.0, -level) * (raw_px.array() + 0.5) - 0.5;
  return {static_cast<int>(std::lround(px.x())), static_cast<int>(std::lround(px.y()))};
}

Vector2d from_level(const cv::Point& shift, int level) {
  return std::ldexp(1.0, level) * Vector2d(shift.x, shift.y);
}

/// Returns the largest motion on a level [px of the level].
int reach_on(int level, const SmoothedPyramid& pyramid) {
  return static_cast<int>(std::ldexp(farthest_motion_px(pyramid), -level));
}

/// Returns the correlations of the template around a place with those around another one, shifted
/// by up to `reach` along both axes; CV_32FC1. Returns an empty map if the template is not inside
/// or uniform.
cv::Mat correlation_map(const cv::Mat& from,
                        const cv::Mat& to,
                        const cv::Point& place,
                        const cv::Point& around,
                        int reach) {
  const auto square = [](const cv::Point& middle, int half) {
    return cv::Rect(middle.x - half, middle.y - half, 2 * half, 2 * half);
  };
  const cv::Rect part = square(place, kHalfCompared);
  const cv::Rect wanted = square(around, kHalfCompared + reach);
  const cv::Rect area = wanted & cv::Rect({0, 0}, to.size());
  const bool inside = (part & cv::Rect({0, 0}, from.size())) == part;
  if (!inside || std::min(area.width, area.height) < 2 * kHalfCompared) return {};
  cv::Mat pixels, searched, found;
  from(part).convertTo(pixels, CV_32F);
  pixels -= cv::mean(pixels)[0];
  if (cv::norm(pixels, cv::NORM_INF) < kLeastContrast) return {};  // correlates with all
  to(area).convertTo(searched, CV_32F);
  cv::matchTemplate(searched, pixels, found, cv::TM_CCOEFF_NORMED);
  cv::Mat map(2 * reach + 1, 2 * reach + 1, CV_32F, cv::Scalar(kOutside));
  found.copyTo(map(cv::Rect(area.tl() - wanted.tl(), found.size())));
  return map;
}

struct Peak {
  cv::Point shift;  ///< [px of the level]
  float correlation;
};

/// Returns the local maxima of a map all of whose neighbors were compared.
std::vector<Peak> peaks_of(const cv::Mat& map) {
  cv::Mat most, least;
  cv::dilate(map, most, {});
  cv::erode(map, least, {});
  std::vector<Peak> peaks;
  const cv::Point middle(map.cols / 2, map.rows / 2);
  for (int v = 1; v < map.rows - 1; ++v)
    for (int u = 1; u < map.cols - 1; ++u)
      if (map.at<float>(v, u) == most.at<float>(v, u) && least.at<float>(v, u) > kOutside)
        peaks.push_back({cv::Point(u, v) - middle, map.at<float>(v, u)});
  return peaks;
}

/// Returns the nearest place that looks about as similar as the most similar one.
std::optional<Peak> second_place(const cv::Mat& map) {
  std::vector<Peak> peaks = peaks_of(map);
  std::erase_if(peaks, [](const Peak& p) { return cv::norm(p.shift) < kLeast_px; });
  if (peaks.empty()) return std::nullopt;
  const float most = std::ranges::max_element(peaks, {}, &Peak::correlation)->correlation;
  std::erase_if(peaks, [&](const Peak& p) { return p.correlation < most - kAbout; });
  return *std::ranges::min_element(peaks, {}, [](const Peak& p) { return cv::norm(p.shift); });
}

/// Tracks between two images.
struct Crossing {
  const SmoothedPyramid& from;
  const SmoothedPyramid& to;
  const Matrix2Xd& raw_px;
  const Matrix2Xd& predicted_px;
  VectorXd farthest_px;
  std::vector<int> levels;  ///< the coarsest that resolves a track's period
};

int resolving_level(double period_px, const SmoothedPyramid& pyramid) {
  const int level = static_cast<int>(std::floor(std::log2(period_px / kResolved_px)));
  return std::clamp(level, 1, static_cast<int>(pyramid.size()) - 1);
}

/// Returns the motions, from the predicted ones, under which the tracks together correlate [px].
std::vector<Vector2d> similar_motions(const Crossing& crossing,
                                      const std::vector<int>& tracks,
                                      int level) {
  const int reach = reach_on(level, crossing.from);
  cv::Mat sum = cv::Mat::zeros(2 * reach + 1, 2 * reach + 1, CV_32F);
  cv::Mat count = cv::Mat::zeros(sum.size(), CV_32F);
  for (const int j : tracks) {
    const Vector2d there = crossing.raw_px.col(j) + crossing.predicted_px.col(j);
    const cv::Mat map = correlation_map(crossing.from[level],
                                        crossing.to[level],
                                        on_level(crossing.raw_px.col(j), level),
                                        on_level(there, level),
                                        reach);
    if (map.empty()) continue;
    const cv::Mat known = map > kOutside;
    cv::add(sum, map, sum, known);
    cv::add(count, cv::Scalar(1), count, known);
  }
  cv::Mat mean = sum / cv::max(count, 1);
  mean.setTo(kOutside, count < static_cast<double>(tracks.size()) / 3);
  std::vector<Peak> peaks = peaks_of(mean);
  std::ranges::sort(peaks, std::greater{}, &Peak::correlation);
  if (std::ssize(peaks) > kMostMotions) peaks.resize(kMostMotions);
  std::vector<Vector2d> motions{Vector2d::Zero()};
  for (const Peak& peak : peaks)
    if (peak.correlation > peaks[0].correlation - kCoarse)
      motions.push_back(from_level(peak.shift, level));
  return motions;
}

PlaceMotions refined_from(const Crossing& crossing,
                          const Vector2d& motion_px,
                          const std::vector<int>& tracks) {
  std::vector<int> levels;
  for (const int j : tracks) levels.push_back(crossing.levels[j]);
  return refined_motions(crossing.from,
                         crossing.to,
                         crossing.raw_px(Eigen::all, tracks),
                         crossing.predicted_px(Eigen::all, tracks).colwise() + motion_px,
                         levels,
                         crossing.farthest_px(tracks));
}

/// A motion of all tracks, as a difference from the predicted ones.
struct CommonMotion {
  Vector2d px;
  VectorXd correlations;  ///< one for each compared track
  double typical;         ///< their median
};

std::vector<CommonMotion> common_motions(const Crossing& crossing,
                                         const std::vector<int>& tracks,
                                         int level) {
  std::vector<CommonMotion> motions;
  for (const Vector2d& start_px : similar_motions(crossing, tracks, level)) {
    const PlaceMotions found = refined_from(crossing, start_px, tracks);
    const Matrix2Xd off_px = found.px - crossing.predicted_px(Eigen::all, tracks);
    const Vector2d px(median({off_px.row(0).begin(), off_px.row(0).end()}),
                      median({off_px.row(1).begin(), off_px.row(1).end()}));
    const VectorXd& correlations = found.correlations;
    motions.push_back({px, correlations, median({correlations.begin(), correlations.end()})});
  }
  const double most = std::ranges::max_element(motions, {}, &CommonMotion::typical)->typical;
  std::erase_if(motions, [&](const CommonMotion& m) { return m.typical < most - kFine; });
  return motions;
}

/// Returns by how many standard deviations more tracks correlate better under one motion than if
/// both fitted alike (sign test). Differences of correlations have outliers.
double margin_of(const CommonMotion& one, const CommonMotion& other) {
  if (std::abs(one.typical - other.typical) < kIndistinct) return 0;
  const auto compared = one.correlations.array().max(other.correlations.array()) > kLeastCompared;
  const auto count = static_cast<double>(compared.count());
  const auto better = static_cast<double>(
      (compared && one.correlations.array() > other.correlations.array()).count());
  return count > 0 ? (2 * better - count) / std::sqrt(count) : 0;
}

/// Returns the best motion, or, of those that are not distinguished from it, the nearest to the
/// predicted one; and its margin to those that are farther than `apart_px` from it.
std::pair<Vector2d, double> chosen_of(const std::vector<CommonMotion>& motions, double apart_px) {
  const CommonMotion& best = *std::ranges::max_element(motions, {}, &CommonMotion::typical);
  const CommonMotion* chosen = &best;
  for (const CommonMotion& motion : motions)
    if (motion.px.norm() < chosen->px.norm() && margin_of(best, motion) < kDistinctMotion)
      chosen = &motion;
  double margin = std::numeric_limits<double>::infinity();
  for (const CommonMotion& motion : motions)
    if ((motion.px - chosen->px).norm() > apart_px)
      margin = std::min(margin, margin_of(*chosen, motion));
  return {chosen->px, margin};
}

/// Searches for second places on a level, up to `reach` away along both axes [px of the level].
std::optional<Repetition> repetition_on(int level,
                                        int reach,
                                        double least_correlation,
                                        const SmoothedPyramid& reference,
                                        const Matrix2Xd& raw_px) {
  std::vector<int> alike;
  Matrix2Xd period_px(2, raw_px.cols());
  std::ptrdiff_t compared = 0;
  for (const int j : spread(raw_px.cols(), kReferenceTracks)) {
    const cv::Point place = on_level(raw_px.col(j), level);
    const cv::Mat& image = reference[level];
    const cv::Mat map = correlation_map(image, image, place, place, reach);
    if (map.empty()) continue;
    ++compared;
    const auto second = second_place(map);
    if (!second || second->correlation < least_correlation) continue;
    period_px.col(j) = from_level(second->shift, level);
    alike.push_back(j);
  }
  if (alike.empty() || 2 * std::ssize(alike) < compared) return std::nullopt;
  // A single template may miss its neighbors in the lattice, because tiles differ.
  Repetition repetition{Matrix2Xd(2, raw_px.cols())};
  for (Eigen::Index j = 0; j < raw_px.cols(); ++j) {
    const auto count = std::min<std::ptrdiff_t>(kAround, std::ssize(alike));
    std::ranges::partial_sort(alike, alike.begin() + count, {}, [&](int k) {
      return (raw_px.col(k) - raw_px.col(j)).squaredNorm();
    });
    std::vector<int> near(alike.begin(), alike.begin() + count);
    std::ranges::sort(near, {}, [&](int k) { return period_px.col(k).squaredNorm(); });
    repetition.period_px.col(j) = period_px.col(near[count / 2]);
  }
  return repetition;
}

}  // namespace

std::optional<Repetition> find_repetition(const SmoothedPyramid& reference,
                                          const Matrix2Xd& raw_px) {
  const int coarse = std::max(1, static_cast<int>(reference.size()) - 1 - kHalvings);
  auto found = repetition_on(coarse, reach_on(coarse, reference), kAlike, reference, raw_px);
  // The coarse level does not resolve short periods.
  return found || coarse == 1 ? found
                              : repetition_on(1, kFineReach, kAlikeOnFine, reference, raw_px);
}

RepeatedFlow repeated_flow(const SmoothedPyramid& from,
                           const SmoothedPyramid& to,
                           const Matrix2Xd& raw_px,
                           const Matrix2Xd& predicted_px,
                           const VectorXd& periods_px) {
  if (raw_px.cols() == 0) return {raw_px, 0};
  Crossing crossing{from, to, raw_px, predicted_px, periods_px / 3, {}};
  for (const double period_px : periods_px)
    crossing.levels.push_back(resolving_level(period_px, from));
  const double period_px = median({periods_px.begin(), periods_px.end()});
  const std::vector<CommonMotion> motions = common_motions(
      crossing, spread(raw_px.cols(), kStepTracks), resolving_level(period_px, from));
  const auto [motion_px, margin] = chosen_of(motions, period_px / 2);
  std::vector<int> all(raw_px.cols());
  std::iota(all.begin(), all.end(), 0);
  return {refined_from(crossing, motion_px, all).px, period_px < kShort_px ? 0 : margin};
}

}  // namespace gpo
