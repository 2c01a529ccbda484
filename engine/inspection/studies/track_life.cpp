// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/geometry/homography.h"
#include "engine/inspection/rolling_cameras.h"
#include "engine/inspection/studies/studies.h"
#include "engine/pipeline/method_defaults.h"
#include "engine/planes/inliers.h"

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

/// Limits and errors that decided on the inliers of a window, evaluated once for all tracks.
struct Selection {
  const Inspection& inspection;
  /// The window when its inliers were selected; without frames that were added later.
  const Window& window = inspection.selection ? *inspection.selection : *inspection.window;
  bool limited = ransac_options(inspection.settings.options).enabled;
  std::vector<double> gates_px = frame_gates_px(window);
  std::vector<PlaneErrors> plane_errors =
      window.inliers == Inliers::planes ? gpo::plane_errors(window) : std::vector<PlaneErrors>();
  std::vector<TrackConsistency> consistencies =
      window.inliers == Inliers::consistent ? consistency(window) : std::vector<TrackConsistency>();

  /// Returns the plane that a track is on, else the leading one.
  int plane_of(int column) const { return window.plane_of(column).value_or(window.leader); }

  /// Returns the transfer error from a plane that was compared with the limit, or would have been
  /// for excluded tracks, which the window does not have.
  std::optional<double> transfer_px(int frame, int column, int plane) const {
    const auto error_px = [&](const Window& of, const auto& seen_px) {
      const auto& H_i1 = plane == of.leader ? of.H_i1 : of.planes[plane].H_i1;
      return if_finite((transfer(H_i1[frame], seen_px(0)) - seen_px(frame)).norm());
    };
    if (frame < window.frame_count())
      if (const auto px = error_px(
              window, [&](int i) -> Eigen::Vector2d { return window.points_px[i].col(column); }))
        return px;
    return error_px(*inspection.window, [&](int i) {
      return undistort(inspection.recording->camera, inspection.tracks->raw_px[i].col(column));
    });
  }

  /// Returns `TrackFrame::limit_px` after the reference frame.
  std::optional<double> limit_px(int frame, int column) const {
    if (frame >= inspection.extrapolated_from.value_or(window.frame_count()))
      return window.threshold_px;
    const bool by_frame = window.inliers != Inliers::planes || window.plane_of(column);
    if (!limited || !by_frame) return std::nullopt;
    return gates_px[frame] * window.gate_factor(frame, column);
  }
};

/// Reads the tracks, not the window, which does not have the excluded ones.
TrackFrame frame_of(const Selection& selection, int frame, int column) {
  const Inspection& inspection = selection.inspection;
  const Tracks& tracks = *inspection.tracks;
  const Window& window = *inspection.window;
  const int number = selection.plane_of(column);
  TrackFrame seen{.frame = window.start + frame, .raw_px = tracks.raw_px[frame].col(column)};
  if (frame > 0) {
    seen.transfer_px = selection.transfer_px(frame, column, number);
    seen.limit_px = selection.limit_px(frame, column);
  }
  if (const Plane* plane = estimated_plane(inspection, number)) {
    if (const auto predicted = predicted_px(inspection, frame, column, *plane))
      seen.residual_px = if_finite((*predicted - seen.raw_px).norm());
  }
  if (!tracks.forward_backward_px.empty())
    seen.forward_backward_px = if_finite(tracks.forward_backward_px[frame][column]);
  seen.inlier = window.inlier[frame][column];
  seen.on_its_plane =
      number == window.leader ? seen.inlier : window.planes[number].inlier[frame][column];
  return seen;
}

/// "2 px", "1.25 px".
std::string limit_text(double px) { return fmt::format("{:g} px", std::round(100 * px) / 100); }

/// "transfer error 1.29 px of at most 2 px"; more digits where both would look equal.
std::string transfer_text(double px, const std::optional<double>& limit_px) {
  if (limit_px && std::abs(px - *limit_px) < 0.01)
    return fmt::format("transfer error {:.4f} px of at most {:.4f} px", px, *limit_px);
  return fmt::format("transfer error {:.2f} px", px) +
         (limit_px ? " of at most " + limit_text(*limit_px) : "");
}

struct Tally {
  int seen = 0;
  int inlier = 0;
  TrackFrame worst = {};  ///< with the largest transfer error, in limits if there are any

