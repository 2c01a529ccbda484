// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/planes/inliers.h"

#include "engine/geometry/homography.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;

std::vector<bool> agreeing_pairs(const Matrix3d& H,
                                 const Matrix2Xd& from,
                                 const Matrix2Xd& to,
                                 const Eigen::VectorXd& threshold_px) {
  std::vector<bool> inlier(from.cols());
  for (Eigen::Index j = 0; j < from.cols(); ++j) {
    const Eigen::Vector3d y = H * from.col(j).homogeneous();
    inlier[j] = y.z() * H(2, 2) > 0 && (y.hnormalized() - to.col(j)).norm() <= threshold_px[j];
  }
  return inlier;
}

/// Returns whether more than `most` pairs agree with H; stops as soon as they cannot.
bool more_agree(const Matrix3d& H,
                const Matrix2Xd& from,
                const Matrix2Xd& to,
                const Eigen::VectorXd& threshold_px,
                std::ptrdiff_t most) {
  std::ptrdiff_t may_refuse = from.cols() - most;
  for (Eigen::Index j = 0; j < from.cols() && may_refuse > 0; ++j) {
    const Eigen::Vector3d y = H * from.col(j).homogeneous();
    const Eigen::Vector2d error = y.head<2>() - y.z() * to.col(j);
    const double radius = threshold_px[j] * y.z();
    if (!(y.z() * H(2, 2) > 0 && error.squaredNorm() <= radius * radius)) --may_refuse;
  }
  return may_refuse > 0;
}

Eigen::VectorXd gate_factors(const Window& window, int frame, const std::vector<int>& tracks) {
  return Eigen::VectorXd::NullaryExpr(std::ssize(tracks),
                                      [&](auto k) { return window.gate_factor(frame, tracks[k]); });
}

std::vector<int> indices(const std::vector<bool>& flags) {
  std::vector<int> of_true;
  for (std::size_t j = 0; j < flags.size(); ++j)
    if (flags[j]) of_true.push_back(static_cast<int>(j));
  return of_true;
}

std::array<int, 4> draw_four(std::mt19937_64& random, int n) {
  std::array<int, 4> sample{};
  for (int k = 0; k < 4;) {
    // Not std::uniform_int_distribution, whose numbers differ between standard libraries.
    sample[k] = static_cast<int>(random() % static_cast<std::uint64_t>(n));
    if (std::find(sample.begin(), sample.begin() + k, sample[k]) == sample.begin() + k) ++k;
  }
  return sample;
}

int iterations_needed(double inlier_ratio, const RansacOptions& options) {
  const double good_sample = std::pow(inlier_ratio, 4);
  if (good_sample >= 1) return 1;
  const double needed = std::log(1 - options.confidence) / std::log1p(-good_sample);
  return needed < options.most_iterations ? static_cast<int>(std::ceil(needed))
                                          : options.most_iterations;
}

constexpr double kQuartileSigmas = 0.6745;  // upper quartile of a Gaussian
constexpr double kSigmas = 3.5;          // largest error of an agreeing track, beside the threshold
constexpr double kLeastSigma_px = 0.03;  // one coordinate of a frame's tracks
constexpr double kSigmasOfTrack = 3;     // excess of a mean square over the median track's
constexpr std::size_t kLeastInliers = 8;  // in each frame
constexpr int kMostSelections = 10;       // rounds of fitting and selection

/// Fits each frame's homography to its inliers. Returns false if a frame has too few.
bool fit(Window& window) {
  for (int i = 1; i < window.frame_count(); ++i) {
    const std::vector<int> inliers = indices(window.inlier[i]);
    if (inliers.size() < kLeastInliers) return false;
    window.H_i1[i] = refine_homography(window.H_i1[i],
                                       window.points_px[0](Eigen::all, inliers),
                                       window.points_px[i](Eigen::all, inliers));
  }
  return true;
}

