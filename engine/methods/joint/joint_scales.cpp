// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera.h"
#include "engine/geometry/decompositions.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/joint/joint_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace gpo::joint {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kLeastNoise_px = 1e-6;
/// Least noise of an estimated reference frame, relative to that of the others.
constexpr double kLeastShare = 0.1;
constexpr double kMedianOfSquares = 1.3863;  // chi-square of two numbers
constexpr std::size_t kLeastTracks = 8;
/// Candidates for the standard deviation [pixel_unit].
constexpr double kLens[] = {0, 0.05, 0.1, 0.2, 0.35, 0.6, 1, 1.8, 3};

/// The lens residual with all other unknowns eliminated: information and gradient at zero [px^2].
struct LensProblem {
  MatrixXd H;
  VectorXd b;
  double variance = 1;  ///< noise of an observation, with errors that a track shares [px^2]
};

LensProblem lens_problem(const Model& model,
                         const State& state,
                         const Normals& at,
                         const Scales& scales) {
  const Index first = model.layout().at_lens();
  const Index count = kLensTerms;
  std::vector<Index> others;
  for (Index k = 0; k < at.A.rows(); ++k)
    if (k < first || k >= first + count) others.push_back(k);
  const Priors priors = model.priors(state, scales);
  const VectorXd gradient = at.gradient + priors.gradient;
  const auto lens = Eigen::seqN(first, count);
  const MatrixXd A_on = at.A(others, lens);
  const MatrixXd gain =
      solve_symmetric(at.A(others, others) + priors.information(others, others), A_on);
  LensProblem problem;
  problem.H = at.A(lens, lens) - A_on.transpose() * gain;
  problem.b = at.gradient(lens) - gain.transpose() * gradient(others) - problem.H * state.lens;
  const MatrixXd of_track =
      at.by_track(lens, Eigen::all) - gain.transpose() * at.by_track(others, Eigen::all);
  problem.variance = std::max(scales.sigma_px * scales.sigma_px,
                              of_track.squaredNorm() / std::max(1e-12, problem.H.trace()));
  return problem;
}

/// Returns the log likelihood of the gradient, N(0, v H + H T H) for the prior covariance T.
double log_likelihood(const LensProblem& problem, double lens_px) {
  const Index count = problem.b.size();
  const double ratio = lens_px * lens_px / problem.variance;
  const MatrixXd M = MatrixXd::Identity(count, count) + ratio * problem.H;
  const Eigen::LLT<MatrixXd> factor(M);
  return 0.5 * ratio * problem.b.dot(factor.solve(problem.b)) / problem.variance -
         factor.matrixLLT().diagonal().array().log().sum();
}

}  // namespace

double noise_px(const Model& model, const Predictions& predictions) {
  std::vector<double> lengths;
  lengths.reserve(model.observation_count());
  for (std::size_t g = 0; g < predictions.size(); ++g) {
    const Group& group = model.groups()[g];
    for (std::size_t o = 0; group.frame > 0 && o < predictions[g].size(); ++o)
      lengths.push_back(predictions[g][o].r.norm() /
                        model.noise_ratio(group.tracks[o], group.frame));
  }
  const double residuals = 2.0 * static_cast<double>(lengths.size());
  const JointLayout& layout = model.layout();
  const double unknowns = layout.at_velocity(0) - layout.lens - layout.lens_parameters +
                          2.0 * static_cast<double>(model.tracks().size());
  return std::max(kLeastNoise_px,
                  median(std::move(lengths)) / kMedianOfRayleigh *
                      std::sqrt(residuals / std::max(1.0, residuals - unknowns)));
}

double reference_noise_px(const Model& model,
                          const Predictions& predictions,
                          const Normals& at,
                          const Scales& scales) {
  const double variance = scales.sigma_px * scales.sigma_px;
  std::vector<double> squares, variances;
  for (std::size_t g = 0; g < predictions.size(); ++g) {
    const Group& group = model.groups()[g];
    for (std::size_t o = 0; group.frame == 0 && o < predictions[g].size(); ++o) {
      const int track = group.tracks[o];
      const double ratio = model.noise_ratio(track, 0);
      const double weight = at.reference_weights[track];
      const Matrix2d& of_others = at.latent_weights[track];
      if (!(of_others.determinant() > 0) || of_others.trace() < 4) continue;
      const Matrix2d inverse = of_others.inverse();
      const Vector2d& r = predictions[g][o].r;
      squares.push_back((r + weight * (inverse * r)).squaredNorm() / (ratio * ratio));
      variances.push_back(0.5 * variance * inverse.trace() / (ratio * ratio));
    }
  }
  if (squares.size() < kLeastTracks) return scales.reference_px;
  // Planes and cameras absorb a homography of the positions.
  const auto count = static_cast<double>(squares.size());
  const double of_reference = count / (count - 4) * median(std::move(squares)) / kMedianOfSquares -
                              median(std::move(variances));
  return std::max(kLeastShare * scales.sigma_px, std::sqrt(std::max(0.0, of_reference)));
}

void find_lens_residual(const Model& model, const State& state, const Normals& at, Scales& scales) {
  const LensProblem problem = lens_problem(model, state, at, scales);
  double best = -std::numeric_limits<double>::infinity();
  for (const double lens : kLens) {
    const double lens_px = lens * pixel_unit(model.window());
    const double likelihood = log_likelihood(problem, lens_px);
    if (likelihood <= best) continue;
    best = likelihood;
    scales.lens_px = lens_px;
  }
}

}  // namespace gpo::joint
