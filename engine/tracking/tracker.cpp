// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/tracking/tracker.h"

#include "engine/tracking/repetition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace gpo {
namespace {

constexpr double kLost = std::numeric_limits<double>::quiet_NaN();

constexpr int kGridColumns = 10;  // cells over which corners are spread
constexpr int kGridRows = 8;
constexpr int kMostPerCell = 3;      // corners of a cell, the strongest
constexpr int kThreshold = 20;       // FAST threshold [gray levels]
constexpr int kWeakThreshold = 7;    // in a cell without a corner at `kThreshold` [gray levels]
constexpr int kBorder_px = 12;       // least distance from the image border
constexpr double kSpacing = 0.014;   // least distance between corners [image widths]
constexpr int kSubpixelHalf_px = 5;  // half the side of the window of the sub-pixel search

constexpr int kWindow_px = 21;                // side of the patch that is compared
constexpr int kPyramidLevels = 4;             // besides the full image, up to 1280x960
constexpr double kMostForwardBackward = 0.5;  // distance after tracking there and back [patch_unit]

std::vector<cv::KeyPoint> fast_corners(const cv::Mat& gray, const cv::Rect& cell, int threshold) {
  // FAST needs a circle of radius 3 around each pixel, so the cell is widened.
  const cv::Rect wide = cv::Rect(cell.x - 3, cell.y - 3, cell.width + 6, cell.height + 6) &
                        cv::Rect(0, 0, gray.cols, gray.rows);
  std::vector<cv::KeyPoint> corners;
  cv::FAST(gray(wide), corners, threshold, true);
  for (cv::KeyPoint& corner : corners) corner.pt += cv::Point2f(wide.tl());
  std::erase_if(corners, [&](const cv::KeyPoint& k) { return !cell.contains(cv::Point(k.pt)); });
  return corners;
}

std::vector<cv::KeyPoint> corners_of_cell(const cv::Mat& gray, const cv::Rect& cell) {
  std::vector<cv::KeyPoint> corners = fast_corners(gray, cell, kThreshold);
  if (corners.empty()) corners = fast_corners(gray, cell, kWeakThreshold);
  std::ranges::sort(corners, [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
    return std::tuple(-a.response, a.pt.y, a.pt.x) < std::tuple(-b.response, b.pt.y, b.pt.x);
  });
  return corners;
}

using Pyramid = std::vector<cv::Mat>;

int pyramid_levels(const cv::Size& size) {
  const double octaves = std::log2(std::hypot(size.width, size.height) / 1600);
  return kPyramidLevels + std::max(0, static_cast<int>(std::ceil(octaves)));
}

Pyramid build_pyramid(const cv::Mat& gray) {
  Pyramid pyramid;
  cv::buildOpticalFlowPyramid(
      gray, pyramid, cv::Size(kWindow_px, kWindow_px), pyramid_levels(gray.size()));
  return pyramid;
}

struct Flow {
  std::vector<cv::Point2f> points;  ///< NaN if KLT fails or leaves the image
  std::vector<bool> left;           ///< left the image
};

Flow flow(const Pyramid& from, const Pyramid& to, const std::vector<cv::Point2f>& points) {
  Flow result;
  std::vector<cv::Point2f>& found = result.points;
  std::vector<unsigned char> status;
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01);
  cv::calcOpticalFlowPyrLK(from,
                           to,
                           points,
                           found,
                           status,
                           cv::noArray(),
                           cv::Size(kWindow_px, kWindow_px),
                           pyramid_levels(to.front().size()),
                           until);
  const cv::Size size = to.front().size();
  for (std::size_t j = 0; j < found.size(); ++j) {
    // KLT reports success for some points outside of the image (OpenCV issue 4799).
    const bool inside = found[j].x >= 0 && found[j].y >= 0 &&
                        found[j].x <= static_cast<float>(size.width - 1) &&
                        found[j].y <= static_cast<float>(size.height - 1);
    result.left.push_back(!inside);
    if (status[j] == 0 || !inside) found[j] = cv::Point2f(std::nanf(""), std::nanf(""));
  }
  return result;
}