struct Errors {
  /// Transfer errors [sigmas of a coordinate of the frame], frames x tracks; NaN: not seen.
  Eigen::ArrayXXd normalized;
  Eigen::ArrayXd gate;      ///< largest error of an agreeing track, one per frame
  Eigen::ArrayXd sigma_px;  ///< noise of a coordinate, one per frame
};

Errors errors_of(const Window& window) {
  const int frames = window.frame_count(), tracks = window.track_count();
  const double unit = pixel_unit(window);
  Errors errors{Eigen::ArrayXXd(frames, tracks), Eigen::ArrayXd(frames), Eigen::ArrayXd(frames)};
  for (int i = 1; i < frames; ++i) {
    std::vector<double> of_inliers_px;
    for (int j = 0; j < tracks; ++j) {
      const double error_px =
          (transfer(window.H_i1[i], window.points_px[0].col(j)) - window.points_px[i].col(j))
              .norm();
      errors.normalized(i, j) = error_px / window.gate_factor(i, j);
      if (window.inlier[i][j]) of_inliers_px.push_back(errors.normalized(i, j));
    }
    const double sigma_px =
        std::max(median(std::move(of_inliers_px)) / kMedianOfRayleigh, kLeastSigma_px * unit);
    errors.normalized.row(i) /= sigma_px;
    errors.gate[i] = std::min(kSigmas, window.threshold_px / sigma_px);
    errors.sigma_px[i] = sigma_px;
  }
  return errors;
}

TrackConsistency consistency_of(const Errors& errors, Eigen::Index track) {
  TrackConsistency result;
  double sum = 0;
  for (Eigen::Index i = 1; i < errors.gate.size(); ++i) {
    const double error = errors.normalized(i, track);
    if (std::isnan(error)) continue;
    ++result.seen;
    result.agreeing += error <= errors.gate[i] ? 1 : 0;
    sum += std::pow(std::min(error, errors.gate[i]), 2);
  }
  if (result.agreeing > 0 && result.agreeing >= kConsistentShare * result.seen)
    result.mean_square = sum / result.seen;
  return result;
}

/// Limit of the mean squares: at least that of noise, spread by the upper half, because of drift.
double largest_mean_square(const std::vector<TrackConsistency>& tracks) {
  std::vector<double> values;
  for (const TrackConsistency& track : tracks)
    if (track.mean_square) values.push_back(*track.mean_square);
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const double middle = values[values.size() / 2];
  const double upper_quartile = values[3 * values.size() / 4];
  return std::max(middle + kSigmasOfTrack * (upper_quartile - middle) / kQuartileSigmas, 2.0);
}

std::vector<TrackConsistency> consistency(const Errors& errors) {
  std::vector<TrackConsistency> tracks;
  for (Eigen::Index j = 0; j < errors.normalized.cols(); ++j)
    tracks.push_back(consistency_of(errors, j));
  const double largest = largest_mean_square(tracks);
  for (TrackConsistency& track : tracks) track.largest_mean_square = largest;
  return tracks;
}

std::vector<std::vector<bool>> choose(const Errors& errors) {
  const Eigen::Index tracks = errors.normalized.cols();
  const std::vector<TrackConsistency> of_tracks = consistency(errors);
  std::vector<std::vector<bool>> inlier(errors.gate.size(), std::vector<bool>(tracks, false));
  for (Eigen::Index j = 0; j < tracks; ++j) {
    const auto& [seen, agreeing, mean_square, largest] = of_tracks[j];
    if (!mean_square || *mean_square > largest) continue;
    for (Eigen::Index i = 1; i < errors.gate.size(); ++i)
      inlier[i][j] = errors.normalized(i, j) <= errors.gate[i];
  }
  return inlier;
}

const Matrix3d kUnknownHomography = Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());

/// Share below which RANSAC replaces a homography that a wrong descriptor match pulls away.
constexpr double kLeastAgreeing = 0.5;

