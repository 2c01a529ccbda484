// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/pnp.h"

#include "engine/geometry/camera_resection.h"
#include "engine/geometry/plane_fit.h"
#include "engine/geometry/statistics.h"
#include "engine/geometry/triangulation.h"
#include "engine/methods/candidates/homography_candidates.h"
#include "engine/methods/common/window_checks.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Vector3d;

/// A pair has at least this share of the inlier tracks, or its reading rests on a corner.
constexpr double kLeastShare = 0.5;
/// Given rotations are off by a degree, bad decompositions and twins by more.
constexpr double kMostRotationDeg = 5;
/// Twins closer than this are two errors of one truth (a camera that moves along the normal).
constexpr double kSameTwinDeg = 15;
/// Rays that meet at a smaller angle give no depth.
constexpr double kLeastParallaxDeg = 1;
constexpr double kMostPairErrorPx = 3;
constexpr int kLeastSeenPoints = 6;

struct Reconstruction {
  std::vector<std::optional<Pose>> cameras;     ///< one a frame
  std::vector<std::optional<Vector3d>> points;  ///< one a track; inlier tracks only
};

/// Triangulates all inlier tracks anew from the frames that have a pose.
void triangulate_tracks(const Window& window, Reconstruction& scene) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  for (int j = 0; j < window.track_count(); ++j) {
    scene.points[j].reset();
    if (!window.inlier[0][j]) continue;
    std::vector<Pose> cameras;
    Eigen::Matrix3Xd rays(3, window.frame_count());
    for (int i = 0; i < window.frame_count(); ++i) {
      if (!scene.cameras[i] || !window.inlier[i][j]) continue;
      rays.col(static_cast<int>(cameras.size())) =
          K_inverse * window.points_px[i].col(j).homogeneous();
      cameras.push_back(*scene.cameras[i]);
    }
    if (cameras.size() < 2) continue;
    scene.points[j] = triangulate(cameras, rays.leftCols(static_cast<int>(cameras.size())));
  }
}

/// The motion halfway between two readings.
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
  triangulate_tracks(window, scene);
  return scene;
}

/// Why the pair's points cannot carry the other frames; nothing where they can.
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
    return fmt::format("only {} points could be triangulated", angles_deg.size());
  const double angle_deg = median(std::move(angles_deg));
  const double error_px = median(std::move(errors_px));
  if (angle_deg < kLeastParallaxDeg)
    return fmt::format(
        "median parallax {:.1f} deg, at least {} are needed", angle_deg, kLeastParallaxDeg);
  if (error_px > kMostPairErrorPx)
    return fmt::format(
        "median error of its points {:.1f} px, at most {}", error_px, kMostPairErrorPx);
  return std::nullopt;
}

/// Why the best reading cannot be told from the other one or contradicts the given rotation.
std::optional<std::string> reason_to_doubt(const HomographyCandidate& best,
                                           std::span<const HomographyCandidate> candidates) {
  if (best.score > kMostRotationDeg) {
    return fmt::format(
        "rotation {:.1f} deg from the given rotation's, at most {}", best.score, kMostRotationDeg);
  }
  for (const HomographyCandidate& other : candidates) {
    const double apart_deg = angle_deg(other.motion.normal, best.motion.normal);
    if (!other.taken() || apart_deg < kSameTwinDeg) continue;
    return fmt::format(
        "its twin, {:.0f} deg away, fits the given rotation alike ({:.1f} and {:.1f} deg)",
        apart_deg,
        best.score,
        other.score);
  }
  return std::nullopt;
}

/// The other reading, where it is as good as the best: noise parts the twins of a camera that moves
/// along the normal, to either side of the truth and by the square root of its size, so that their
/// middle is far better than either.
const HomographyCandidate* indistinct_twin(const HomographyCandidate& best,
                                           std::span<const HomographyCandidate> candidates) {
  for (const HomographyCandidate& other : candidates) {
    if (&other == &best || !other.taken()) continue;
    if (other.score < kClearlyWorseFactor * best.score) return &other;
  }
  return nullptr;
}

/// The frames by the size of |tau| that their homographies claim, largest first.
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
  std::optional<std::string> reason;  ///< why it will not do
};

Pair try_pair(const Window& window, int frame) {
  Pair pair{read_homography(window, frame), {}, {}};
  reject_worse_rotations(pair.candidates);
  const HomographyCandidate* best = best_of(pair.candidates);
  if (window.inlier_count(frame) < kLeastShare * window.inlier_count(0)) {
    pair.reason =
        fmt::format("only {} of {} tracks", window.inlier_count(frame), window.inlier_count(0));
  } else if (best == nullptr) {
    pair.reason = "no reading of its homography has the points in front of both cameras";
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

/// The widest pair that will do; of none, the widest, and the candidates of all that were tried.
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

/// The pose of a frame from the points that it sees, by PnP or from its neighbor's, whichever sees
/// them better.
std::optional<Pose> resect_frame(const Window& window, const Reconstruction& scene, int frame) {
  std::vector<int> seen = window.inlier_tracks(frame);
  std::erase_if(seen, [&](int track) { return !scene.points[track]; });
  if (static_cast<int>(seen.size()) < kLeastSeenPoints) return std::nullopt;
  Eigen::Matrix3Xd points(3, seen.size());
  for (std::size_t k = 0; k < seen.size(); ++k)
    points.col(static_cast<int>(k)) = *scene.points[seen[k]];
  const Eigen::Matrix2Xd pixels = window.points_px[frame](Eigen::all, seen);
  const auto anew = resect_camera(points, pixels, window.K);
  const auto followed = refine_pose(*scene.cameras[frame - 1], points, pixels, window.K);
  if (!anew && !followed) return std::nullopt;
  if (!anew || !followed) return anew ? anew->pose : followed->pose;
  return anew->median_px < followed->median_px ? anew->pose : followed->pose;
}

/// Adds all other frames in order; why it could not, or nothing, also where it was stopped.
std::optional<std::string> add_frames(const Window& window,
                                      const Watch& watch,
                                      Reconstruction& scene) {
  for (int i = 1; i < window.frame_count(); ++i) {
    if (watch.stop_requested()) return std::nullopt;
    if (scene.cameras[i]) continue;
    scene.cameras[i] = resect_frame(window, scene, i);
    if (!scene.cameras[i])
      return fmt::format("frame {} has no pose from the triangulated points", window.start + i);
    triangulate_tracks(window, scene);
  }
  return std::nullopt;
}

/// In the gauge of the plane through the points; why there is none, if so.
Initialization make_result(const Window& window, const Reconstruction& scene) {
  Initialization result;
  Eigen::Matrix3Xd positions(3, window.track_count());
  for (int j = 0; j < window.track_count(); ++j) {
    if (!scene.points[j]) continue;
    positions.col(static_cast<int>(result.points.size())) = *scene.points[j];
    result.points.push_back({j, *scene.points[j]});
  }
  const auto plane = fit_plane(positions.leftCols(static_cast<int>(result.points.size())));
  if (!plane) return failed("the triangulated points lie on no plane");
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
  auto reason = pair.reason ? "no pair to start from: " + *pair.reason
                            : add_frames(window, watch, pair.scene);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - begin;
  if (watch.stop_requested()) return stopped_early();
  Initialization result = reason ? failed(*reason) : make_result(window, pair.scene);
  result.solver.milliseconds = elapsed.count();  // PnP and triangulation are optimizations, too
  result.candidates = std::move(pair.candidates);
  return result;
}

}  // namespace gpo