/// Reason for losing a track that KLT found `there` (NaN: nowhere); nullopt if it is not lost.
std::optional<TrackEnd> end_of(const cv::Point2f& there,
                               bool left,
                               double distance_px,
                               double most_px) {
  if (std::isnan(there.x))
    return TrackEnd{.reason = left ? LossReason::left_image : LossReason::no_flow};
  if (std::isnan(distance_px)) return TrackEnd{.reason = LossReason::no_flow};
  if (distance_px <= most_px) return std::nullopt;
  return TrackEnd{.reason = LossReason::forward_backward, .value = distance_px, .limit = most_px};
}

FollowedTracks follow(const Pyramid& from,
                      const Pyramid& to,
                      const Eigen::Matrix2Xd& before,
                      double most_px) {
  std::vector<int> living;
  std::vector<cv::Point2f> points;
  for (int j = 0; j < before.cols(); ++j) {
    if (!before.col(j).allFinite()) continue;
    living.push_back(j);
    points.emplace_back(static_cast<float>(before(0, j)), static_cast<float>(before(1, j)));
  }
  FollowedTracks after(before.cols());
  if (living.empty()) return after;
  const Flow forward = flow(from, to, points);
  std::vector<cv::Point2f> safe = forward.points;  // KLT does not expect NaN
  std::ranges::replace_if(
      safe, [](const cv::Point2f& p) { return std::isnan(p.x); }, cv::Point2f(0, 0));
  const Flow back = flow(to, from, safe);
  for (std::size_t k = 0; k < living.size(); ++k) {
    const int j = living[k];
    const cv::Point2f& there = forward.points[k];
    const double distance_px = cv::norm(back.points[k] - points[k]);
    if (!std::isnan(there.x)) after.forward_backward_px[j] = distance_px;
    after.ends[j] = end_of(there, forward.left[k], distance_px, most_px);
    if (!after.ends[j]) after.raw_px.col(j) << there.x, there.y;
  }
  return after;
}

/// `earlier` has the tracks one frame before `before`.
FollowedTracks follow(const SmoothedPyramid& from,
                      const SmoothedPyramid& to,
                      const Eigen::Matrix2Xd& before,
                      const Eigen::Matrix2Xd& earlier,
                      Anchors& anchors,
                      std::optional<Repetition>& repetition) {
  std::vector<int> living;
  for (int j = 0; j < before.cols(); ++j)
    if (before.col(j).allFinite()) living.push_back(j);
  Eigen::Matrix2Xd flow_px = Eigen::Matrix2Xd::Constant(2, before.cols(), kLost);
  const Eigen::Matrix2Xd places = before(Eigen::all, living);
  if (repetition) {
    const Eigen::Matrix2Xd predicted_px = places - earlier(Eigen::all, living);
    const RepeatedFlow flow =
        repeated_flow(from, to, places, predicted_px, anchors.periods_px(living));
    flow_px(Eigen::all, living) = flow.px;
    repetition->margins.push_back(flow.margin);
  } else {
    flow_px(Eigen::all, living) = coarse_flow(from, to, places);
  }
  return align_tracks(anchors, to.front(), before, flow_px, anchor_options(anchors.camera));
}

void append(FollowedTracks followed, Tracks& tracks) {
  for (std::size_t j = 0; j < followed.ends.size(); ++j) {
    if (!followed.ends[j]) continue;
    tracks.ends[j] = followed.ends[j];
    tracks.ends[j]->frame = tracks.frame_count();
  }
  tracks.raw_px.push_back(std::move(followed.raw_px));
  tracks.forward_backward_px.push_back(std::move(followed.forward_backward_px));
}

}  // namespace