  explicit Tally(const TrackLife& life, int start) {
    const auto error = [](const TrackFrame& frame) {
      return frame.transfer_px.value_or(0) / frame.limit_px.value_or(1);
    };
    for (const TrackFrame& frame : life.frames) {
      if (frame.frame == start) continue;
      ++seen;
      inlier += frame.inlier ? 1 : 0;
      if (error(frame) > error(worst)) worst = frame;
    }
  }

  /// "up to 5.13 px of at most 2 px".
  std::string worst_text() const {
    const double px = worst.transfer_px.value_or(0);
    return fmt::format("up to {:.2f} px", px) +
           (worst.limit_px ? " of at most " + limit_text(*worst.limit_px) : "");
  }
};

std::string reason_of_inconsistency(const TrackConsistency& track, const Tally& tally) {
  if (!track.mean_square)
    return fmt::format(
        "inconsistent: agrees with the plane in {} of {} frames, {:.0f} % are needed; transfer "
        "error {}",
        track.agreeing,
        track.seen,
        100 * kConsistentShare,
        tally.worst_text());
  return fmt::format(
      "inconsistent: its mean square error is {:.1f} times its frames' variance, above {:.1f}",
      *track.mean_square,
      track.largest_mean_square);
}

std::string verdict_on(const Selection& selection, int plane, const TrackLife& life, int seen) {
  const auto& inlier = selection.inspection.window->planes[plane].inlier;
  const auto agreeing = std::count_if(
      inlier.begin() + 1, inlier.end(), [&](const auto& of) { return of[life.column]; });
  const int start = selection.window.start, leader = selection.window.leader;
  double worst_px = 0;
  for (const TrackFrame& frame : life.frames)
    if (frame.frame != start)
      worst_px = std::max(
          worst_px, selection.transfer_px(frame.frame - start, life.column, leader).value_or(0));
  return fmt::format(
      "on {}: inlier of it in {} of {} frames, off the leading plane by up to {:.1f} px",
      plane_title(selection.inspection, plane),
      agreeing,
      seen,
      worst_px);
}

/// Returns why a track was put on no plane: its error from the nearest one over the window; empty
/// if the window was not split into planes.
std::string verdict_on_no_plane(const Selection& selection, int column) {
  const Window& window = selection.window;
  if (window.inliers != Inliers::planes) return "";
  if (selection.plane_errors.empty()) return "outlier: the window has no plane";
  const auto gates = [&](const PlaneErrors& plane) { return plane.rms_px[column] / plane.gate_px; };
  const auto nearest = std::ranges::min_element(selection.plane_errors, {}, gates);
  if (!std::isfinite(gates(*nearest))) return "outlier: seen too shortly to be put on a plane";
  double squares = 0;
  int seen = 0;
  for (int i = 1; i < window.frame_count(); ++i) {
    if (!window.points_px[i].col(column).allFinite()) continue;
    squares += std::pow(window.gate_factor(i, column), 2);
    ++seen;
  }
  const double factor = std::sqrt(squares / std::max(1, seen));
  const int number = static_cast<int>(nearest - selection.plane_errors.begin());
  return fmt::format("on no plane: its RMS {} from {} over the window",
                     transfer_text(factor * nearest->rms_px[column], factor * nearest->gate_px),
                     plane_title(selection.inspection, number));
}

std::string verdict_of(const Selection& selection, const TrackLife& life) {
  const Inspection& inspection = selection.inspection;
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
    return verdict_on(selection, *plane, life, tally.seen);
  if (tally.seen == 0) return "seen in the reference frame only";
  if (tally.inlier > 0 && 2 * tally.inlier >= tally.seen)
    return fmt::format("inlier in {} of {}", tally.inlier, counted(tally.seen, "frame"));
  if (tally.inlier == 0 && !selection.consistencies.empty())
    return reason_of_inconsistency(selection.consistencies[life.column], tally);
  if (!plane)
    if (std::string reason = verdict_on_no_plane(selection, life.column); !reason.empty())
      return reason;
  std::string text =
      fmt::format("outlier in {} of {}", tally.seen - tally.inlier, counted(tally.seen, "frame"));
  if (tally.worst.beyond_limit()) text += ": transfer error " + tally.worst_text();
  return text;
}

