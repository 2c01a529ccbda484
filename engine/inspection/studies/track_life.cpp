// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/track_life.h"

#include "engine/frontend/inliers.h"
#include "engine/geometry/homography.h"
#include "engine/inspection/plane_names.h"
#include "engine/inspection/studies/residuals.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

std::optional<double> length_of(const Eigen::Vector2d& difference) {
  const double length = difference.norm();
  return std::isfinite(length) ? std::optional(length) : std::nullopt;
}

std::optional<double> forward_backward(const Tracks& tracks, int frame, int column) {
  if (tracks.forward_backward_px.empty()) return std::nullopt;
  const double error = tracks.forward_backward_px[frame][column];
  return std::isfinite(error) ? std::optional(error) : std::nullopt;
}

/// From the tracks, not from the window, which does not have those that are left out by hand.
TrackFrame frame_of(const Inspection& inspection, int frame, int column) {
  const Tracks& tracks = *inspection.tracks;
  const Window& window = *inspection.window;
  const Camera& camera = inspection.recording->camera;
  const Eigen::Vector2d first_px = undistort(camera, tracks.raw_px[0].col(column));
  TrackFrame seen{window.start + frame, tracks.raw_px[frame].col(column), {}, {}, {}, false};
  if (frame > 0) {
    seen.transfer_px =
        length_of(transfer(window.H_i1[frame], first_px) - undistort(camera, seen.raw_px));
  }
  if (const auto H = estimated_homography(inspection, frame))
    seen.residual_px = length_of(distort(camera, transfer(*H, first_px)) - seen.raw_px);
  seen.forward_backward_px = forward_backward(tracks, frame, column);
  seen.inlier = window.inlier[frame][column];
  return seen;
}

/// What a verdict counts, over the frames that see the track beside the reference frame.
struct Tally {
  int seen = 0;
  int inlier = 0;
  double worst_px = 0;  ///< largest transfer error

  explicit Tally(const TrackLife& life, int start) {
    for (const TrackFrame& frame : life.frames) {
      if (frame.frame == start) continue;
      ++seen;
      inlier += frame.inlier ? 1 : 0;
      worst_px = std::max(worst_px, frame.transfer_px.value_or(0));
    }
  }
};

/// Why a track of which no frame is an inlier is none over the window.
std::string reason_of_inconsistency(const Inspection& inspection, const Tally& tally, int column) {
  const Window& window = *inspection.window;
  const ConsistencyOptions options{.threshold_px = inspection.settings.options.ransac_threshold_px};
  const TrackConsistency track =
      consistency(window.points_px, {window.H_i1, window.inlier}, options)[column];
  if (!track.mean_square) {
    return fmt::format(
        "inconsistent: agrees with the plane in {} of {} frames, {:.0f} % are needed; transfer "
        "error up to {:.1f} px",
        track.agreeing,
        track.seen,
        100 * options.share,
        tally.worst_px);
  }
  return fmt::format(
      "inconsistent: its mean square error is {:.1f} times its frames' variance, above {:.1f}",
      *track.mean_square,
      track.largest_mean_square);
}

/// Of a track that is no outlier, but on a plane that does not lead.
std::string verdict_on(const Inspection& inspection, int plane, const Tally& tally, int column) {
  const auto& inlier = inspection.window->planes[plane].inlier;
  const auto agreeing =
      std::count_if(inlier.begin() + 1, inlier.end(), [&](const auto& of) { return of[column]; });
  return fmt::format(
      "on {}: inlier of it in {} of {} frames, off the leading plane by up to {:.1f} px",
      plane_title(inspection, plane),
      agreeing,
      tally.seen,
      tally.worst_px);
}

std::string verdict_of(const Inspection& inspection, const TrackLife& life) {
  const Settings& settings = inspection.settings;
  if (std::ranges::find(settings.exclude, life.id) != settings.exclude.end())
    return "left out by hand";
  const Tally tally(life, inspection.window->start);
  const auto plane = inspection.window->plane_of(life.column);
  if (plane && *plane != inspection.window->leader && tally.seen > 0)
    return verdict_on(inspection, *plane, tally, life.column);
  if (tally.seen == 0) return "seen in the reference frame only";
  if (tally.inlier > 0 && 2 * tally.inlier >= tally.seen)
    return fmt::format("inlier in {} of {} frames", tally.inlier, tally.seen);
  if (tally.inlier == 0 && inspection.window->inliers == Inliers::consistent)
    return reason_of_inconsistency(inspection, tally, life.column);
  std::string text =
      fmt::format("outlier in {} of {} frames", tally.seen - tally.inlier, tally.seen);
  if (tally.worst_px > settings.options.ransac_threshold_px) {
    text += fmt::format(": transfer error up to {:.1f} px above {:.1f} px",
                        tally.worst_px,
                        settings.options.ransac_threshold_px);
  }
  return text;
}

}  // namespace

std::string reason_of(const TrackEnd& end) {
  switch (end.reason) {
    case LossReason::left_image:
      return "left the picture";
    case LossReason::no_flow:
      return "not found again";
    case LossReason::forward_backward:
      return fmt::format("forward-backward error {:.2f} px above {:.1f} px", end.value, end.limit);
    case LossReason::look_not_found:
      return "its look in the reference frame not found";
    case LossReason::far_from_prediction:
      return fmt::format("its look found {:.1f} px from where it was expected, above {:.1f} px",
                         end.value,
                         end.limit);
    case LossReason::low_correlation:
      return fmt::format("correlation {:.2f} with its look in the reference frame below {:.1f}",
                         end.value,
                         end.limit);
  }
  return "";
}

TrackLife track_life(const Inspection& inspection, int column) {
  const Tracks& tracks = *inspection.tracks;
  TrackLife life;
  life.id = tracks.ids[column];
  life.column = column;
  for (int i = 0; i < tracks.frame_count(); ++i) {
    if (!tracks.seen(i, column)) continue;
    life.frames.push_back(frame_of(inspection, i, column));
    if (i == 0 || !life.frames.back().inlier) continue;
    life.inlier_until = life.frames.back().frame;
    if (!life.inlier_since) life.inlier_since = life.inlier_until;
  }
  for (const MapPoint& point : inspection.initialization->points) {
    if (point.track == column) life.depth = point.position.z();
  }
  life.verdict = verdict_of(inspection, life);
  if (!tracks.ends.empty() && tracks.ends[column]) {
    const TrackEnd& end = *tracks.ends[column];
    life.verdict +=
        fmt::format("; lost in frame {}: {}", inspection.window->start + end.frame, reason_of(end));
  }
  return life;
}

std::optional<double> rms_residual_px(const TrackLife& life) {
  double sum = 0;
  int count = 0;
  for (const TrackFrame& frame : life.frames) {
    if (!frame.residual_px || !frame.inlier) continue;
    sum += *frame.residual_px * *frame.residual_px;
    ++count;
  }
  return count > 0 ? std::optional(std::sqrt(sum / count)) : std::nullopt;
}

}  // namespace gpo
