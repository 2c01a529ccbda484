// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/plane_lens.h"

#include "engine/calibration/plane/plane_selection.h"
#include "engine/calibration/plane/plane_start.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Planes = std::vector<ObservedPlane>;
using Progress = std::function<void(int done, int of)>;

constexpr std::array kStarts{0.45, 0.6, 0.8, 1.1, 1.5, 2.1};  // of f [widths]
constexpr double kSameStart = 0.05;  // by which the guess differs from one, or is one more [-]
constexpr int kNormals = 2;          // that are tried with each
constexpr int kLeastImages = 6;    // in all
constexpr int kRounds = 4;           // of dropping what is far off
constexpr int kSteps = 2 * (static_cast<int>(kStarts.size()) + 1) + 2 * kRounds;  // of the progress
constexpr double kFar = 4.5;  // noises, beyond which an observation is dropped
constexpr double kKnee = 2;   // of Huber's loss, in noises
constexpr double kStartKnee_px = 2;
// Of a plane's points [distances]: no paper and no floor is flatter; what is rougher is none.
constexpr double kFlattest = 3e-5;
constexpr double kRoughest = 1e-2;
constexpr double kTellsHeights = 0.1;  // how far a camera moves that does [distances]
constexpr double kMostDesign = 100;    // by how much clusters widen the variance, at most
constexpr double kLeastTilt_deg = 8;
constexpr double kLeastMoved = 0.1;

/// All that a calibration goes through.
struct Work {
  Planes planes;
  const GyroRotations& gyro;
  int width;
  int height;
  LensPrior prior;
  PlaneAdjustmentOptions options;
};

Adjustment adjusted(const Work& work, const Adjustment& start) {
  return adjust(work.planes, work.gyro, work.width, work.height, start, work.prior, work.options);
}

/// The guess' camera with another focal length, and what bends its pictures as much.
Camera with_focal(const Camera& guess, double focal_px) {
  Camera camera = guess;
  const double scale = focal_px / std::sqrt(guess.fx * guess.fy);
  camera.fx = camera.fy = focal_px;
  for (std::size_t k = 0; k < camera.coefficients.size(); ++k) {
    if (k == 0) camera.coefficients[k] *= scale * scale;
    if (k == 1) camera.coefficients[k] *= std::pow(scale, 4);
    if (k > 1) camera.coefficients[k] = 0;
  }
  return camera;
}

/// By a camera, with the n-th best normal of each plane that suits it. Nothing where there is none.
/// What cannot be placed is dropped from the planes.
std::optional<Adjustment> started(Planes& planes, const Camera& camera, int normal) {
  Adjustment start;
  start.lens = lens_of(camera);
  const double focal_px = std::sqrt(camera.fx * camera.fy);
  for (ObservedPlane& plane : planes) {
    const PlaneMosaic mosaic = plane_mosaic(plane, camera);
    plane = placed_part(plane, mosaic);
    std::optional<AdjustedPlane> found;
    int suited = 0;
    for (const NormalGuess& guess : normal_guesses(mosaic, focal_px, 8)) {
      auto suiting = start_of(mosaic, focal_px, guess.normal);
      if (!suiting) continue;
      found = std::move(suiting);
      if (suited++ == normal) break;
    }
    if (!found) return std::nullopt;
    start.planes.push_back(*std::move(found));
  }
  const auto errors = view_errors(planes, camera.width, camera.height, start);
  planes = visible_part(std::move(planes), errors);
  return start;
}

/// Focal lengths to start from [px].
std::vector<double> starts_px(const Camera& guess) {
  const double guess_px = std::sqrt(guess.fx * guess.fy);
  std::vector<double> starts;
  bool has_guess = false;
  for (const double start : kStarts) {
    starts.push_back(start * guess.width);
    has_guess = has_guess || std::abs(std::log(starts.back() / guess_px)) < kSameStart;
  }
  if (!has_guess) starts.push_back(guess_px);
  return starts;
}

