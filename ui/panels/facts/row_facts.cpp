// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/pose.h"
#include "ui/panels/facts/facts.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Counts the frames in which the track is an inlier of its plane, or of the leading one.
int inlier_frames(const Window& window, int column, std::optional<int> plane) {
  const auto& of = plane && *plane != window.leader ? window.planes[*plane].inlier : window.inlier;
  return static_cast<int>(
      std::ranges::count_if(of, [column](const auto& frame) { return bool(frame[column]); }));
}

/// Returns what a column sorts by; nullopt if unknown.
std::optional<double> value_of(const TrackRow& row, TrackColumn column) {
  const std::optional<double> values[] = {
      static_cast<double>(row.id), row.seen, row.inlier, row.plane, row.rms_px, row.depth, {}};
  return values[static_cast<std::size_t>(column)];
}

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "";
}

}  // namespace

std::vector<TrackRow> track_rows(const Inspection& inspection) {
  const Window& window = *inspection.window;
  std::vector<TrackRow> rows;
  for (int column = 0; column < inspection.tracks->track_count(); ++column) {
    const TrackLife life = track_life(inspection, column);
    const auto plane = window.plane_of(column);
    rows.push_back({.id = life.id,
                    .seen = static_cast<int>(life.frames.size()),
                    .inlier = inlier_frames(window, column, plane),
                    .plane = plane ? std::optional(*plane + 1) : std::nullopt,
                    .rms_px = rms_residual_px(life),
                    .depth = life.depth,
                    .verdict = life.verdict});
  }
  std::ranges::sort(rows, {}, &TrackRow::id);
  return rows;
}

void sort_tracks(std::vector<TrackRow>& rows, TrackColumn by, bool descending) {
  std::ranges::sort(rows, {}, &TrackRow::id);
  std::ranges::stable_sort(rows, [&](const TrackRow& a, const TrackRow& b) {
    if (by == TrackColumn::verdict)
      return descending ? b.verdict < a.verdict : a.verdict < b.verdict;
    const auto x = value_of(a, by), y = value_of(b, by);
    if (!x || !y) return x.has_value() && !y.has_value();
    return descending ? *y < *x : *x < *y;
  });
}

std::string to_csv(std::span<const TrackRow> rows) {
  std::string text = "track,frames seen,frames inlier,plane,residual [px],depth [d],verdict\n";
  for (const TrackRow& row : rows) {
    std::string verdict = row.verdict;
    std::ranges::replace(verdict, ',', ';');
    text += fmt::format("{},{},{},{},{},{},{}\n",
                        row.id,
                        row.seen,
                        row.inlier,
                        row.plane ? std::to_string(*row.plane) : "",
                        cell(row.rms_px),
                        cell(row.depth),
                        verdict);
  }
  return text;
}

const TrackLife& TrackLives::of(const Inspection& inspection, int column) {
  constexpr std::size_t kMost = 16;  // one frame of the window shows at most three
  const auto found = std::ranges::find_if(recent_, [&](const Entry& entry) {
    return entry.column == column && entry.tracks == inspection.tracks &&
           entry.window == inspection.window && entry.initialization == inspection.initialization;
  });
  if (found != recent_.end()) {
    recent_.splice(recent_.begin(), recent_, found);
    return recent_.front().life;
  }
  ++computed_;
  recent_.push_front({inspection.tracks,
                      inspection.window,
                      inspection.initialization,
                      column,
                      track_life(inspection, column)});
  if (recent_.size() > kMost) recent_.pop_back();
  return recent_.front().life;
}

std::string candidates_sentence(std::span<const HomographyCandidate> candidates) {
  std::vector<const HomographyCandidate*> accepted;
  for (const HomographyCandidate& candidate : candidates)
    if (candidate.taken()) accepted.push_back(&candidate);
  const std::size_t count = candidates.size();
  const std::string all = fmt::format("{} decomposition{}", count, count == 1 ? "" : "s");
  if (accepted.empty()) return fmt::format("none of {} is feasible.", all);
  const double tilt = angle_deg(accepted[0]->motion.normal, {0, 0, -1});
  if (accepted.size() == 1)
    return fmt::format("1 of {} is feasible: a plane tilted by {:.1f}\u00b0.", all, tilt);
  double apart = 0;
  for (const HomographyCandidate* one : accepted)
    for (const HomographyCandidate* other : accepted)
      apart = std::max(apart, angle_deg(one->motion.normal, other->motion.normal));
  return fmt::format(
      "{} of {} are feasible; their normals are {:.1f}\u00b0 apart. This frame alone is ambiguous.",
      accepted.size(),
      all,
      apart);
}

std::string why_no_candidates(const NormalStudy& study, int frame_in_window) {
  const int frames = static_cast<int>(study.candidates.size());
  if (frame_in_window < 0 || frame_in_window >= frames)
    return "This frame is outside of the window. Go to one of the bars of the time line";
  if (frame_in_window == 0)
    return "This is the reference frame. Homographies map it to the other frames";
  if (study.candidates[frame_in_window].empty())
    return "This frame has no homography that can be decomposed: it has too few inliers, or the "
           "camera only rotated";
  return "";
}

std::vector<std::string> candidate_cells(const HomographyCandidate& candidate) {
  const Eigen::Vector3d& n = candidate.motion.normal;
  return {fmt::format("{:.3f}, {:.3f}, {:.3f}", n.x(), n.y(), n.z()),
          fmt::format("{:.1f}", angle_deg(n, {0, 0, -1})),
          fmt::format("{:.2f}", degrees(so3_log(candidate.motion.R_21).norm())),
          fmt::format("{:.3f}", candidate.motion.tau.norm()),
          fmt::format("{:.2f}", candidate.score),
          fmt::format("{} of {}", candidate.behind, candidate.of)};
}

std::string why_no_study(const WorkbenchState& state, const std::string& doing) {
  const auto& [inspection, study] = std::tie(state.results.inspection, state.results.study);
  if (!study || !inspection || study->window != inspection->window) return doing;
  return study->error.empty() ? "" : "Cannot analyze the normals of the window: " + study->error;
}

}  // namespace gpo