Eigen::Matrix2Xd detect_corners(const cv::Mat& gray) {
  const double spacing_px = kSpacing * gray.cols;
  std::vector<cv::Point2f> corners;
  const auto is_free = [&](const cv::Point2f& p) {
    return std::ranges::none_of(corners,
                                [&](const cv::Point2f& q) { return cv::norm(p - q) < spacing_px; });
  };
  const int width = gray.cols - 2 * kBorder_px;
  const int height = gray.rows - 2 * kBorder_px;
  const auto grid_point = [&](int column, int row) {
    return cv::Point(kBorder_px + width * column / kGridColumns,
                     kBorder_px + height * row / kGridRows);
  };
  for (int row = 0; row < kGridRows; ++row) {
    for (int column = 0; column < kGridColumns; ++column) {
      const cv::Rect cell(grid_point(column, row), grid_point(column + 1, row + 1));
      int taken = 0;
      for (const cv::KeyPoint& corner : corners_of_cell(gray, cell)) {
        if (taken == kMostPerCell) break;
        if (!is_free(corner.pt)) continue;
        corners.push_back(corner.pt);
        ++taken;
      }
    }
  }
  if (corners.empty()) return Eigen::Matrix2Xd(2, 0);
  cv::cornerSubPix(gray,
                   corners,
                   cv::Size(kSubpixelHalf_px, kSubpixelHalf_px),
                   cv::Size(-1, -1),
                   cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.01));
  Eigen::Matrix2Xd raw_px(2, corners.size());
  for (std::size_t j = 0; j < corners.size(); ++j) raw_px.col(j) << corners[j].x, corners[j].y;
  return raw_px;
}

WindowTracker::WindowTracker(const Camera& camera, Tracking tracking, int start) : camera_(camera) {
  tracks_.start = start;
  tracks_.anchored = tracking == Tracking::anchored;
}

void WindowTracker::add(const cv::Mat& gray) {
  const bool anchored = tracks_.anchored;
  Pyramid next = anchored ? smoothed_pyramid(gray) : build_pyramid(gray);
  if (tracks_.raw_px.empty()) {
    tracks_.raw_px.push_back(detect_corners(gray));
    for (int j = 0; j < tracks_.raw_px[0].cols(); ++j) tracks_.ids.push_back(j);
    tracks_.forward_backward_px.emplace_back(
        Eigen::VectorXd::Constant(tracks_.track_count(), kLost));
    tracks_.ends.resize(tracks_.track_count());
    if (anchored) {
      anchors_ = make_anchors(next.front(), tracks_.raw_px[0], camera_);
      tracks_.repetition = find_repetition(next, tracks_.raw_px[0]);
    }
    if (tracks_.repetition) {
      anchors_.periods_px = tracks_.repetition->period_px.colwise().norm();
      tracks_.repetition->margins = {std::numeric_limits<double>::infinity()};
    }
    earlier_ = tracks_.raw_px[0];
  } else {
    const double most_px = kMostForwardBackward * patch_unit(camera_);
    const Eigen::Matrix2Xd before = tracks_.raw_px.back();
    append(anchored ? follow(last_, next, before, earlier_, anchors_, tracks_.repetition)
                    : follow(last_, next, before, most_px),
           tracks_);
    earlier_ = before;
  }
  last_ = std::move(next);
}

void WindowTracker::drop_every_second() {
  Tracks kept = tracks_;
  kept.raw_px.clear();
  kept.forward_backward_px.clear();
  double margin = std::numeric_limits<double>::infinity();  // since the last frame that is kept
  if (kept.repetition) kept.repetition->margins.clear();
  std::vector<int> moved(tracks_.frame_count());  // the first frame that is kept from here on
  for (int i = 0; i < tracks_.frame_count(); ++i) {
    const bool stays = i % 2 == 0 || i + 1 == tracks_.frame_count();
    moved[i] = kept.frame_count();
    if (kept.repetition) margin = std::min(margin, tracks_.repetition->margins[i]);
    if (!stays) continue;
    if (kept.repetition)
      kept.repetition->margins.push_back(
          std::exchange(margin, std::numeric_limits<double>::infinity()));
    kept.raw_px.push_back(std::move(tracks_.raw_px[i]));
    kept.forward_backward_px.push_back(std::move(tracks_.forward_backward_px[i]));
  }
  for (auto& end : kept.ends)
    if (end) end->frame = moved[end->frame];
  tracks_ = std::move(kept);
}

std::optional<Tracks> track_window(const GrayImages& gray_at,
                                   const Camera& camera,
                                   const FrameSpan& span,
                                   Tracking tracking,
                                   const TrackingRun& run) {
  WindowTracker tracker(camera, tracking, span.start);
  for (int i = 0; i < span.frames; ++i) {
    if (run.stop.stop_requested()) return std::nullopt;
    tracker.add(gray_at(span.start + i));
    if (run.progress) run.progress(i + 1, span.frames);
  }
  return tracker.tracks();
}

}  // namespace gpo