/// The cheapest of all starts, by a few sights and points.
std::optional<Adjustment> best_by_few(const Work& all,
                                      const Camera& guess,
                                      const Progress& progress) {
  std::optional<Adjustment> best;
  int done = 0;
  for (const double focal_px : starts_px(guess)) {
    const Camera camera = with_focal(guess, focal_px);
    for (int normal = 0; normal < kNormals; ++normal) {
      if (progress) progress(done++, kSteps);
      if (all.options.stop.stop_requested()) return std::nullopt;
      Work work{thinned(all.planes), all.gyro, all.width, all.height, all.prior, all.options};
      const auto start = started(work.planes, camera, normal);
      if (!start) continue;
      work.options.knee_px = kStartKnee_px;
      work.options.most_iterations = 12;
      work.options.holds_distortion = true;
      Adjustment now = adjusted(work, *start);
      work.options.most_iterations = 30;
      work.options.holds_distortion = false;
      now = adjusted(work, now);
      // What could not be placed costs nothing.
      now.cost /= std::max(1, observation_count(work.planes));
      if (now.usable && (!best || now.cost < best->cost)) best = std::move(now);
    }
  }
  return best;
}

/// With all sights and points, from a lens.
std::optional<Adjustment> begun(Work& work, const LensVector& lens) {
  const Camera camera = camera_of(lens, work.width, work.height);
  std::optional<Adjustment> best;
  Planes kept;
  for (int normal = 0; normal < kNormals; ++normal) {
    Work quick = work;
    const auto start = started(quick.planes, camera, normal);
    if (!start) continue;
    quick.options.knee_px = kStartKnee_px;
    quick.options.most_iterations = 8;
    Adjustment now = adjusted(quick, *start);
    if (!now.usable || (best && now.cost >= best->cost)) continue;
    best = std::move(now);
    kept = quick.planes;
  }
  if (best) work.planes = std::move(kept);
  return best;
}

ViewErrors errors_of(const Work& work, const Adjustment& adjustment) {
  return view_errors(work.planes, work.width, work.height, adjustment);
}

/// The largest angle between the plane's normals in the camera's axes, and distance between
/// centers, in distances from the plane.
void measure_motion(const Work& work, const Adjustment& now, PlaneLens& result) {
  for (std::size_t p = 0; p < work.planes.size(); ++p) {
    std::vector<Vector3d> normals, centers;
    for (std::size_t i = 0; i < work.planes[p].views.size(); ++i) {
      if (work.planes[p].views[i].points.empty()) continue;
      const auto& pose = now.planes[p].poses[i];
      const Matrix3d R = so3_exp(pose.head<3>());
      normals.emplace_back(R.col(2));
      centers.emplace_back(-R.transpose() * pose.tail<3>());
    }
    for (std::size_t a = 0; a < normals.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        result.tilt_deg = std::max(result.tilt_deg, angle_deg(normals[a], normals[b]));
        result.moved =
            std::max(result.moved, (centers[a] - centers[b]).norm() / std::abs(centers[b].z()));
      }
    }
  }
}

/// Rounds of dropping what is far off, with a loss that suits the noise.
Adjustment settled(Work& work,
                   Adjustment now,
                   std::vector<int>& left_out,
                   const Progress& progress) {
  PlaneLens flat;
  measure_motion(work, now, flat);
  const bool tells_heights = flat.moved >= kTellsHeights;
  for (int round = 0; round < kRounds; ++round) {
    if (progress) progress(kSteps - 2 * kRounds + 2 * round, kSteps);
    if (work.options.stop.stop_requested()) break;
    const ViewErrors errors = errors_of(work, now);
    const double noise_px = noise_of(errors);
    work.options.knee_px = kKnee * noise_px;
    work.options.prior_px = work.options.noise_px = noise_px;
    if (tells_heights)
      work.options.height_sigma =
          round == 0 ? kRoughest : std::clamp(height_of(work.planes, now), kFlattest, kRoughest);
    work.planes = without_far(work.planes, errors, kFar * noise_px, left_out);
    now = adjusted(work, now);
  }
  return now;
}

LensCertainty certainty_of(const Work& work, const Adjustment& now, double noise_px) {
  return lens_certainty(
      work.planes, work.gyro, work.width, work.height, now, work.prior, noise_px, work.options);
}

