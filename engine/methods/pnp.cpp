// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/geometry/camera.h"
#include "engine/geometry/camera_resection.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/candidates/homography_candidates.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Vector3d;

/// Least share of the inlier tracks in a pair.
constexpr double kLeastShareOfPair = 0.5;
/// Given rotations are off by a degree; wrong decompositions by more.
constexpr double kMostRotationDeg = 5;
/// Twins with a smaller angle are the same motion with noise (motion along the normal).
constexpr double kSameTwinDeg = 15;
/// Rays with a smaller angle determine no depth.
constexpr double kLeastParallaxDeg = 1;
constexpr double kMostPairErrorPx = 3;  // [pixel_unit]
constexpr int kLeastSeenPoints = 6;

struct Reconstruction {
  std::vector<std::optional<Pose>> cameras;     ///< one per frame
  std::vector<std::optional<Vector3d>> points;  ///< one per track; inlier tracks only
};

/// Triangulates the inlier tracks of a frame from the frames with a pose.
void triangulate_tracks(const Window& window, int frame, Reconstruction& scene) {
  for (const int track : window.inlier_tracks(frame))
    scene.points[track] = triangulated_track(window, scene.cameras, track);
}

/// Returns the motion halfway between two decompositions.
HomographyMotion middle(const HomographyMotion& a, const HomographyMotion& b) {
  const Eigen::Vector3d half = so3_log(a.R_21.transpose() * b.R_21) / 2;
  return {a.R_21 * so3_exp(half), (a.tau + b.tau) / 2, (a.normal + b.normal).normalized()};
}

Reconstruction reconstruct_pair(const Window& window, int frame, const HomographyMotion& motion) {
  Reconstruction scene;
  scene.cameras.resize(window.frame_count());
  scene.points.resize(window.track_count());
  scene.cameras[0] = Pose{};
  scene.cameras[frame] = Pose{motion.R_21.transpose(), -motion.tau};
  triangulate_tracks(window, frame, scene);
  return scene;
}

/// Returns why the pair's points are unsuitable for the other frames; nullopt if they are suitable.
std::optional<std::string> reason_against_points(const Window& window,
                                                 const Reconstruction& scene,
                                                 int frame) {
  const Pose cameras[] = {Pose{}, *scene.cameras[frame]};
  std::vector<double> angles_deg;
  std::vector<double> errors_px;
  for (int j = 0; j < window.track_count(); ++j) {
    if (!scene.points[j]) continue;
    const Vector3d seen = window.K * to_camera(cameras[1], *scene.points[j]);
    angles_deg.push_back(parallax_deg(cameras, *scene.points[j]));
    errors_px.push_back((seen.hnormalized() - window.points_px[frame].col(j)).norm());
  }
  if (static_cast<int>(angles_deg.size()) < kLeastInliers)
    return "only " + counted(angles_deg.size(), "point") + " can be triangulated";
  const double angle_deg = median(std::move(angles_deg));
  const double error_px = median(std::move(errors_px));
  if (angle_deg < kLeastParallaxDeg)
    return fmt::format(
        "median parallax {:.1f} deg, at least {} are needed", angle_deg, kLeastParallaxDeg);
  const double most_px = kMostPairErrorPx * pixel_unit(window);
  if (error_px > most_px)
    return fmt::format(
        "median error of its points {:.1f} px, the limit is {:.3g}", error_px, most_px);
  return std::nullopt;
}

/// Returns why the best decomposition is ambiguous or contradicts the given rotation; nullopt
/// otherwise.
std::optional<std::string> reason_to_doubt(const HomographyCandidate& best,
                                           std::span<const HomographyCandidate> candidates) {
  if (best.score > kMostRotationDeg) {
    return fmt::format("rotation {:.1f} deg from the given rotation, the limit is {}",
                       best.score,
                       kMostRotationDeg);
  }
  for (const HomographyCandidate& other : candidates) {
    const double apart_deg = angle_deg(other.motion.normal, best.motion.normal);
    if (!other.taken() || apart_deg < kSameTwinDeg) continue;
    return fmt::format(
        "ambiguous: its twin {:.0f} deg apart fits the given rotation equally well ({:.1f} and "
        "{:.1f} "
        "deg)",
        apart_deg,
        best.score,
        other.score);
  }
  return std::nullopt;
}

/// Returns the twin if it is as good as the best decomposition. If the camera moves along the
/// normal, noise separates the twins to either side of the truth by the square root of its size, so
/// that their mean is much better than either.
const HomographyCandidate* indistinct_twin(const HomographyCandidate& best,
                                           std::span<const HomographyCandidate> candidates) {
  for (const HomographyCandidate& other : candidates) {
    if (&other == &best || !other.taken()) continue;
    if (other.score < kClearlyWorseFactor * best.score) return &other;
  }
  return nullptr;
}

/// Returns the frames by |tau| of their homographies, largest first.
std::vector<int> widest_first(const Window& window) {
  std::vector<double> parallax(window.frame_count(), 0.0);
  for (int i = 1; i < window.frame_count(); ++i) {
    const auto motions = decompose_homography(window.K.inverse() * window.H_i1[i] * window.K);
    if (!motions.empty()) parallax[i] = motions.front().tau.norm();
  }
  std::vector<int> frames(window.frame_count() - 1);
  std::iota(frames.begin(), frames.end(), 1);
  std::ranges::stable_sort(frames, std::greater{}, [&](int i) { return parallax[i]; });
  return frames;
}

