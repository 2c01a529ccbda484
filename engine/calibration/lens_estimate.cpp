// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/lens_estimate.h"

#include "engine/base/parallel.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/board/board.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include <fmt/format.h>

namespace gpo {

namespace {

using Views = std::vector<CalibrationView>;

constexpr int kBlocks = 10;
constexpr double kMostTimesMedian = 2;  // RMS of a view

// A coefficient is vague beyond either; those of lenses are of the order of 1.
constexpr double kMostSigma = 10;
constexpr double kMostShift = 0.25;   // shift of the image corner by its distance
constexpr double kNonzeroSigmas = 3;  // standard deviations
// Share of the RMS above which a bend explains too little; of a flat board it explains some 2 %.
constexpr double kWorthBending = 0.93;
constexpr double kMostReadout_s = 0.1;
constexpr double kSignificantSigmas = 4;  // least significance of a readout time
constexpr double kLikelySigmas = 2;       // the same before bad views are left out

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

/// Steps of a search by parabolas through three values, each a third of the one before.
struct ReadoutSearch {
  double first_step_s;
  int rounds;
};
constexpr ReadoutSearch kFromAnywhere{0.01, 3}, kFromNearby{0.003, 1};

/// Returns the readout time with the least residuals and its standard deviation by the least
/// squares; nullopt if there is no minimum. Starts at that of `start`.
std::optional<Readout> likely_readout(const Views& views,
                                      const Board& board,
                                      LensStart start,
                                      const ReadoutSearch& search) {
  double corners = 0;
  for (const CalibrationView& view : views) corners += static_cast<double>(view.corners.size());
  const double freedom = 2 * corners - 6 * static_cast<double>(views.size());
  const auto mean_square = [&](double readout_s) {
    start.readout_s = readout_s;
    const auto fit = fit_lens(views, board, start);
    return fit ? fit->rms_px * fit->rms_px : std::numeric_limits<double>::infinity();
  };
  Readout best{start.readout_s};
  double step_s = search.first_step_s;
  for (int round = 0; round < search.rounds; ++round, step_s /= 3) {
    const Eigen::Array3d squares(mean_square(best.seconds - step_s),
                                 mean_square(best.seconds),
                                 mean_square(best.seconds + step_s));
    const auto shift = least_readout(squares, step_s, freedom);
    if (!shift) return std::nullopt;
    best = {best.seconds + shift->seconds, shift->sigma_s};
    if (std::abs(best.seconds) > kMostReadout_s) return std::nullopt;
  }
  return best;
}

/// Views in blocks of time.
struct Blocks {
  explicit Blocks(const Views& views)
      : views(static_cast<int>(views.size())), count(std::min(kBlocks, this->views)) {}
  int of_view(int view) const { return view * count / views; }

