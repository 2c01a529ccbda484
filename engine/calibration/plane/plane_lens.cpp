// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/plane_lens.h"

#include "engine/base/error.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/rotations/rotations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Progress = std::function<void(int done, int of)>;

constexpr std::array kStarts{0.45, 0.6, 0.8, 1.1, 1.5, 2.1};  // focal lengths [widths]
constexpr double kSameStart = 0.05;                           // difference of log f
constexpr int kNormals = 2;                                   // for each focal length
constexpr int kMostNormals = 8;                               // that may face away
constexpr int kLeastPlaneViews = 6;
constexpr int kRounds = 4;  // each drops outliers
constexpr int kSteps = 2 * (static_cast<int>(kStarts.size()) + 1) + 2 * kRounds;  // progress steps
constexpr double kFar = 4.5;  // error of an outlier, in noises
// The noise is small where a view resembles the reference; the others determine the lens.
constexpr double kLeastFar = 0.5;  // the same, at least [pixel_unit]
constexpr double kKnee = 2;        // knee of Huber's loss, in noises
constexpr double kStartKnee = 2;   // [pixel_unit]
// Height of a plane's points [distances]: no paper or floor is flatter, and a rougher one is none.
constexpr double kFlattest = 3e-5;
constexpr double kRoughest = 1e-2;
constexpr double kLeastMotionForHeights = 0.1;  // that determines heights [distances]
constexpr double kMostDesign = 100;             // by which clusters increase the variance, at most
constexpr double kMostLogFocalSigma = 0.03;     // for log f; larger ones are a failure
constexpr double kLeastTilt_deg = 8;
constexpr double kLeastMoved = 0.1;

/// The guess with another focal length and the same distortion at each pixel.
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

/// Starts with the n-th best normal of each plane, without unplaced observations.
std::optional<Adjustment> started(PlaneData& problem, const Camera& camera, int n) {
  Adjustment start;
  start.lens = lens_of(camera);
  const double focal_px = std::sqrt(camera.fx * camera.fy);
  std::vector<PlaneMosaic> mosaics;
  for (const ObservedPlane& plane : problem.planes) {
    mosaics.push_back(plane_mosaic(plane, camera));
    std::optional<AdjustedPlane> found;
    int suited = 0;
    for (const Vector3d& normal : likely_normals(mosaics.back(), focal_px, kMostNormals)) {
      auto suiting = start_of(mosaics.back(), focal_px, normal);
      if (!suiting) continue;
      found = std::move(suiting);
      if (suited++ == n) break;
    }
    if (!found) return std::nullopt;
    start.planes.push_back(*std::move(found));
  }
  problem.planes = filtered(problem.planes, [&](std::size_t p, std::size_t i, int k) {
    return mosaics[p].H_i_m[i].allFinite() &&
           mosaics[p].points.col(problem.planes[p].views[i].points[k]).allFinite();
  });
  const ViewErrors errors = reprojection_errors(problem, start);
  problem.planes = filtered(problem.planes, [&](std::size_t p, std::size_t i, int k) {
    return std::isfinite(errors[p][i][k]);  // infinite behind the camera
  });
  return start;
}

std::vector<double> starts_px(const Camera& guess) {
  const double guess_px = std::sqrt(guess.fx * guess.fy);
  std::vector<double> starts;
  for (const double start : kStarts) starts.push_back(start * guess.width);
  if (std::ranges::none_of(starts, [&](double start_px) {
        return std::abs(std::log(start_px / guess_px)) < kSameStart;
      }))
    starts.push_back(guess_px);
  return starts;
}

std::optional<Adjustment> best_by_few(const PlaneData& all,
                                      const Camera& guess,
                                      const Progress& progress) {
  std::optional<Adjustment> best;
  int done = 0;
  for (const double focal_px : starts_px(guess)) {
    const Camera camera = with_focal(guess, focal_px);
    for (int n = 0; n < kNormals; ++n) {
      if (progress) progress(done++, kSteps);
      PlaneData few = all;
      few.planes = thinned(all.planes);
      const auto start = started(few, camera, n);
      if (!start) continue;
      few.options.knee_px = kStartKnee * pixel_unit(camera);
      few.options.most_iterations = 12;
      few.options.holds_distortion = true;
      Adjustment now = adjust(few, *start);
      few.options.most_iterations = 30;
      few.options.holds_distortion = false;
      now = adjust(few, now);
      // Starts place different numbers of observations.
      now.cost /= std::max(1, counts_of(few.planes).observations);
      if (now.usable && (!best || now.cost < best->cost)) best = std::move(now);
    }
  }
  return best;
}