/// The reference frame with one other.
struct Pair {
  std::vector<HomographyCandidate> candidates;
  Reconstruction scene;
  std::optional<std::string> reason;  ///< why it is unsuitable
};

Pair try_pair(const Window& window, int frame) {
  Pair pair{decompose_frame(window, frame), {}, {}};
  reject_worse_rotations(pair.candidates);
  const HomographyCandidate* best = best_of(pair.candidates);
  if (window.inlier_count(frame) < kLeastShareOfPair * window.inlier_count(0)) {
    pair.reason =
        fmt::format("only {} of {} tracks", window.inlier_count(frame), window.inlier_count(0));
  } else if (best == nullptr) {
    pair.reason = "no decomposition of its homography has the points in front of both cameras";
  } else {
    pair.reason = reason_to_doubt(*best, pair.candidates);
  }
  const HomographyCandidate* second = nullptr;
  if (!pair.reason) {
    second = indistinct_twin(*best, pair.candidates);
    const HomographyMotion motion =
        second == nullptr ? best->motion : middle(best->motion, second->motion);
    pair.scene = reconstruct_pair(window, frame, motion);
    pair.reason = reason_against_points(window, pair.scene, frame);
  }
  for (HomographyCandidate& candidate : pair.candidates) {
    const bool taken = !pair.reason && (&candidate == best || &candidate == second);
    if (taken || !candidate.taken()) continue;
    if (pair.reason) {
      candidate.reject(Rejection::pair, *pair.reason);
    } else {
      candidate.reject(
          Rejection::rotation,
          fmt::format("score {:.2f} deg worse than its twin's", candidate.score - best->score));
    }
  }
  return pair;
}

/// Returns the widest suitable pair, or the widest one if none is suitable, with the candidates of
/// all pairs that were tried.
Pair find_pair(const Window& window) {
  std::optional<Pair> widest;
  std::vector<HomographyCandidate> tried;
  for (const int frame : widest_first(window)) {
    Pair pair = try_pair(window, frame);
    if (pair.reason) *pair.reason = fmt::format("frame {}: {}", window.start + frame, *pair.reason);
    tried.insert(tried.end(), pair.candidates.begin(), pair.candidates.end());
    if (!widest || !pair.reason) widest = std::move(pair);
    if (!widest->reason) break;
  }
  widest->candidates = std::move(tried);
  return std::move(*widest);
}

/// Returns the pose of a frame from its points: by PnP or refined from the previous frame's pose,
/// whichever has the smaller error.
std::optional<Pose> resect_frame(const Window& window, const Reconstruction& scene, int frame) {
  std::vector<int> seen = window.inlier_tracks(frame);
  std::erase_if(seen, [&](int track) { return !scene.points[track]; });
  if (static_cast<int>(seen.size()) < kLeastSeenPoints) return std::nullopt;
  Eigen::Matrix3Xd points(3, seen.size());
  for (std::size_t k = 0; k < seen.size(); ++k)
    points.col(static_cast<int>(k)) = *scene.points[seen[k]];
  const Eigen::Matrix2Xd pixels = window.points_px[frame](Eigen::all, seen);
  const auto found = follow_camera(*scene.cameras[frame - 1], points, pixels, window.K);
  return found ? std::optional(found->pose) : std::nullopt;
}

/// Adds all other frames in order. Returns why it failed; nullopt on success or if stopped.
std::optional<std::string> add_frames(const Window& window,
                                      const Watch& watch,
                                      Reconstruction& scene) {
  for (int i = 1; i < window.frame_count(); ++i) {
    if (watch.stop_requested()) return std::nullopt;
    if (scene.cameras[i]) continue;
    scene.cameras[i] = resect_frame(window, scene, i);
    if (!scene.cameras[i])
      return fmt::format("frame {} has no pose from the triangulated points", window.start + i);
    triangulate_tracks(window, i, scene);
  }
  return std::nullopt;
}

/// Returns the result in the gauge of the plane fitted to the points.
Initialization result_of_points(const Window& window, const Reconstruction& scene) {
  Initialization result;
  Eigen::Matrix3Xd positions(3, window.track_count());
  for (int j = 0; j < window.track_count(); ++j) {
    if (!scene.points[j]) continue;
    positions.col(static_cast<int>(result.points.size())) = *scene.points[j];
    result.points.push_back({j, *scene.points[j]});
  }
  const auto plane = fit_plane(positions.leftCols(static_cast<int>(result.points.size())));
  if (!plane) return failed("the triangulated points determine no plane");
  result.plane = {plane->normal, 1};
  for (MapPoint& point : result.points) point.position /= plane->distance;
  for (const auto& camera : scene.cameras)
    result.cameras.push_back({camera->R_wc, camera->p_wc / plane->distance});
  result.rms_px = root_mean_square(reprojection_errors_px(window, result.cameras, result.points));
  return trusted(window, std::move(result));
}

}  // namespace

Initialization initialize_pnp(const Window& window, const Watch& watch) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  Pair pair = find_pair(window);
  const auto begin = std::chrono::steady_clock::now();
  const auto reason = pair.reason ? "no pair to start from: " + *pair.reason
                                  : add_frames(window, watch, pair.scene);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - begin;
  if (watch.stop_requested()) return stopped_early();
  Initialization result = reason ? failed(*reason) : result_of_points(window, pair.scene);
  result.solver.milliseconds = elapsed.count();  // PnP and triangulation are optimizations
  result.candidates = std::move(pair.candidates);
  return result;
}

}  // namespace gpo