  int views;
  int count;
};

/// Solutions without one of the blocks of time each.
struct Jackknife {
  Eigen::MatrixXd covariance;  ///< that of the parameters, 0 x 0 if a solution fails
  double readout_sigma_s = 0;
};

Jackknife jackknife(const Views& views,
                    const Board& board,
                    const LensStart& start,
                    bool with_readout) {
  const Blocks blocks(views);
  const auto unknowns = std::ssize(parameters(start.camera));
  Eigen::MatrixXd values(unknowns + 1, blocks.count);
  std::vector<char> failed(blocks.count, 0);
  in_parallel(blocks.count, static_cast<int>(std::thread::hardware_concurrency()), [&](int block) {
    Views others;
    for (int i = 0; i < blocks.views; ++i)
      if (blocks.of_view(i) != block) others.push_back(views[i]);
    LensStart own = start;
    if (with_readout)
      if (const auto readout = likely_readout(others, board, start, kFromNearby))
        own.readout_s = readout->seconds;
    const auto fit = fit_lens(others, board, own);
    failed[block] = fit ? 0 : 1;
    if (!fit) return;
    const auto one = parameters(fit->camera);
    values.col(block) << Eigen::Map<const Eigen::VectorXd>(one.data(), unknowns), own.readout_s;
  });
  if (std::ranges::count(failed, 1) > 0) return {};
  values.colwise() -= values.rowwise().mean().eval();
  const Eigen::MatrixXd all = values * values.transpose() * (blocks.count - 1) / blocks.count;
  return {all.topLeftCorner(unknowns, unknowns), std::sqrt(all(unknowns, unknowns))};
}

bool is_beyond(double sigmas, const Readout& readout) {
  return std::abs(readout.seconds) > sigmas * readout.sigma_s;
}

/// The given readout, else its estimate for a flat board and all views if it is likely.
std::optional<Readout> readout_of(const Views& views, const Board& board, LensStart start) {
  if (start.camera.readout) return start.camera.readout;
  const bool moving = std::ranges::all_of(
      views, [](const CalibrationView& view) { return !view.velocities_px_s.empty(); });
  const auto fit = moving ? fit_lens(views, board, start) : std::nullopt;
  if (!fit) return std::nullopt;
  start.camera = fit->camera;
  start.known = true;
  auto readout = likely_readout(views, board, start, kFromAnywhere);
  if (!readout || !is_beyond(kSignificantSigmas, *readout)) return std::nullopt;
  start.readout_s = readout->seconds;
  const double sigma_s = jackknife(views, board, start, true).readout_sigma_s;
  readout->sigma_s = std::max({readout->sigma_s, sigma_s, kLeastReadoutSigma_s});
  return is_beyond(kLikelySigmas, *readout) ? readout : std::nullopt;
}

/// Solves with the shape of the board if that explains much more.
void try_bent(const Views& views, const Board& board, LensStart& next, LensEstimate& result) {
  if (!bend_is_observable(result.views, next.camera.distortion)) return;
  next.bent = true;
  Views kept = views;
  const auto bent = fit_without_bad(kept, board, next);
  next.bent = result.bent = bent && bent->rms_px < kWorthBending * result.solution->rms_px;
  if (!next.bent) return;
  result.solution = bent;
  result.views = std::move(kept);
  next.camera = bent->camera;
}

LensEstimate estimate_with(const Views& views,
                           const Board& board,
                           const LensStart& start,
                           const std::optional<Readout>& readout) {
  LensEstimate result;
  result.views = views;
  result.readout = readout;
  LensStart next = start;
  if (readout) next.readout_s = readout->seconds;
  result.solution = fit_without_bad(result.views, board, next);
  if (!result.solution) return result;
  next.camera = result.solution->camera;
  next.known = true;
  try_bent(views, board, next, result);
  const bool estimated = readout && !start.camera.readout;
  if (estimated)
    if (const auto refined = likely_readout(result.views, board, next, kFromNearby)) {
      result.readout = refined;
      next.readout_s = refined->seconds;
      result.solution = fit_lens(result.views, board, next);
      if (!result.solution) return result;
    }
  const auto [covariance, readout_sigma_s] = jackknife(result.views, board, next, estimated);
  result.covariance = covariance;
  if (estimated)
    result.readout->sigma_s =
        std::max({result.readout->sigma_s, readout_sigma_s, kLeastReadoutSigma_s});
  const Eigen::VectorXd sigmas = result.covariance.diagonal().cwiseSqrt();
  result.sigmas.assign(sigmas.begin(), sigmas.end());
  return result;
}

LensEstimate estimate(const Views& views,
                      const Board& board,
                      const Camera& start,
                      const HeldCoefficients& held) {
  const LensStart plain{.camera = start, .with_sigmas = false, .held = held};
  const auto readout = readout_of(views, board, plain);
  LensEstimate result = estimate_with(views, board, plain, readout);
  if (!result.readout || start.readout || is_beyond(kSignificantSigmas, *result.readout))
    return result;
  return estimate_with(views, board, plain, std::nullopt);
}

/// Returns how many times more two halves of the views disagree than their standard deviations say,
/// over random halves of the blocks of time and all parameters; 1 if hardly any half determines a
/// camera, or without standard deviations (equidistant). A jackknife leaves out too little to
/// notice errors that many views share.
double excess_of_halves(const LensEstimate& estimate, const Board& board, const LensStart& start) {
  constexpr int kSplits = 4, kLeastSplits = 2;
  const Blocks blocks(estimate.views);
  std::vector<std::optional<LensFit>> fits(2 * kSplits);
  in_parallel(2 * kSplits, static_cast<int>(std::thread::hardware_concurrency()), [&](int fit) {
    std::vector<int> order(blocks.count);
    std::iota(order.begin(), order.end(), 0);
    std::mt19937_64 random(static_cast<std::uint64_t>(fit / 2 + 1));
    for (int k = blocks.count - 1; k > 0; --k)  // std::shuffle differs between libraries
      std::swap(order[k], order[random() % static_cast<std::uint64_t>(k + 1)]);
    Views half;
    for (int i = 0; i < blocks.views; ++i)
      if (order[blocks.of_view(i)] % 2 == fit % 2) half.push_back(estimate.views[i]);
    fits[fit] = fit_lens(half, board, start);
  });
  double squares = 0;
  int splits = 0;
  for (std::size_t first = 0; first < fits.size(); first += 2) {
    const auto &a = fits[first], &b = fits[first + 1];
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
void raise_sigmas(LensEstimate& estimate, const Board& board, const HeldCoefficients& held) {
  if (!estimate.solution || estimate.sigmas.empty()) return;
  LensStart start{
      .camera = estimate.solution->camera, .known = true, .held = held, .bent = estimate.bent};
  if (estimate.readout) start.readout_s = estimate.readout->seconds;
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
std::optional<std::size_t> undetermined_coefficient(const LensEstimate& estimate,
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

}  // namespace

LensEstimate estimate_lens(const Views& views,
                           const Board& board,
                           const Camera& start,
                           std::vector<std::string>& left_at_0) {
  HeldCoefficients held;
  LensEstimate result = estimate(views, board, start, held);
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

}  // namespace gpo
