// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/calibrate.h"

#include "engine/base/parallel.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

#include <fmt/format.h>

namespace gpo {

namespace {

using Views = std::vector<CalibrationView>;

constexpr int kMostViews = 60;
constexpr int kLeastViews = 8;
constexpr int kBlocks = 10;
constexpr double kMostTimesMedian = 2;  // RMS of a view
constexpr double kLeastSlantDeg = 10;
constexpr double kMostFocalSigma = 0.05;  // share of the focal length

// A coefficient is vague beyond either; those of lenses are of the order of 1.
constexpr double kMostSigma = 10;
constexpr double kMostShift = 0.25;   // shift of the image corner by its distance
constexpr double kNonzeroSigmas = 3;  // standard deviations
// Share of the RMS above which a bend explains too little; of a flat board it explains some 2 %.
constexpr double kWorthBending = 0.93;

std::optional<LensFit> fit_without_bad(Views& views, const Board& board, const LensStart& start) {
  constexpr int kRounds = 4;
  LensStart next = start;
  auto solution = fit_lens(views, board, next);
  for (int round = 0; solution && round < kRounds; ++round) {
    const double most = kMostTimesMedian * median(solution->view_rms_px);
    Views good;
    for (std::size_t i = 0; i < views.size(); ++i)
      if (solution->view_rms_px[i] <= most) good.push_back(views[i]);
    if (good.size() == views.size() || good.size() < kLeastViews) break;
    views = std::move(good);
    next.camera = solution->camera;
    next.known = true;
    solution = fit_lens(views, board, next);
  }
  return solution;
}

/// Jackknife over g blocks of time; 0 x 0 if one of the solutions fails.
Eigen::MatrixXd jackknife_covariance(const Views& views,
                                     const Board& board,
                                     const LensStart& start) {
  const int count = static_cast<int>(views.size());
  const int blocks = std::min(kBlocks, count);
  std::vector<std::optional<LensFit>> solutions(blocks);
  in_parallel(blocks, static_cast<int>(std::thread::hardware_concurrency()), [&](int block) {
    Views others;
    for (int i = 0; i < count; ++i)
      if (i * blocks / count != block) others.push_back(views[i]);
    solutions[block] = fit_lens(others, board, start);
  });
  const auto unknowns = std::ssize(parameters(start.camera));
  Eigen::MatrixXd values(unknowns, blocks);
  for (int block = 0; block < blocks; ++block) {
    if (!solutions[block]) return {};
    const auto one = parameters(solutions[block]->camera);
    values.col(block) = Eigen::Map<const Eigen::VectorXd>(one.data(), unknowns);
  }
  values.colwise() -= values.rowwise().mean().eval();
  return values * values.transpose() * (blocks - 1) / blocks;
}

struct Estimate {
  std::optional<LensFit> solution;  ///< nullopt if the views do not determine a camera
  std::vector<double> sigmas;       ///< one per parameter; empty if single views decide
  Eigen::MatrixXd covariance;       ///< with these standard deviations
  Views views;
  bool bent = false;  ///< with the shape of the board
};

Estimate estimate(const Views& views,
                  const Board& board,
                  const Camera& start,
                  const HeldCoefficients& held) {
  Estimate result;
  result.views = views;
  result.solution =
      fit_without_bad(result.views, board, {.camera = start, .with_sigmas = false, .held = held});
  if (!result.solution) return result;
  LensStart next{
      .camera = result.solution->camera, .known = true, .with_sigmas = false, .held = held};
  if (bend_is_observable(result.views, start.distortion)) {
    next.bent = true;
    Views kept = views;
    const auto bent = fit_without_bad(kept, board, next);
    next.bent = result.bent = bent && bent->rms_px < kWorthBending * result.solution->rms_px;
    if (next.bent) {
      result.solution = bent;
      result.views = std::move(kept);
      next.camera = bent->camera;
    }
  }
  result.covariance = jackknife_covariance(result.views, board, next);
  const Eigen::VectorXd sigmas = result.covariance.diagonal().cwiseSqrt();
  result.sigmas.assign(sigmas.begin(), sigmas.end());
  return result;
}

/// Returns how many times more two halves of the views disagree than their standard deviations say,
/// over random halves of the blocks of time and all parameters; 1 if hardly any half determines a
/// camera, or without standard deviations (equidistant). A jackknife leaves out too little to
/// notice errors that many views share.
double excess_of_halves(const Estimate& estimate, const Board& board, const LensStart& start) {
  constexpr int kSplits = 4, kLeastSplits = 2;
  const int count = static_cast<int>(estimate.views.size());
  const int blocks = std::min(kBlocks, count);
  std::vector<std::optional<LensFit>> fits(2 * kSplits);
  in_parallel(2 * kSplits, static_cast<int>(std::thread::hardware_concurrency()), [&](int fit) {
    std::vector<int> order(blocks);
    std::iota(order.begin(), order.end(), 0);
    std::mt19937_64 random(static_cast<std::uint64_t>(fit / 2 + 1));
    for (int k = blocks - 1; k > 0; --k)  // std::shuffle differs between libraries
      std::swap(order[k], order[random() % static_cast<std::uint64_t>(k + 1)]);
    Views half;
    for (int i = 0; i < count; ++i)
      if (order[i * blocks / count] % 2 == fit % 2) half.push_back(estimate.views[i]);
    fits[fit] = fit_lens(half, board, start);
  });
  double squares = 0;
  int splits = 0;
  for (int split = 0; split < kSplits; ++split) {
    const auto &a = fits[2 * split], &b = fits[2 * split + 1];
    if (!a || !b || a->sigmas.empty() || b->sigmas.empty()) continue;
    const auto pa = parameters(a->camera), pb = parameters(b->camera);
    double sum = 0;
    for (Eigen::Index k = 0; k < std::ssize(pa); ++k)
      sum += std::pow(pa[k] - pb[k], 2) /
             std::max(1e-30, std::pow(a->sigmas[k], 2) + std::pow(b->sigmas[k], 2));
    squares += sum / static_cast<double>(std::ssize(pa));
    ++splits;
  }
  return splits < kLeastSplits ? 1 : std::sqrt(squares / splits);
}

/// Replaces standard deviations by larger ones of the least squares and of halves of the views;
/// keeps the correlations.
void raise_sigmas(Estimate& estimate, const Board& board, const HeldCoefficients& held) {
  if (!estimate.solution || estimate.sigmas.empty()) return;
  LensStart start{
      .camera = estimate.solution->camera, .known = true, .held = held, .bent = estimate.bent};
  const auto fit = fit_lens(estimate.views, board, start);
  const double excess = std::max(1.0, excess_of_halves(estimate, board, start));
  for (std::size_t k = 0; k < estimate.sigmas.size(); ++k) {
    double& sigma = estimate.sigmas[k];
    const double least = fit && k < fit->sigmas.size() ? fit->sigmas[k] : 0;
    const double own = excess * least;
    if (!(own > sigma)) continue;
    const auto row = static_cast<Eigen::Index>(k);
    estimate.covariance.row(row) *= sigma > 0 ? own / sigma : 0;
    estimate.covariance.col(row) *= sigma > 0 ? own / sigma : 0;
    estimate.covariance(row, row) = own * own;
    sigma = own;
  }
}

/// The last coefficient that is not significantly different from 0, and vague; nullopt if none is.
std::optional<std::size_t> undetermined_coefficient(const Estimate& estimate,
                                                    const HeldCoefficients& held) {
  if (!estimate.solution || estimate.sigmas.empty()) return std::nullopt;
  const Camera& camera = estimate.solution->camera;
  const auto known = coefficients_of(camera.distortion);
  const double x = std::max(camera.cx, camera.width - 1 - camera.cx);
  const double y = std::max(camera.cy, camera.height - 1 - camera.cy);
  const double radius = std::hypot(x / camera.fx, y / camera.fy);  // to the farthest image corner
  for (std::size_t k = camera.coefficients.size(); k-- > 0;) {
    const double sigma = estimate.sigmas[4 + k];
    const double shift = sigma * std::pow(radius, known[k].power);
    const bool vague = sigma > kMostSigma || shift > kMostShift;
    const bool not_zero = std::abs(camera.coefficients[k]) > kNonzeroSigmas * sigma;
    if (vague && !not_zero && !held.contains(k)) return k;
  }
  return std::nullopt;
}

/// Fixes undetermined coefficients at 0, one after the other, each with a sentence.
Estimate estimate_determined(const Views& views,
                             const Board& board,
                             const Camera& start,
                             std::vector<std::string>& left_at_0) {
  HeldCoefficients held;
  Estimate result = estimate(views, board, start, held);
  const auto names = parameter_names(start);
  while (const auto vague = undetermined_coefficient(result, held)) {
    left_at_0.push_back(
        fmt::format("{} is not determined by these views ({:.3g} +- {:.3g}): left at 0",
                    names[4 + *vague],
                    result.solution->camera.coefficients[*vague],
                    result.sigmas[4 + *vague]));
    const int flag = coefficients_of(start.distortion)[*vague].hold;
    for (std::size_t k = 0; k < start.coefficients.size(); ++k)
      if (coefficients_of(start.distortion)[k].hold == flag) held.insert(k);
    result = estimate(views, board, start, held);
  }
  raise_sigmas(result, board, held);
  return result;
}

/// "the focal length (fx)", ...: the first that is not determined; empty if all are.
std::string undetermined_intrinsics(const Estimate& estimate) {
  if (estimate.sigmas.empty()) return "the focal length";
  const Camera& camera = estimate.solution->camera;
  for (int k = 0; k < 4; ++k)
    if (estimate.sigmas[k] > kMostFocalSigma * camera.fx)
      return fmt::format(
          "the {} ({})", k < 2 ? "focal length" : "principal point", parameter_names(camera)[k]);
  return "";
}

double coverage(const Views& views, cv::Size size) {
  constexpr int kColumns = 8, kRows = 6;
  std::set<std::pair<int, int>> cells;
  for (const CalibrationView& view : views) {
    for (const auto& corner : view.corners) {
      if (!corner.allFinite()) continue;
      cells.emplace(
          std::clamp(static_cast<int>(corner.x() * kColumns / size.width), 0, kColumns - 1),
          std::clamp(static_cast<int>(corner.y() * kRows / size.height), 0, kRows - 1));
    }
  }
  return static_cast<double>(cells.size()) / (kColumns * kRows);
}

std::vector<std::string> warnings_of(const CameraCalibration& result) {
  std::vector<std::string> warnings;
  if (result.coverage < 0.6)
    warnings.push_back(
        fmt::format("The board covers only {:.0f} % of the image, the lens is unknown in the rest: "
                    "move the board into the corners",
                    100 * result.coverage));
  if (result.slant_deg < 25)
    warnings.push_back(
        fmt::format("The board was slanted by only {:.0f} deg, so the focal length is uncertain: "
                    "film the board from the side",
                    result.slant_deg));
  if (result.camera.sigmas[0] > 0.01 * result.camera.fx)
    warnings.push_back(fmt::format("The uncertainty of the focal length is {:.1f} %",
                                   100 * result.camera.sigmas[0] / result.camera.fx));
  if (result.rms_px > 1)
    warnings.push_back(
        fmt::format("The reprojection error is {:.2f} px RMS: blur, a board that is not flat, or "
                    "another lens model",
                    result.rms_px));
  return warnings;
}

std::string why_too_few(const BoardSearch& search, std::size_t sharp) {
  std::string why =
      fmt::format("found the board in {} of {} images", search.views.size(), search.examined);
  if (sharp < search.views.size())
    why += fmt::format(", but only {} are sharp and show it from a usable side", sharp);
  why += fmt::format("; at least {} are needed", kLeastViews);
  if (const auto& other = search.other_counts)
    why +=
        fmt::format(". The images show a chessboard of {0}x{1} inner corners; use --board {0}x{1}",
                    other->width,
                    other->height);
  return why;
}

Camera unknown_camera(cv::Size size, const CalibrationOptions& options) {
  // That of a fisheye of 180 degrees; the other model finds its own start.
  const double focal_px = size.width / std::numbers::pi;
  const bool equidistant = options.distortion == Distortion::equidistant;
  return {.width = size.width,
          .height = size.height,
          .fx = focal_px,
          .fy = focal_px,
          .cx = 0.5 * (size.width - 1),
          .cy = 0.5 * (size.height - 1),
          .distortion = options.distortion,
          .coefficients = std::vector<double>(equidistant ? 4 : options.coefficients)};
}

}  // namespace

CameraCalibration calibrate_camera(const BoardSearch& search,
                                   const Board& board,
                                   const CalibrationOptions& options) {
  CameraCalibration result;
  result.examined = search.examined;
  result.found = static_cast<int>(search.views.size());
  const Views views = choose_views(search, board, kMostViews);
  const auto failed = [&](std::string reason) {
    result.reason = std::move(reason);
    return result;
  };
  if (views.size() < kLeastViews) return failed(why_too_few(search, views.size()));
  std::vector<std::string> left_at_0;
  const Estimate estimate =
      estimate_determined(views, board, unknown_camera(search.size, options), left_at_0);
  const auto& solution = estimate.solution;
  if (!solution)
    return failed("the views do not determine a camera; film the board from more sides");
  std::vector<double> slants_deg = solution->slant_deg;
  std::ranges::sort(slants_deg);
  result.slant_deg = quantile(slants_deg, 0.9);
  if (result.slant_deg < kLeastSlantDeg)
    return failed(
        fmt::format("the board is never slanted by more than {:.0f} deg, so focal length "
                    "and distance cannot be separated; film the board from the side",
                    result.slant_deg));
  if (const std::string unknown = undetermined_intrinsics(estimate); !unknown.empty())
    return failed(unknown +
                  " changes by more than 5 % with single views; film the board from more sides");
  result.ok = true;
  result.camera = solution->camera;
  set_lens_covariance(result.camera, estimate.covariance);
  result.rms_px = solution->rms_px;
  result.bend_m = solution->bend_m;
  for (const auto& view : estimate.views) result.frames.push_back(view.frame);
  result.coverage = coverage(estimate.views, search.size);
  result.warnings = warnings_of(result);
  result.warnings.insert(result.warnings.end(), left_at_0.begin(), left_at_0.end());
  return result;
}

}  // namespace gpo
