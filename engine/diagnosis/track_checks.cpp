// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/checks.h"
#include "engine/diagnosis/focal_change.h"
#include "engine/diagnosis/moving_objects.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace gpo::check {
namespace {

/// Changes by a focus motor. Smaller ones are within the stated uncertainty; larger ones are
/// estimates of windows that do not determine them.
constexpr double kLeastFocalChange = 0.003, kMostFocalChange = 0.05;
/// Fixed lenses: at most 3.0 in 73 real windows of 20 frames, and below 4 in 782 simulated ones of
/// 10 to 30 frames (noise of 0.2 and 0.5 px, a rolling shutter, a calibration 0.3 % off) but for
/// one whose normal was 35 deg off. A change by 1 % exceeds it in 48 % of the windows with 0.2 px
/// of noise, in 23 % with 0.5 px.
constexpr double kFocalSigmas = 4;

std::vector<std::int64_t> ids_of(const Evidence& e, const std::vector<int>& columns) {
  std::vector<std::int64_t> ids;
  for (const int j : columns)
    if (j < std::ssize(e.ids)) ids.push_back(e.ids[j]);
  return ids;
}

/// Returns the tracks that are left in the window's reference frame.
std::vector<int> tracks_left(const Window& window) {
  std::vector<int> left;
  for (int j = 0; j < window.track_count(); ++j)
    if (window.points_px[0].col(j).allFinite()) left.push_back(j);
  return left;
}

/// Returns the median over the tracks of the farthest distance from their reference position.
double typical_motion_px(const Window& window, const std::vector<int>& tracks) {
  std::vector<double> farthest_px;
  for (const int j : tracks) {
    double most_px = 0;
    for (const Eigen::Matrix2Xd& frame_px : window.points_px)
      if (const double px = (frame_px.col(j) - window.points_px[0].col(j)).norm(); px > most_px)
        most_px = px;
    farthest_px.push_back(most_px);
  }
  return farthest_px.empty() ? 0 : median(std::move(farthest_px));
}

/// Returns whether the static tracks are on all sides of most of the others, and a good share of
/// all: a wall behind a moving object is, a camera's carrier or a line of text is not.
bool surround(const Eigen::Matrix2Xd& places_px,
              const std::vector<int>& fixed,
              const std::vector<int>& others) {
  constexpr double kLeastShare = 0.15;
  if (std::ssize(fixed) < kLeastShare * (std::ssize(fixed) + std::ssize(others))) return false;
  const auto is_inside = [&](int track) {
    std::array<bool, 4> quadrants{};
    for (const int j : fixed) {
      const Eigen::Vector2d d = places_px.col(j) - places_px.col(track);
      quadrants[(d.x() > 0 ? 1 : 0) + (d.y() > 0 ? 2 : 0)] = true;
    }
    return std::ranges::count(quadrants, true) == 4;
  };
  return 2 * std::ranges::count_if(others, is_inside) > std::ssize(others);
}

/// Returns the command that leaves out a rectangle around the static tracks; empty if it would
/// also leave out others.
std::string mask_around(const Eigen::Matrix2Xd& places_px,
                        const std::vector<int>& fixed,
                        const std::vector<int>& others) {
  constexpr double kMostLost = 0.05;
  Eigen::AlignedBox2d box;
  for (const int j : fixed) box.extend(places_px.col(j));
  const Eigen::Vector2d least = box.min().array().floor() - 1, most = box.max().array().ceil() + 1;
  box = {least.cwiseMax(0), most};
  const auto lost =
      std::ranges::count_if(others, [&](int j) { return box.contains(places_px.col(j).eval()); });
  if (static_cast<double>(lost) > kMostLost * static_cast<double>(others.size())) return "";
  return fmt::format(
      "mask not {:g} {:g} {:g} {:g}", box.min().x(), box.min().y(), box.max().x(), box.max().y());
}

}  // namespace

Findings static_tracks(const Evidence& e) {
  if (e.window == nullptr || e.window->static_tracks.empty()) return {};
  const std::vector<int>& fixed = e.window->static_tracks;
  const std::vector<int> others = tracks_left(*e.window);
  const bool most = fixed.size() > others.size();
  const bool around = e.tracks != nullptr && surround(e.tracks->raw_px[0], fixed, others);
  Finding finding{.level = most || around ? Level::weak : Level::note,
                  .tracks = ids_of(e, fixed),
                  .view = "image"};
  finding.sentence = fmt::format(
      "{} of {} tracks do not move in the image while others move by {:.0f} px: an overlay, a part "
      "of the camera's carrier{}; they are left out",
      fixed.size(),
      fixed.size() + others.size(),
      typical_motion_px(*e.window, others),
      most || around ? ", or a camera at rest before a moving object" : ", or dirt");
  if (finding.level == Level::note) return {finding};
  finding.advice = "if the camera moves, mask them";
  if (e.tracks != nullptr) finding.command = mask_around(e.tracks->raw_px[0], fixed, others);
  return {finding};
}

Findings changing_focal_length(const Evidence& e) {
  if (e.window == nullptr || e.result == nullptr) return {};
  const auto change = focal_change(*e.window, *e.result);
  if (!change) return {};
  const double size = std::abs(change->share);
  if (!(size > kLeastFocalChange && size < kMostFocalChange)) return {};
  if (!(size > kFocalSigmas * change->sigma_share)) return {};
  return {{.level = Level::weak,
           .sentence = fmt::format("the focal length changes by {:+.1f} % in the window, {:.0f} "
                                   "standard deviations",
                                   100 * change->share,
                                   size / change->sigma_share),
           .advice = "lock the focus and the zoom"}};
}

Findings moving_objects(const Evidence& e) {
  if (e.window == nullptr || e.result == nullptr) return {};
  const std::vector<int> tracks = gpo::moving_objects(*e.window, *e.result);
  if (tracks.empty()) return {};
  return {{.sentence = fmt::format("{} tracks move together against the scene: a moving object",
                                   tracks.size()),
           .tracks = ids_of(e, tracks),
           .view = "image"}};
}

}  // namespace gpo::check
