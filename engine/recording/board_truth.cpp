// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board_truth.h"

#include "engine/recording/board_cache.h"
#include "engine/recording/board_corners.h"
#include "engine/recording/board_pose.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <mutex>
#include <numeric>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {

namespace {

constexpr double kMostTimesMedian = 4;
constexpr double kAlwaysGoodPx = 0.5;  ///< a blurred frame among very sharp ones is no mistake
constexpr int kMedianFrames = 30;

/// Looks for the board in the pictures of some frames, on all processors.
class BoardSearch {
 public:
  BoardSearch(const Recording& recording, std::vector<int> frames, std::stop_token stop)
      : recording_(recording), frames_(std::move(frames)), stop_(std::move(stop)) {}

  /// Throws what decoding throws; `views` has what was found until then.
  void run(BoardViews& views, const std::function<void()>& told) {
    const auto count = static_cast<unsigned>(frames_.size());
    {
      std::vector<std::jthread> helpers;
      for (unsigned i = 1; i < std::min(count, std::thread::hardware_concurrency()); ++i) {
        helpers.emplace_back([&] { work(views, told); });
      }
      work(views, told);
    }
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void work(BoardViews& views, const std::function<void()>& told) {
    try {
      while (const auto frame = next()) {
        cv::Mat gray;
        cv::cvtColor(frame->bgr, gray, cv::COLOR_BGR2GRAY);
        const Board& board = *recording_.board;
        const auto pose = board_pose(find_board(gray, board), board, recording_.camera);
        const std::scoped_lock lock(mutex_);
        views[frame->index] = pose;
        told();
      }
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      error_ = std::current_exception();
    }
  }

  struct Frame {
    int index;
    cv::Mat bgr;
  };
  /// Decoded in the order of the frames: a video goes backward only from its beginning again.
  std::optional<Frame> next() {
    const std::scoped_lock lock(decoding_);
    if (next_ == frames_.size() || stop_.stop_requested() || failed()) return std::nullopt;
    const int index = frames_[next_++];
    return Frame{index, recording_.pictures->bgr(index)};
  }

  bool failed() {
    const std::scoped_lock lock(mutex_);
    return error_ != nullptr;
  }

  const Recording& recording_;
  std::vector<int> frames_;
  std::stop_token stop_;
  std::size_t next_ = 0;
  std::mutex decoding_;
  std::mutex mutex_;  ///< of the views and of the error
  std::exception_ptr error_;
};

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
  const auto save = [&] {
    if (cache && !found.empty()) save_board_views(*cache, found);
  };
  try {
    BoardSearch(recording, missing, stop).run(found, [&] {
      ++done;
      if (progress) progress(done, of);
    });
  } catch (...) {
    save();
    throw;
  }
  save();
  views.merge(found);
  return views;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
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
  truth.source = board.markers ? "ChArUco board" : "chessboard";
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
