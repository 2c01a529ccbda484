// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace gpo {
namespace {

constexpr double kBlock_s = 0.25;
constexpr int kLeastBlocks = 3;
constexpr double kQuiet_rad_s = 0.02;   // standard deviation within a block, each axis
constexpr double kSteady_rad_s = 0.01;  // difference of a block's mean from the first block's
constexpr double kStill_px = 0.5;       // median image motion
constexpr double kHidden_px = 0.1;      // image motion that cannot be detected
constexpr std::size_t kLeastPoints = 15;

struct Block {
  std::size_t begin = 0, end = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double sigma = 0;  ///< largest of the axes
};

Block block_of(const Gyroscope& gyroscope, std::size_t begin, std::size_t end) {
  Block block{begin, end};
  const auto count = static_cast<double>(end - begin);
  for (std::size_t k = begin; k < end; ++k) block.mean += gyroscope.rates_rad_s[k] / count;
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  for (std::size_t k = begin; k < end; ++k)
    squares += (gyroscope.rates_rad_s[k] - block.mean).array().square() / count;
  block.sigma = std::sqrt(squares.maxCoeff());
  return block;
}

std::vector<Block> blocks_of(const Gyroscope& gyroscope) {
  const auto& times_ns = gyroscope.timestamps_ns;
  const auto length_ns = static_cast<std::int64_t>(kBlock_s * 1e9);
  std::vector<Block> blocks;
  std::size_t begin = 0;
  for (std::size_t k = 1; k < times_ns.size(); ++k) {
    if (times_ns[k] - times_ns[begin] < length_ns) continue;
    blocks.push_back(block_of(gyroscope, begin, k));
    begin = k;
  }
  return blocks;
}

Block quietest(const Gyroscope& gyroscope) {
  const std::vector<Block> blocks = blocks_of(gyroscope);
  std::size_t best_begin = 0, best_end = 0;
  for (std::size_t begin = 0; begin < blocks.size(); ++begin) {
    std::size_t end = begin;
    while (end < blocks.size() && blocks[end].sigma < kQuiet_rad_s &&
           (blocks[end].mean - blocks[begin].mean).norm() < kSteady_rad_s)
      ++end;
    if (end - begin > best_end - best_begin) {
      best_begin = begin;
      best_end = end;
    }
  }
  if (best_end - best_begin < kLeastBlocks) return {};
  return block_of(gyroscope, blocks[best_begin].begin, blocks[best_end - 1].end);
}

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

std::optional<double> moved_px(const Recording& recording, int first, int second) {
  auto lengths = recording.tracks.empty() && recording.images
                     ? images_moved_px(recording, first, second)
                     : tracks_moved_px(recording, first, second);
  if (lengths.size() < kLeastPoints) return std::nullopt;
  return median(std::move(lengths));
}

}  // namespace

std::optional<StationaryInterval> find_stationary_interval(const Recording& recording) {
  if (!recording.gyroscope) return std::nullopt;
  const Gyroscope& gyroscope = *recording.gyroscope;
  const Block quiet = quietest(gyroscope);
  if (quiet.end == 0) return std::nullopt;
  StationaryInterval rest{gyroscope.timestamps_ns[quiet.begin] - gyroscope.time_offset_ns,
                          gyroscope.timestamps_ns[quiet.end - 1] - gyroscope.time_offset_ns,
                          quiet.mean};
  const auto& frames_ns = recording.timestamps_ns;
  const auto begin = std::ranges::lower_bound(frames_ns, rest.first_ns);
  const auto end = std::ranges::upper_bound(frames_ns, rest.last_ns);
  const int first = static_cast<int>(begin - frames_ns.begin());
  const int last = static_cast<int>(end - frames_ns.begin()) - 1;
  if (last - first < kLeastBlocks) return std::nullopt;
  double most_px = kHidden_px;
  for (const int frame : {(first + last) / 2, last}) {
    const auto moved = moved_px(recording, first, frame);
    if (!moved || *moved > kStill_px) return std::nullopt;
    most_px = std::max(most_px, *moved);
  }
  const double seconds = 1e-9 * static_cast<double>(frames_ns[last] - frames_ns[first]);
  const double hidden_rad_s = most_px / recording.camera.fx / seconds;
  const auto samples = static_cast<double>(quiet.end - quiet.begin);
  rest.sigma_rad_s = std::hypot(quiet.sigma / std::sqrt(samples), hidden_rad_s);
  return rest;
}

}  // namespace gpo
