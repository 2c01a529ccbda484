// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/board_truth.h"

#include "engine/geometry/statistics.h"
#include "engine/recording/board/board_cache.h"
#include "engine/recording/board/board_corners.h"
#include "engine/recording/board/board_pose.h"
#include "engine/recording/pictures/each_picture.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <opencv2/core.hpp>

namespace gpo {

namespace {

constexpr double kMostTimesMedian = 4;
constexpr double kAlwaysGoodPx = 0.5;  ///< a blurred frame among very sharp ones is no mistake
constexpr int kMedianFrames = 30;

/// From the cache, and from the pictures where the cache has none.
BoardViews look_at(const Recording& recording,
                   const std::vector<int>& frames,
                   const std::stop_token& stop,
                   const BoardProgress& progress) {
  const auto cache = board_cache_file(recording);
  BoardViews views = cache ? load_board_views(*cache) : BoardViews{};
  std::vector<int> missing;
  for (const int frame : frames) {
    if (!views.contains(frame)) missing.push_back(frame);
  }
  if (missing.empty()) return views;
  const int of = static_cast<int>(frames.size());
  int done = of - static_cast<int>(missing.size());
  BoardViews found;
  std::mutex mutex;
  const auto look = [&](int frame, const cv::Mat& gray) {
    const Board& board = *recording.board;
    const auto pose = board_pose(find_board(gray, board), board, recording.camera);
    const std::scoped_lock lock(mutex);
    found[frame] = pose;
    if (progress) progress(++done, of);
  };
  const auto save = [&] {
    if (cache && !found.empty()) save_board_views(*cache, found);
  };
  try {
    for_each_picture(*recording.pictures, missing, stop, look);
  } catch (...) {
    save();
    throw;
  }
  save();
  views.merge(found);
  return views;
}

/// The RMS above which a fit is taken for a mistake [px].
double largest_rms_px(const BoardViews& views, std::span<const int> frames) {
  std::vector<double> rms_px;
  for (const int frame : frames) {
    const auto view = views.find(frame);
    if (view != views.end() && view->second) rms_px.push_back(view->second->uncertainty.rms_px);
  }
  if (rms_px.empty()) return std::numeric_limits<double>::infinity();
  return std::max(kAlwaysGoodPx, kMostTimesMedian * median(std::move(rms_px)));
}

/// The symmetric pose that is nearest in rotation.
Pose nearest(const Pose& pose, const std::vector<Pose>& symmetries, const Pose& last) {
  const auto turned = [&](const Pose& symmetry) {
    return so3_log(last.R_wc.transpose() * symmetry.R_wc * pose.R_wc).norm();
  };
  return *std::min_element(symmetries.begin(), symmetries.end(), [&](const Pose& a, const Pose& b) {
    return turned(a) < turned(b);
  }) * pose;
}

GroundTruth in_one_frame(const BoardViews& views,
                         std::span<const int> frames,
                         const Board& board,
                         double most_rms_px) {
  GroundTruth truth;
  truth.source = board_title(board);
  truth.poses.resize(frames.size());
  truth.uncertainties.resize(frames.size());
  const auto symmetries = board_symmetries(board);
  std::optional<Pose> last;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto view = views.find(frames[i]);
    if (view == views.end() || !view->second) continue;
    const BoardPose& found = *view->second;
    if (found.uncertainty.rms_px > most_rms_px) continue;
    last = last ? nearest(found.pose, symmetries, *last) : found.pose;
    truth.poses[i] = last;
    truth.uncertainties[i] = found.uncertainty;
  }
  return truth;
}

}  // namespace

GroundTruth board_truth(const Recording& recording,
                        const std::vector<int>& frames,
                        const std::stop_token& stop,
                        const BoardProgress& progress) {
  const BoardViews views = look_at(recording, frames, stop, progress);
  return in_one_frame(views, frames, *recording.board, largest_rms_px(views, frames));
}

GroundTruth board_truth(const Recording& recording,
                        int start,
                        int frames,
                        const std::stop_token& stop,
                        const BoardProgress& progress) {
  const int left = recording.frame_count() - start;
  std::vector<int> looked_at(std::max(frames, std::min(kMedianFrames, left)));
  std::iota(looked_at.begin(), looked_at.end(), start);
  const BoardViews views = look_at(recording, looked_at, stop, progress);
  const std::span<const int> all = looked_at;
  const double most_rms_px = largest_rms_px(views, all.first(std::min(kMedianFrames, left)));
  return in_one_frame(views, all.first(frames), *recording.board, most_rms_px);
}

std::optional<PoseUncertainty> median_uncertainty(
    std::span<const std::optional<PoseUncertainty>> uncertainties) {
  const auto known = [](const auto& one) { return one.has_value(); };
  if (std::none_of(uncertainties.begin(), uncertainties.end(), known)) return std::nullopt;
  const auto of = [&](double PoseUncertainty::*number) {
    std::vector<double> values;
    for (const auto& one : uncertainties) {
      if (one) values.push_back((*one).*number);
    }
    return median(std::move(values));
  };
  return PoseUncertainty{of(&PoseUncertainty::rms_px),
                         of(&PoseUncertainty::position_sigma_m),
                         of(&PoseUncertainty::rotation_sigma_deg),
                         of(&PoseUncertainty::normal_sigma_deg)};
}

std::string uncertainty_text(const PoseUncertainty& uncertainty) {
  return fmt::format(
      "{:.2g} mm, {:.2g} deg, its normal {:.2g} deg (one standard deviation; fit {:.2f} px RMS)",
      1e3 * uncertainty.position_sigma_m,
      uncertainty.rotation_sigma_deg,
      uncertainty.normal_sigma_deg,
      uncertainty.rms_px);
}

}  // namespace gpo