std::optional<Adjustment> begun(PlaneData& problem, const LensVector& lens) {
  const Camera camera = camera_of(lens, problem.width, problem.height);
  std::optional<Adjustment> best;
  std::vector<ObservedPlane> kept;
  for (int n = 0; n < kNormals; ++n) {
    PlaneData quick = problem;
    const auto start = started(quick, camera, n);
    if (!start) continue;
    quick.options.knee_px = kStartKnee * pixel_unit(camera);
    quick.options.most_iterations = 8;
    Adjustment now = adjust(quick, *start);
    if (!now.usable || (best && now.cost >= best->cost)) continue;
    best = std::move(now);
    kept = quick.planes;
  }
  if (best) problem.planes = std::move(kept);
  return best;
}

void measure_motion(const PlaneData& problem, const Adjustment& now, PlaneLens& result) {
  for (std::size_t p = 0; p < problem.planes.size(); ++p) {
    std::vector<Vector3d> normals, centers;
    for (std::size_t i = 0; i < problem.planes[p].views.size(); ++i) {
      if (problem.planes[p].views[i].points.empty()) continue;
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

Adjustment settled(PlaneData& problem,
                   Adjustment now,
                   std::vector<int>& left_out,
                   const Progress& progress) {
  PlaneLens flat;
  measure_motion(problem, now, flat);
  for (int round = 0; round < kRounds; ++round) {
    if (progress) progress(kSteps - 2 * kRounds + 2 * round, kSteps);
    const ViewErrors errors = reprojection_errors(problem, now);
    const double noise_px = noise_of(errors);
    const double far_px =
        std::max(kFar * noise_px,
                 kLeastFar * pixel_unit(camera_of(now.lens, problem.width, problem.height)));
    problem.options.knee_px = kKnee * noise_px;
    problem.options.prior_px = problem.options.noise_px = noise_px;
    if (flat.moved >= kLeastMotionForHeights)
      problem.options.height_sigma =
          round == 0 ? kRoughest : std::clamp(height_of(problem.planes, now), kFlattest, kRoughest);
    problem.planes = without_far(problem.planes, errors, far_px, left_out);
    now = adjust(problem, now);
  }
  return now;
}

LensCertainty weigh_prior(PlaneData& problem, Adjustment& now) {
  const double noise_px = noise_of(reprojection_errors(problem, now));
  const LensCertainty first = lens_certainty(problem, now, noise_px);
  const double design =
      std::clamp(std::pow(first.sigma[0] / first.own_sigma[0], 2), 1.0, kMostDesign);
  problem.options.prior_px = noise_px * std::sqrt(design);
  now = adjust(problem, now);
  return lens_certainty(problem, now, noise_px);
}

std::string why_unknown(const PlaneLens& result) {
  const std::string so =
      fmt::format("focal length uncertain by {:.0f} %: ", 100 * std::min(9.99, result.sigma[0]));
  if (result.moved < kLeastMoved)
    return so + fmt::format(
                    "the camera moved by only {:.2f} of its distance from the plane (no "
                    "parallax)",
                    result.moved);
  if (result.tilt_deg < kLeastTilt_deg)
    return so + fmt::format(
                    "the camera keeps its tilt to the plane ({:.0f} deg about axes in the "
                    "plane), so focal length and distance cannot be separated",
                    result.tilt_deg);
  return so + "the plane is not seen from enough directions";
}

void take_lens(const PlaneData& problem,
               const Adjustment& now,
               const LensCertainty& certainty,
               PlaneLens& result) {
  result.lens = now.lens;
  const LensVector& sigma = result.sigma = certainty.sigma;
  for (int k = 0; k < kLensUnknowns; ++k)
    result.prior_only[k] = sigma[k] > kPriorOnly * problem.prior.sigma[k];
  Camera& camera = result.camera = camera_of(now.lens, problem.width, problem.height);
  Eigen::Matrix<double, kReadout, kLensUnknowns> by_lens;  // d(fx, fy, ...) / d(lens)
  by_lens.setIdentity();
  by_lens.topLeftCorner<2, 2>() << camera.fx, -0.5 * camera.fx, camera.fy, 0.5 * camera.fy;
  by_lens(2, 2) = by_lens(3, 3) = problem.width;
  set_lens_covariance(camera, by_lens * certainty.covariance * by_lens.transpose());
  result.rms_px = root_mean_square(finite(reprojection_errors(problem, now)));
  result.points = counts_of(problem.planes).points;
  result.views = counts_of(problem.planes).views;
}

constexpr int kMostFrames = 400;
constexpr std::size_t kMostPlanes = 4;  // the longest chains
constexpr int kMostChainViews = 60;     // for one chain; half of it for more
// Noise of a rotation, and errors of scale and axes (0.6 deg) as shares of a rotation, as phones
// have them.
constexpr double kGyroNoise_rad = 3e-4;
constexpr double kGyroShare = 1e-2;

GyroRotations gyro_rotations_between(const Gyroscope& gyroscope,
                                     std::span<const std::int64_t> frame_times_ns,
                                     const std::vector<ObservedPlane>& planes) {
  GyroRotations gyro;
  gyro.bias_sigma_rad_s = gyroscope.bias_sigma_rad_s;
  for (const ObservedPlane& plane : planes) {
    for (std::size_t i = 1; i < plane.views.size(); ++i) {
      const int from = plane.views[i - 1].frame;
      const int to = plane.views[i].frame;
      const std::array times{frame_times_ns[from], frame_times_ns[to]};
      const std::int64_t offset_ns = gyroscope.time_offset_ns;
      if (!why_not_covered(gyroscope, times[0] + offset_ns, times[1] + offset_ns).empty()) continue;
      const Rotations rotation = sensitive_gyro_rotations(gyroscope, times);
      const double sigma_rad =
          std::hypot(kGyroNoise_rad, kGyroShare * so3_log(rotation.R_wc[1]).norm());
      gyro.rotations.push_back({from, to, rotation.R_wc[1], rotation.gyro->d_bias[1], sigma_rad});
    }
  }
  return gyro;
}

std::optional<Readout> readout_of(const PlaneLens& lens, std::span<const std::int64_t> times_ns) {
  if (!lens.ok || lens.prior_only[kReadout] || times_ns.size() < 2) return std::nullopt;
  const double period_s = 1e-9 * static_cast<double>(times_ns.back() - times_ns.front()) /
                          static_cast<double>(times_ns.size() - 1);
  const double lines = readout_lines(lens.camera);
  const double unit_s = period_s * (lines - 1) / lines;
  return Readout{unit_s * lens.lens[kReadout],
                 std::max(kLeastReadoutSigma_s, unit_s * lens.sigma[kReadout])};
}

}  // namespace

PlaneLens lens_from_planes(std::vector<ObservedPlane> planes,
                           const GyroRotations& gyro,
                           const Camera& guess,
                           const Progress& progress) {
  PlaneLens result;
  PlaneData problem{.planes = cleaned(std::move(planes)),
                    .gyro = gyro,
                    .width = guess.width,
                    .height = guess.height};
  problem.readout_direction = readout_direction(guess);
  result.views = counts_of(problem.planes).views;
  const auto failed = [&](std::string reason) {
    result.reason = std::move(reason);
    return result;
  };
  if (result.views < kLeastPlaneViews)
    return failed(fmt::format("a plane is seen in {}; at least {} are needed",
                              counted(result.views, "image"),
                              kLeastPlaneViews));
  const auto few = best_by_few(problem, guess, progress);
  auto now = few ? begun(problem, few->lens) : std::nullopt;
  if (!now) return failed("no focal length explains the motion of the points");
  now = settled(problem, *std::move(now), result.left_out, progress);
  if (!now->usable || counts_of(problem.planes).views < kLeastPlaneViews)
    return failed("the tracks are not on planes");
  take_lens(problem, *now, weigh_prior(problem, *now), result);
  measure_motion(problem, *now, result);
  result.gyroscope = !gyro.rotations.empty();
  if (!(result.sigma[0] <= kMostLogFocalSigma)) return failed(why_unknown(result));
  result.ok = true;
  return result;
}

PlaneLens calibrate_from_plane(const FrameCache& images,
                               const Camera& guess,
                               std::span<const std::int64_t> frame_times_ns,
                               const Gyroscope* gyroscope,
                               const CalibrationProgress& progress) {
  const auto step = [&](const char* what) {
    return [&progress, what](int done, int of) {
      if (progress) progress(what, done, of);
    };
  };
  const ChainImages chained{
      images, 1 + (images.count() - 1) / kMostFrames, step("following a plane")};
  const Camera distorted = with_likely_distortion(chained, guess);
  std::vector<PlaneChain> chains = plane_chains(chained, distorted);
  std::erase_if(chains, [](const PlaneChain& chain) { return chain.references.empty(); });
  std::ranges::stable_sort(
      chains, std::greater{}, [](const PlaneChain& chain) { return chain.H_i_first.size(); });
  if (chains.size() > kMostPlanes) chains.resize(kMostPlanes);
  std::vector<ObservedPlane> planes;
  const int count = static_cast<int>(chains.size());
  for (int k = 0; k < count; ++k) {
    step("finding its points in other images")(k, count);
    planes.push_back(
        linked_views(images, chains[k], distorted, kMostChainViews / std::min(2, count)));
  }
  GyroRotations gyro;
  if (gyroscope != nullptr) gyro = gyro_rotations_between(*gyroscope, frame_times_ns, planes);
  PlaneLens lens =
      lens_from_planes(std::move(planes), gyro, distorted, step("estimating the lens"));
  lens.camera.readout_direction = guess.readout_direction;
  lens.camera.readout = guess.readout ? guess.readout : readout_of(lens, frame_times_ns);
  return lens;
}

}  // namespace gpo