/// Observations say less than their number: a prior weighs accordingly more.
LensCertainty weigh_prior(Work& work, Adjustment& now) {
  const double noise_px = noise_of(errors_of(work, now));
  const LensCertainty first = certainty_of(work, now, noise_px);
  const double design =
      std::clamp(std::pow(first.sigma[0] / first.own_sigma[0], 2), 1.0, kMostDesign);
  work.options.prior_px = noise_px * std::sqrt(design);
  now = adjusted(work, now);
  return certainty_of(work, now, noise_px);
}

std::string why_unknown(const PlaneLens& result) {
  const std::string so = fmt::format("the focal length stays uncertain by {:.0f} %: ",
                                     100 * std::min(9.99, result.sigma[0]));
  if (result.moved < kLeastMoved)
    return so + fmt::format(
                    "the camera moved by {:.2f} of its distance from the plane only (no parallax)",
                    result.moved);
  if (result.tilt_deg < kLeastTilt_deg)
    return so + fmt::format(
                    "the camera keeps its tilt to the plane (it turns by {:.0f} deg about axes in "
                    "the plane), so that nothing tells the focal length from the distance",
                    result.tilt_deg);
  return so + "the plane is not seen from enough directions";
}

PlaneLens failed(PlaneLens result, std::string reason) {
  result.reason = std::move(reason);
  return result;
}

void take_lens(const Work& work,
               const Adjustment& now,
               const LensCertainty& certainty,
               const PlaneLensOptions& options,
               PlaneLens& result) {
  result.lens = now.lens;
  result.sigma = certainty.sigma;
  for (int k = 0; k < kLensUnknowns; ++k) {
    result.prior_only[k] = certainty.sigma[k] > options.prior_only * options.prior.sigma[k];
  }
  Camera& camera = result.camera = camera_of(now.lens, work.width, work.height);
  const double focal_sigma = std::hypot(certainty.sigma[0], 0.5 * certainty.sigma[1]);
  camera.sigmas = {camera.fx * focal_sigma,
                   camera.fy * focal_sigma,
                   work.width * certainty.sigma[2],
                   work.width * certainty.sigma[3],
                   certainty.sigma[4],
                   certainty.sigma[5],
                   certainty.sigma[6],
                   certainty.sigma[7]};
  const std::vector<double> errors = finite(errors_of(work, now));
  result.rms_px = root_mean_square(errors);
  result.points = point_count(work.planes);
  result.views = view_count(work.planes);
}

}  // namespace

PlaneLens lens_from_planes(std::vector<ObservedPlane> planes,
                           const GyroRotations& gyro,
                           const Camera& guess,
                           const PlaneLensOptions& options,
                           const Progress& progress,
                           const std::stop_token& stop) {
  PlaneLens result;
  Work work{
      cleaned(std::move(planes)), gyro, guess.width, guess.height, options.prior, {.stop = stop}};
  result.views = view_count(work.planes);
  if (result.views < kLeastImages)
    return failed(result,
                  fmt::format("a plane is seen in {} pictures; at least {} are needed",
                              result.views,
                              kLeastImages));
  const auto few = best_by_few(work, guess, progress);
  result.stopped = stop.stop_requested();
  if (result.stopped) return failed(result, "stopped");
  auto now = few ? begun(work, few->lens) : std::nullopt;
  if (!now) return failed(result, "no focal length explains how the points moved");
  now = settled(work, *std::move(now), result.left_out, progress);
  result.stopped = stop.stop_requested();
  if (result.stopped) return failed(result, "stopped");
  if (!now->usable || view_count(work.planes) < kLeastImages)
    return failed(result, "the tracks do not lie on planes");
  const LensCertainty certainty = weigh_prior(work, *now);
  take_lens(work, *now, certainty, options, result);
  measure_motion(work, *now, result);
  if (!(result.sigma[0] <= options.most_focal_sigma)) return failed(result, why_unknown(result));
  result.ok = true;
  return result;
}

}  // namespace gpo