Matrix2Xd undistort_all(const Camera& camera, const Matrix2Xd& raw_px) {
  Matrix2Xd points(2, raw_px.cols());
  for (Eigen::Index j = 0; j < raw_px.cols(); ++j) points.col(j) = undistort(camera, raw_px.col(j));
  return points;
}

std::vector<std::vector<Matrix2Xd>> lens_moves(const Camera& camera, const Window& window) {
  const Eigen::MatrixXd root = lens_root(camera);
  std::vector moves(static_cast<std::size_t>(root.cols()), window.points_px);
  for (int i = 0; !moves.empty() && i < window.frame_count(); ++i) {
    for (Eigen::Index j = 0; j < window.track_count(); ++j) {
      const Matrix2Xd of_point = undistortion_moves_px(camera, root, window.points_px[i].col(j));
      for (std::size_t k = 0; k < moves.size(); ++k) moves[k][i].col(j) = of_point.col(k);
    }
  }
  return moves;
}

/// Returns `Window::noise_ratio`.
std::vector<Eigen::VectorXd> noise_ratios(const Tracks& tracks) {
  std::vector<double> seen;
  for (std::size_t i = 0; i < tracks.sigma_px.size(); ++i)
    for (int j = 0; j < tracks.track_count(); ++j)
      if (tracks.seen(static_cast<int>(i), j)) seen.push_back(tracks.sigma_px[i][j]);
  if (seen.empty() || std::ranges::min(seen) == std::ranges::max(seen)) return {};
  const double rms_px = root_mean_square(seen);
  std::vector<Eigen::VectorXd> ratios = tracks.sigma_px;
  for (Eigen::VectorXd& frame : ratios) frame /= rms_px;
  return ratios;
}

/// `candidates` as `InlierOptions::on_first_plane`.
void add_homography(Window& window,
                    int frame,
                    const RansacOptions& ransac,
                    const std::vector<bool>& candidates) {
  std::vector<int> seen;
  for (int j = 0; j < window.track_count(); ++j)
    if ((candidates.empty() || candidates[j]) && window.points_px[0].col(j).allFinite() &&
        window.points_px[frame].col(j).allFinite())
      seen.push_back(j);
  const auto robust = homography_ransac(window.points_px[0](Eigen::all, seen),
                                        window.points_px[frame](Eigen::all, seen),
                                        ransac,
                                        gate_factors(window, frame, seen));
  window.inlier.emplace_back(window.track_count(), false);
  window.H_i1.push_back(robust ? robust->H : kUnknownHomography);
  for (std::size_t k = 0; robust && k < seen.size(); ++k)
    window.inlier[frame][seen[k]] = robust->inlier[k];
}

/// Selects tracks that agree with the homographies in nearly all frames, alternating with these
/// until nothing changes. Leaves the window unchanged if a frame has too few. `candidates` as
/// `InlierOptions::on_first_plane`.
void select_consistent(Window& window, const std::vector<bool>& candidates) {
  Window selected = window;
  for (int round = 0;; ++round) {
    if (!fit(selected)) return;
    auto inlier = choose(errors_of(selected));
    for (std::vector<bool>& frame : inlier)
      for (std::size_t j = 0; j < candidates.size(); ++j) frame[j] = frame[j] && candidates[j];
    if (inlier == selected.inlier || round == kMostSelections) break;
    selected.inlier = std::move(inlier);
  }
  window = std::move(selected);
  window.inliers = Inliers::consistent;
}

