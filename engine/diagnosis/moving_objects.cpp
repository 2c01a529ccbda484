// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/moving_objects.h"

#include "engine/diagnosis/window_evidence.h"
#include "engine/geometry/homography.h"
#include "engine/geometry/pose.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Vector2d;

constexpr double kGates = 3;             // distance from an epipolar line [thresholds of inliers]
constexpr double kLeastTravel = 0.02;    // path with epipolar lines [plane distance]
constexpr double kAlike = 0.3;           // difference of two motions, as a share of the longer one
constexpr int kNeighbors = 6;            // nearest tracks in the reference image
constexpr int kLeastAlike = 3;           // neighbors that move alike
constexpr std::size_t kLeastTracks = 8;  // size of an object

/// A track that contradicts the cameras, and its motion beyond that of the main plane.
struct Stray {
  int track;
  Vector2d place_px, motion_px;
};

std::vector<Stray> strays_of(const Window& window, const Initialization& result) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  std::vector<int> seen(window.track_count()), off(window.track_count());
  std::vector<Vector2d> motion(window.track_count());
  for (int i = 1; i < window.frame_count(); ++i) {
    if (result.cameras[i].p_wc.norm() < kLeastTravel) continue;
    const Eigen::Matrix3d F = fundamental_matrix(K_inverse, result.cameras[i]);
    for (int j = 0; j < window.track_count(); ++j) {
      const Vector2d p_0 = window.points_px[0].col(j), p_i = window.points_px[i].col(j);
      if (!p_0.allFinite() || !p_i.allFinite() || !window.H_i1[i].allFinite()) continue;
      ++seen[j];
      const double gate_px = kGates * window.threshold_px * window.gate_factor(i, j);
      off[j] += sampson_px(F, p_0, p_i) > gate_px ? 1 : 0;
      motion[j] = p_i - transfer(window.H_i1[i], p_0);
    }
  }
  std::vector<Stray> strays;
  for (int j = 0; j < window.track_count(); ++j)
    if (off[j] > 0 && 2 * off[j] >= seen[j] && !window.is_inlier_track(j) && !window.plane_of(j))
      strays.push_back({j, window.points_px[0].col(j), motion[j]});
  return strays;
}

bool alike(const Stray& a, const Stray& b) {
  return (a.motion_px - b.motion_px).norm() <=
         kAlike * std::max(a.motion_px.norm(), b.motion_px.norm());
}

/// Returns the strays among the nearest tracks of a stray that move like it.
std::vector<int> companions(const Window& window, const std::vector<Stray>& strays, int stray) {
  const Vector2d& place_px = strays[stray].place_px;
  std::vector<double> distances;
  for (int j = 0; j < window.track_count(); ++j)
    if (const double d = (window.points_px[0].col(j) - place_px).norm(); std::isfinite(d))
      distances.push_back(d);
  const auto farthest =
      distances.begin() + std::min<std::ptrdiff_t>(kNeighbors, std::ssize(distances) - 1);
  std::ranges::nth_element(distances, farthest);
  std::vector<int> found;
  for (int k = 0; k < std::ssize(strays); ++k)
    if (k != stray && (strays[k].place_px - place_px).norm() <= *farthest &&
        alike(strays[k], strays[stray]))
      found.push_back(k);
  return found;
}

}  // namespace

std::vector<int> moving_objects(const Window& window, const Initialization& result) {
  if (!result.ok) return {};
  const std::vector<Stray> strays = strays_of(window, result);
  std::vector<std::vector<int>> near;
  for (int k = 0; k < std::ssize(strays); ++k) near.push_back(companions(window, strays, k));
  std::vector<bool> done(strays.size(), false);
  std::vector<int> tracks;
  for (int first = 0; first < std::ssize(strays); ++first) {
    std::vector<int> object{first};
    for (std::size_t k = 0; k < object.size(); ++k) {
      if (done[object[k]] || std::ssize(near[object[k]]) < kLeastAlike) continue;
      done[object[k]] = true;
      object.insert(object.end(), near[object[k]].begin(), near[object[k]].end());
    }
    std::ranges::sort(object);
    object.erase(std::unique(object.begin(), object.end()), object.end());
    if (object.size() < kLeastTracks) continue;
    for (const int k : object) tracks.push_back(strays[k].track);
  }
  std::ranges::sort(tracks);
  tracks.erase(std::unique(tracks.begin(), tracks.end()), tracks.end());
  return tracks;
}

}  // namespace gpo
