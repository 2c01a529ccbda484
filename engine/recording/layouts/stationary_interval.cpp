// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/window/gyroscope_rest.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace gpo {
namespace {

constexpr double kLeast_s = 0.3;  // between the first and the last image of the interval
constexpr int kLeastStillFrames = 4;
constexpr std::size_t kMostSpans = 10;  // tried, the longest first
constexpr double kStill_px = 0.5;       // median image motion
constexpr double kHidden_px = 0.1;      // image motion that cannot be detected
constexpr double kStillShare = 0.15;  // share of points, if something moves in front of the camera
constexpr std::size_t kLeastPoints = 15;

std::vector<double> tracks_moved_px(const Recording& recording, int first, int second) {
  std::map<std::int64_t, Eigen::Vector2d> seen;
  std::vector<double> lengths;
  for (const TrackObservation& one : recording.tracks) {
    if (one.frame == first) seen[one.track] = one.raw_px;
    const auto before = one.frame == second ? seen.find(one.track) : seen.end();
    if (before != seen.end()) lengths.push_back((one.raw_px - before->second).norm());
  }
  return lengths;
}

std::vector<double> images_moved_px(const Recording& recording, int first, int second) {
  constexpr int kCorners = 200;
  const cv::Mat from = recording.images->gray(first);
  const cv::Mat to = recording.images->gray(second);
  std::vector<cv::Point2f> corners, followed;
  cv::goodFeaturesToTrack(from, corners, kCorners, 0.01, 8);
  if (corners.empty()) return {};
  std::vector<unsigned char> found;
  std::vector<float> errors;
  cv::calcOpticalFlowPyrLK(from, to, corners, followed, found, errors);
  std::vector<double> lengths;
  for (std::size_t k = 0; k < corners.size(); ++k)
    if (found[k] != 0) lengths.push_back(cv::norm(followed[k] - corners[k]));
  return lengths;
}

std::vector<double> moved_px(const Recording& recording, int first, int second) {
  return recording.tracks.empty() && recording.images ? images_moved_px(recording, first, second)
                                                      : tracks_moved_px(recording, first, second);
}

/// Motion of the images in an interval.
struct Stillness {
  bool known = false;      ///< there are images, or tracks
  bool all = false;        ///< the images do not move
  bool parts = false;      ///< a part of the points does not, so that the camera does not turn
  double sigma_rad_s = 0;  ///< largest rotation that they do not show
};

Stillness stillness_of(const Recording& recording, std::int64_t first_ns, std::int64_t last_ns) {
  const auto& frames_ns = recording.timestamps_ns;
  const auto begin = std::ranges::lower_bound(frames_ns, first_ns);
  const auto end = std::ranges::upper_bound(frames_ns, last_ns);
  const int first = static_cast<int>(begin - frames_ns.begin());
  const int last = static_cast<int>(end - frames_ns.begin()) - 1;
  if (last - first + 1 < kLeastStillFrames) return {};
  const double seconds = 1e-9 * static_cast<double>(frames_ns[last] - frames_ns[first]);
  if (seconds < kLeast_s) return {};
  Stillness still{.known = true, .all = true, .parts = true};
  double most_px = kHidden_px;
  for (const int frame : {(first + last) / 2, last}) {
    const std::vector<double> lengths = moved_px(recording, first, frame);
    if (lengths.size() < kLeastPoints) return {};
    const auto count = std::ranges::count_if(lengths, [](double px) { return px < kStill_px; });
    still.parts = still.parts && count >= std::ssize(lengths) * kStillShare &&
                  count >= static_cast<std::ptrdiff_t>(kLeastPoints);
    const double middle_px = median(lengths);
    still.all = still.all && middle_px <= kStill_px;
    most_px = std::max(most_px, std::min(middle_px, kStill_px));
  }
  still.sigma_rad_s = most_px / recording.camera.fx / seconds;
  return still;
}

}  // namespace

std::optional<StationaryInterval> find_stationary_interval(const Recording& recording) {
  if (!recording.gyroscope) return std::nullopt;
  const Gyroscope& gyroscope = *recording.gyroscope;
  std::vector<QuietSpan> spans = quiet_spans(gyroscope);
  spans.resize(std::min(spans.size(), kMostSpans));
  for (const QuietSpan& span : spans) {
    StationaryInterval rest{gyroscope.timestamps_ns[span.begin] - gyroscope.time_offset_ns,
                            gyroscope.timestamps_ns[span.end - 1] - gyroscope.time_offset_ns,
                            span.mean_rad_s};
    const Stillness still = stillness_of(recording, rest.first_ns, rest.last_ns);
    const auto sensors = sensors_at_rest(gyroscope, span.begin, span.end);
    const bool sensors_alone = !still.known && sensors && sensors->mean_m_s2;
    if (!still.all && !(still.parts && sensors) && !sensors_alone) continue;
    const double noise_rad_s =
        span.sigma_rad_s / std::sqrt(static_cast<double>(span.end - span.begin));
    rest.sigma_rad_s = std::hypot(noise_rad_s, still.sigma_rad_s, kRestBiasSigma_rad_s);
    return rest;
  }
  return std::nullopt;
}

}  // namespace gpo