/// Reason for an outlier in one frame or the window; in a track's last frame also for its end.
std::string reason_in(const TrackFrame& seen, const TrackLife& life, const std::string& loss) {
  const bool far = seen.beyond_limit() && !seen.on_its_plane;
  if (!seen.inlier && !far) return life.verdict;
  std::string reason;
  if (far) reason = transfer_text(*seen.transfer_px, seen.limit_px);
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

/// Returns from which frame on a track is lost, and why if known; empty if the last frame sees it.
std::string loss_of(const Tracks& tracks, int column) {
  int frame = tracks.frame_count();
  while (frame > 0 && !tracks.seen(frame - 1, column)) --frame;
  if (frame == 0 || frame == tracks.frame_count()) return "";
  const std::string text = fmt::format("lost in frame {}", tracks.start + frame);
  if (tracks.ends.empty() || !tracks.ends[column]) return text;
  return text + ": " + reason_of(*tracks.ends[column]);
}

TrackLife life_of(const Selection& selection, int column) {
  const Inspection& inspection = selection.inspection;
  const Tracks& tracks = *inspection.tracks;
  TrackLife life;
  life.id = tracks.ids[column];
  life.column = column;
  for (int i = 0; i < tracks.frame_count(); ++i) {
    if (!tracks.seen(i, column)) continue;
    life.frames.push_back(frame_of(selection, i, column));
    if (i == 0 || !life.frames.back().inlier) continue;
    life.inlier_until = life.frames.back().frame;
    if (!life.inlier_since) life.inlier_since = life.inlier_until;
  }
  for (const MapPoint& point : inspection.initialization->points)
    if (point.track == column) life.depth = point.position.z();
  const int number = selection.plane_of(column);
  const Plane* plane = estimated_plane(inspection, number);
  if (plane != nullptr && number != inspection.window->leader) {
    const auto point = point_on_plane(inspection, 0, tracks.raw_px[0].col(column), *plane);
    life.depth = point ? std::optional(point->z()) : std::nullopt;
  }
  life.verdict = verdict_of(selection, life);
  if (is_excluded(inspection, column)) return life;
  if (const std::string loss = loss_of(tracks, column); !loss.empty()) life.verdict += "; " + loss;
  return life;
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

std::string decision_text(const TrackFrame& seen) {
  std::string text;
  if (seen.transfer_px)
    text = transfer_text(*seen.transfer_px, seen.limit_px) + (seen.on_its_plane ? ": inlier"
                                                              : seen.beyond_limit()
                                                                  ? ": outlier"
                                                                  : ": outlier over the window");
  if (!seen.residual_px) return text;
  return text + (text.empty() ? "" : "; ") +
         fmt::format("residual of the solution {:.2f} px", *seen.residual_px);
}

TrackLife track_life(const Inspection& inspection, int column) {
  return life_of({inspection}, column);
}

std::vector<TrackLife> track_lives(const Inspection& inspection) {
  const Selection selection{inspection};
  std::vector<TrackLife> lives;
  for (int column = 0; column < inspection.tracks->track_count(); ++column)
    lives.push_back(life_of(selection, column));
  return lives;
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
  std::vector<std::string> planes(window.track_count());
  for (std::size_t k = 0; k < window.planes.size(); ++k)
    for (const int j : window.planes[k].tracks) planes[j] = std::to_string(k + 1);
  std::string csv = "#frame,track,x,y,plane,verdict,residual_px,reason\n";
  for (TrackLife& life : track_lives(inspection)) {
    const bool on_plane = window.is_inlier_track(life.column);
    const std::string loss = loss_of(tracks, life.column);
    for (TrackFrame& seen : life.frames) {
      if (seen.frame == window.start) seen.inlier = on_plane;
      std::string reason = reason_in(seen, life, loss);
      std::ranges::replace(reason, ',', ';');  // commas separate cells
      csv += fmt::format("{},{},{},{},{},{},{},{}\n",
                         seen.frame,
                         life.id,
                         seen.raw_px.x(),
                         seen.raw_px.y(),
                         planes[life.column],
                         seen.inlier ? "inlier" : "outlier",
                         seen.residual_px ? fmt::format("{:.4f}", *seen.residual_px) : "",
                         reason);
    }
  }
  return csv;
}

}  // namespace gpo
