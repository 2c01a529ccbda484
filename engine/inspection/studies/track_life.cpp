// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/frontend/inliers.h"
#include "engine/geometry/homography.h"
#include "engine/inspection/rolling_cameras.h"
#include "engine/inspection/studies/studies.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

std::optional<double> if_finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// The plane that a track is on, else the leading one; null without a result.
struct TrackPlane {
  const Plane* plane = nullptr;
  int number = 0;  ///< in the window
};

TrackPlane plane_of_track(const Inspection& inspection, int column) {
  const Initialization& result = *inspection.initialization;
  const int leader = inspection.window->leader;
  if (!result.ok) return {nullptr, leader};
  if (const auto number = inspection.window->plane_of(column); number && *number != leader)
    for (const PlaneEstimate& estimate : result.planes)
      if (estimate.number == *number) return {&estimate.plane, *number};
  return {&result.plane, leader};
}

/// Returns where a frame's camera sees the point of a plane that the reference frame shows [raw
/// px]; nullopt if it does not.
std::optional<Eigen::Vector2d> predicted_px(const Inspection& inspection,
                                            int frame,
                                            int column,
                                            const Plane& plane) {
  const auto point = point_on_plane(inspection, 0, inspection.tracks->raw_px[0].col(column), plane);
  if (!point) return std::nullopt;
  const Eigen::Vector3d point_c = to_camera(inspection.initialization->cameras[frame], *point);
  const Eigen::Vector2d px = project(rolling_camera(inspection, frame), point_c);
  return px.allFinite() ? std::optional(px) : std::nullopt;
}

/// Returns the transfer error that was compared with the threshold, or would have been for excluded
/// tracks, which the window does not have.
std::optional<double> transfer_px(const Inspection& inspection, int frame, int column) {
  if (const Window* selection = inspection.selection.get();
      selection != nullptr && frame < selection->frame_count()) {
    const auto& px = selection->points_px;
    const double error_px =
        (transfer(selection->H_i1[frame], px[0].col(column)) - px[frame].col(column)).norm();
    if (std::isfinite(error_px)) return error_px;
  }
  const auto seen_px = [&](int i) {
    return undistort(inspection.recording->camera, inspection.tracks->raw_px[i].col(column));
  };
  return if_finite((transfer(inspection.window->H_i1[frame], seen_px(0)) - seen_px(frame)).norm());
}

/// Reads the tracks, not the window, which does not have the excluded ones.
TrackFrame frame_of(const Inspection& inspection, int frame, int column, const TrackPlane& on) {
  const Tracks& tracks = *inspection.tracks;
  const Window& window = *inspection.window;
  TrackFrame seen{.frame = window.start + frame, .raw_px = tracks.raw_px[frame].col(column)};
  if (frame > 0) seen.transfer_px = transfer_px(inspection, frame, column);
  if (on.plane != nullptr) {
    if (const auto predicted = predicted_px(inspection, frame, column, *on.plane))
      seen.residual_px = if_finite((*predicted - seen.raw_px).norm());
  }
  if (!tracks.forward_backward_px.empty())
    seen.forward_backward_px = if_finite(tracks.forward_backward_px[frame][column]);
  seen.inlier = window.inlier[frame][column];
  seen.on_its_plane =
      on.number == window.leader ? seen.inlier : window.planes[on.number].inlier[frame][column];
  return seen;
}

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

std::string reason_of_inconsistency(const Inspection& inspection, const Tally& tally, int column) {
  const Window& window = *inspection.window;
  const TrackConsistency track = consistency(window)[column];
  if (!track.mean_square)
    return fmt::format(
        "inconsistent: agrees with the plane in {} of {} frames, {:.0f} % are needed; transfer "
        "error up to {:.1f} px",
        track.agreeing,
        track.seen,
        100 * kConsistentShare,
        tally.worst_px);
  return fmt::format(
      "inconsistent: its mean square error is {:.1f} times its frames' variance, above {:.1f}",
      *track.mean_square,
      track.largest_mean_square);
}

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
  if (std::ranges::find(settings.exclude, life.id) != settings.exclude.end()) return "excluded";
  if (is_excluded(inspection, life.column)) return "in a mask that leaves out its tracks";
  if (is_static(inspection, life.column)) return "does not move in the image, while others do";
  const Tally tally(life, inspection.window->start);
  const auto plane = inspection.window->plane_of(life.column);
  const Eigen::Vector2d place_px = inspection.tracks->raw_px[0].col(life.column);
  const bool outside =
      settings.mask.has(MaskKind::plane) && !settings.mask.contain(MaskKind::plane, place_px);
  if (outside && !plane && inspection.window->leader == 0)
    return "outside of the mask of the main plane";
  if (plane && *plane != inspection.window->leader && tally.seen > 0)
    return verdict_on(inspection, *plane, tally, life.column);
  if (tally.seen == 0) return "seen in the reference frame only";
  if (tally.inlier > 0 && 2 * tally.inlier >= tally.seen)
    return fmt::format("inlier in {} of {}", tally.inlier, counted(tally.seen, "frame"));
  if (tally.inlier == 0 && inspection.window->inliers == Inliers::consistent)
    return reason_of_inconsistency(inspection, tally, life.column);
  std::string text =
      fmt::format("outlier in {} of {}", tally.seen - tally.inlier, counted(tally.seen, "frame"));
  if (const double threshold_px = inspection.window->threshold_px; tally.worst_px > threshold_px)
    text += fmt::format(
        ": transfer error up to {:.1f} px above {:.1f} px", tally.worst_px, threshold_px);
  return text;
}