WindowPlane plane_of(const Window& window,
                     const std::vector<int>& tracks,
                     const RansacOptions& ransac) {
  const int frames = window.frame_count();
  WindowPlane plane{tracks,
                    std::vector<Matrix3d>(frames, kUnknownHomography),
                    std::vector(frames, std::vector<bool>(window.track_count(), false))};
  plane.H_i1[0] = Matrix3d::Identity();
  for (const int j : tracks) plane.inlier[0][j] = true;
  for (int i = 1; i < frames; ++i) {
    std::vector<int> seen;
    for (const int j : tracks)
      if (window.points_px[i].col(j).allFinite()) seen.push_back(j);
    if (seen.size() < 4) continue;
    const Matrix2Xd from = window.points_px[0](Eigen::all, seen);
    const Matrix2Xd to = window.points_px[i](Eigen::all, seen);
    const auto H = fit_homography(from, to);
    if (!H) continue;
    plane.H_i1[i] = refine_homography(*H, from, to);
    std::size_t agreeing = 0;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const double error_px = (transfer(plane.H_i1[i], from.col(k)) - to.col(k)).norm();
      plane.inlier[i][seen[k]] = error_px <= window.threshold_px * window.gate_factor(i, seen[k]);
      agreeing += plane.inlier[i][seen[k]] ? 1 : 0;
    }
    if (static_cast<double>(agreeing) >= kLeastAgreeing * static_cast<double>(seen.size()))
      continue;
    const auto robust = homography_ransac(from, to, ransac, gate_factors(window, i, seen));
    if (!robust) continue;
    plane.H_i1[i] = robust->H;
    for (std::size_t k = 0; k < seen.size(); ++k) plane.inlier[i][seen[k]] = robust->inlier[k];
  }
  return plane;
}

double image_share(const Window& window, const std::vector<int>& tracks, const Camera& camera) {
  if (tracks.size() < 3 || camera.width == 0) return 0;
  std::vector<cv::Point2f> points, hull;
  for (const int j : tracks) {
    const Eigen::Vector2d raw_px = distort(camera, window.points_px[0].col(j));
    points.emplace_back(static_cast<float>(raw_px.x()), static_cast<float>(raw_px.y()));
  }
  cv::convexHull(points, hull);
  return std::min(1.0, cv::contourArea(hull) / (1.0 * camera.width * camera.height));
}

void find_planes(Window& window,
                 const Camera& camera,
                 const RansacOptions& ransac,
                 const InlierOptions& options) {
  window.inliers = Inliers::planes;
  const TrackPlanes found = window_planes(window.points_px,
                                          window.threshold_px,
                                          ransac.seed,
                                          window.noise_ratio,
                                          options.on_first_plane);
  window.largest_refused = found.largest_refused;
  for (std::size_t k = 0; k < found.planes.size(); ++k) {
    window.planes.push_back(plane_of(window, found.planes[k], ransac));
    window.planes.back().image_share = image_share(window, found.planes[k], camera);
    window.planes.back().stability = found.stability[k];
  }
  if (window.planes.empty()) window.planes.push_back(plane_of(window, {}, ransac));
  window.leader = std::clamp(options.leader, 0, static_cast<int>(window.planes.size()) - 1);
  window.H_i1 = window.planes[window.leader].H_i1;
  window.inlier = window.planes[window.leader].inlier;
  if (window.planes[0].tracks.empty()) window.planes.clear();
}