/// Reason for an outlier in one frame or the window; in a track's last frame also for its end.
std::string reason_in(const TrackFrame& seen,
                      const TrackLife& life,
                      const std::string& loss,
                      double threshold_px) {
  const bool far = seen.transfer_px && *seen.transfer_px > threshold_px;
  if (!seen.inlier && !far) return life.verdict;
  std::string reason;
  if (far)
    reason =
        fmt::format("transfer error {:.1f} px above {:.1f} px", *seen.transfer_px, threshold_px);
  if (&seen != &life.frames.back() || loss.empty()) return reason;
  return reason + (reason.empty() ? "" : "; ") + loss;
}

std::string reason_of(const TrackEnd& end) {
  constexpr std::array kReasons{
      // by `LossReason`, of value and limit
      "left the image",
      "not found again",
      "forward-backward error {:.2f} px above {:.1f} px",
      "template of the reference frame not found",
      "template found {:.1f} px from the prediction, above {:.1f} px",
      "correlation {:.2f} with the template of the reference frame below {:.1f}"};
  const char* reason = kReasons[static_cast<std::size_t>(end.reason)];
  return fmt::format(fmt::runtime(reason), end.value, end.limit);
}

std::string loss_of(const Tracks& tracks, int column) {
  if (tracks.ends.empty() || !tracks.ends[column]) return "";
  const TrackEnd& end = *tracks.ends[column];
  return fmt::format("lost in frame {}: {}", tracks.start + end.frame, reason_of(end));
}

}  // namespace

std::vector<ResidualVector> residual_vectors(const Inspection& inspection, int frame_in_window) {
  const Window& window = *inspection.window;
  const Initialization& result = *inspection.initialization;
  if (!result.ok) return {};
  std::vector<ResidualVector> residuals;
  const auto add = [&](const PlaneEstimate& on, const std::vector<std::vector<bool>>& inlier) {
    for (int track = 0; track < window.track_count(); ++track) {
      if (!inlier[frame_in_window][track]) continue;
      const auto predicted = predicted_px(inspection, frame_in_window, track, on.plane);
      const Eigen::Vector2d observed = inspection.tracks->raw_px[frame_in_window].col(track);
      if (predicted && observed.allFinite())
        residuals.push_back({track, on.number, observed, *predicted});
    }
  };
  add({window.leader, result.plane}, window.inlier);
  for (const PlaneEstimate& estimate : result.planes)
    if (estimate.number != window.leader) add(estimate, window.planes[estimate.number].inlier);
  return residuals;
}

std::vector<double> residuals_px(const Inspection& inspection, int frame_in_window) {
  std::vector<double> lengths;
  for (const ResidualVector& residual : residual_vectors(inspection, frame_in_window))
    if (residual.plane == inspection.window->leader)
      lengths.push_back((residual.predicted_px - residual.observed_px).norm());
  return lengths;
}

TrackLife track_life(const Inspection& inspection, int column) {
  const Tracks& tracks = *inspection.tracks;
  const TrackPlane on = plane_of_track(inspection, column);
  TrackLife life;
  life.id = tracks.ids[column];
  life.column = column;
  for (int i = 0; i < tracks.frame_count(); ++i) {
    if (!tracks.seen(i, column)) continue;
    life.frames.push_back(frame_of(inspection, i, column, on));
    if (i == 0 || !life.frames.back().inlier) continue;
    life.inlier_until = life.frames.back().frame;
    if (!life.inlier_since) life.inlier_since = life.inlier_until;
  }
  for (const MapPoint& point : inspection.initialization->points)
    if (point.track == column) life.depth = point.position.z();
  const Window& window = *inspection.window;
  if (on.number != window.leader) {
    const auto point = point_on_plane(inspection, 0, tracks.raw_px[0].col(column), *on.plane);
    life.depth = point ? std::optional(point->z()) : std::nullopt;
  }
  life.verdict = verdict_of(inspection, life);
  if (const std::string loss = loss_of(tracks, column); !loss.empty()) life.verdict += "; " + loss;
  return life;
}

std::optional<double> rms_residual_px(const TrackLife& life) {
  double sum = 0;
  int count = 0;
  for (const TrackFrame& frame : life.frames) {
    if (!frame.residual_px || !frame.on_its_plane) continue;
    sum += *frame.residual_px * *frame.residual_px;
    ++count;
  }
  return count > 0 ? std::optional(std::sqrt(sum / count)) : std::nullopt;
}

std::string tracks_csv(const Inspection& inspection) {
  const Tracks& tracks = *inspection.tracks;
  const Window& window = *inspection.window;
  const double threshold_px = inspection.window->threshold_px;
  std::vector<std::string> planes(window.track_count());
  for (std::size_t k = 0; k < window.planes.size(); ++k)
    for (const int j : window.planes[k].tracks) planes[j] = std::to_string(k + 1);
  std::string csv = "#frame,track,x,y,plane,verdict,residual_px,reason\n";
  for (int column = 0; column < tracks.track_count(); ++column) {
    TrackLife life = track_life(inspection, column);
    const bool on_plane = window.is_inlier_track(column);
    const std::string loss = loss_of(tracks, column);
    for (TrackFrame& seen : life.frames) {
      if (seen.frame == window.start) seen.inlier = on_plane;
      std::string reason = reason_in(seen, life, loss, threshold_px);
      std::ranges::replace(reason, ',', ';');  // commas separate cells
      csv += fmt::format("{},{},{},{},{},{},{},{}\n",
                         seen.frame,
                         life.id,
                         seen.raw_px.x(),
                         seen.raw_px.y(),
                         planes[column],
                         seen.inlier ? "inlier" : "outlier",
                         seen.residual_px ? fmt::format("{:.4f}", *seen.residual_px) : "",
                         reason);
    }
  }
  return csv;
}

}  // namespace gpo