void leave_out_static_tracks(const std::vector<Eigen::VectorXd>& sigma_px, Window& window) {
  window.static_tracks = static_tracks(window.points_px, sigma_px, pixel_unit(window));
  for (Matrix2Xd& points_px : window.points_px)
    for (const int j : window.static_tracks)
      points_px.col(j).setConstant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

std::optional<RobustHomography> homography_ransac(const Matrix2Xd& from,
                                                  const Matrix2Xd& to,
                                                  const RansacOptions& options,
                                                  const Eigen::VectorXd& noise_ratio) {
  const int n = static_cast<int>(from.cols());
  if (n < 4) return std::nullopt;
  RobustHomography best{Matrix3d::Identity(), std::vector<bool>(n, !options.enabled)};
  if (!options.enabled) {
    const auto H = fit_homography(from, to);
    if (H) best.H = refine_homography(*H, from, to);
    return H ? std::optional(best) : std::nullopt;
  }
  Eigen::VectorXd threshold_px =
      Eigen::VectorXd::Constant(n, options.threshold_px.value_or(kUsualThreshold));
  if (noise_ratio.size() > 0) threshold_px.array() *= noise_ratio.array();
  std::mt19937_64 random(options.seed);
  std::ptrdiff_t most = 0;
  int needed = options.most_iterations;
  for (int iteration = 0; iteration < needed; ++iteration) {
    const std::array<int, 4> sample = draw_four(random, n);
    const Matrix3d H_4 = homography_through_four(from(Eigen::all, sample), to(Eigen::all, sample));
    if (!more_agree(H_4, from, to, threshold_px, most)) continue;
    const auto H = fit_homography(from(Eigen::all, sample), to(Eigen::all, sample));
    if (!H) continue;
    std::vector<bool> inlier = agreeing_pairs(*H, from, to, threshold_px);
    const auto count = std::ranges::count(inlier, true);
    if (count <= most) continue;
    most = count;
    best = {*H, std::move(inlier)};
    needed = iterations_needed(static_cast<double>(count) / n, options);
  }
  for (int round = 0; round < 3 && most >= 4; ++round) {
    const std::vector<int> own = indices(best.inlier);
    best.H = refine_homography(best.H, from(Eigen::all, own), to(Eigen::all, own));
    std::vector<bool> inlier = agreeing_pairs(best.H, from, to, threshold_px);
    most = std::ranges::count(inlier, true);
    if (inlier == best.inlier) break;
    best.inlier = std::move(inlier);
  }
  return most >= 4 ? std::optional(best) : std::nullopt;
}

std::vector<TrackConsistency> consistency(const Window& window) {
  return consistency(errors_of(window));
}

std::vector<double> frame_gates_px(const Window& window) {
  std::vector<double> gates_px(window.frame_count(), window.threshold_px);
  if (window.inliers != Inliers::consistent) return gates_px;
  const Errors errors = errors_of(window);
  for (int i = 1; i < window.frame_count(); ++i) gates_px[i] = errors.gate[i] * errors.sigma_px[i];
  return gates_px;
}

Window make_window(const Tracks& tracks,
                   const Camera& camera,
                   std::span<const std::int64_t> recording_timestamps_ns,
                   const InlierOptions& options) {
  Window window;
  window.start = tracks.start;
  window.K = intrinsic_matrix(camera);
  window.width = camera.width;
  window.height = camera.height;
  window.exact_reference = tracks.anchored;
  for (int i = 0; i < tracks.frame_count(); ++i) {
    window.timestamps_ns.push_back(recording_timestamps_ns[tracks.start + i]);
    window.points_px.push_back(undistort_all(camera, tracks.raw_px[i]));
  }
  leave_out_static_tracks(tracks.sigma_px, window);
  window.noise_ratio = noise_ratios(tracks);
  window.lens_moves_px = lens_moves(camera, window);
  RansacOptions ransac = options.ransac;
  if (!ransac.threshold_px) ransac.threshold_px = usual_threshold_px(camera, window.points_px);
  window.threshold_px = *ransac.threshold_px;
  if (options.inliers == Inliers::planes && ransac.enabled) {
    find_planes(window, camera, ransac, options);
  } else {
    window.H_i1.push_back(Matrix3d::Identity());
    window.inlier.emplace_back(tracks.track_count(), false);
    for (int i = 1; i < window.frame_count(); ++i)
      add_homography(window, i, ransac, options.on_first_plane);
  }
  if (options.inliers == Inliers::consistent && ransac.enabled)
    select_consistent(window, options.on_first_plane);
  for (int j = 0; j < window.track_count(); ++j) window.inlier[0][j] = window.is_inlier_track(j);
  window.R_wc.assign(window.frame_count(), Matrix3d::Identity());
  return window;
}

}  // namespace gpo
