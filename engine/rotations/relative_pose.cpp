// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/decompositions.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/rotations/rotations.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <random>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <opengv/relative_pose/CentralRelativeWeightingAdapter.hpp>
#include <opengv/relative_pose/methods.hpp>

namespace gpo {
namespace {

using Eigen::ArrayXd;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Adapter = opengv::relative_pose::CentralRelativeWeightingAdapter;

constexpr double kConfidence = 0.999;
constexpr int kMostSamples = 300;
constexpr int kRefinements = 3;
constexpr double kGuessSpread = 0.1;  // starts around the guess, sine of half an angle

struct Correspondences {
  opengv::bearingVectors_t i;
  opengv::bearingVectors_t j;
  std::vector<double> weights;

  explicit Correspondences(const RayPairs& rays) : weights(rays.i.cols(), 1.0) {
    for (Eigen::Index k = 0; k < rays.i.cols(); ++k) {
      i.push_back(rays.i.col(k).normalized());
      j.push_back(rays.j.col(k).normalized());
    }
  }
  Adapter adapter() const { return {i, j, weights}; }
};

struct RotationAndDirection {
  Matrix3d R_ij;
  Vector3d direction;
};

Matrix3d essential(const RotationAndDirection& motion) {
  return skew(motion.direction) * motion.R_ij;
}

/// OpenGV's eigensolver draws no random numbers; its RANSAC draws them from the global generator.
RotationAndDirection eigensolved(const Correspondences& tracks,
                                 const std::vector<int>& chosen,
                                 const Matrix3d& R_ij_start) {
  opengv::eigensolverOutput_t output;
  output.rotation = R_ij_start;
  opengv::relative_pose::eigensolver(tracks.adapter(), chosen, output, true);
  return {output.rotation, output.eigenvectors.col(2)};
}

std::vector<std::vector<int>> members(const std::vector<int>& group) {
  const int groups = group.empty() ? 0 : 1 + *std::ranges::max_element(group);
  std::vector<std::vector<int>> found(groups);
  for (std::size_t k = 0; k < group.size(); ++k) found[group[k]].push_back(static_cast<int>(k));
  std::erase_if(found, [](const auto& of_group) { return of_group.size() < 2; });
  return found;
}

class Sampler {
 public:
  Sampler(const std::vector<int>& group, std::uint64_t seed)
      : groups_(members(group)), all_(group.size()), random_(seed) {
    std::iota(all_.begin(), all_.end(), 0);
  }

  std::vector<int> draw(int size, bool by_group) {
    std::vector<int> sample;
    // Limited tries by group: two groups of two have only four tracks.
    for (int tries = 0; static_cast<int>(sample.size()) < size; ++tries) {
      const auto& from = by_group && tries < 4 * size ? groups_[below(groups_.size())] : all_;
      const int track = from[below(from.size())];
      if (std::ranges::find(sample, track) == sample.end()) sample.push_back(track);
    }
    return sample;
  }

  bool has_groups() const { return groups_.size() > 1; }

  Matrix3d small_rotation() {
    const auto uniform = [&]() { return 2 * static_cast<double>(random_() >> 11) * 0x1p-53 - 1; };
    const double x = uniform(), y = uniform(), z = uniform();
    return so3_exp(2 * kGuessSpread * Vector3d(x, y, z));
  }

 private:
  // Not std::uniform_int_distribution, whose numbers differ between standard libraries.
  std::size_t below(std::size_t n) { return random_() % n; }

  std::vector<std::vector<int>> groups_;
  std::vector<int> all_;
  std::mt19937_64 random_;
};

std::vector<Matrix3d> proposals(const Correspondences& tracks,
                                const RelativePoseOptions& options,
                                bool from_guess,
                                const std::vector<int>& sample,
                                Sampler& sampler) {
  if (options.solver == RelativeSolver::five_point) {
    const auto found = opengv::relative_pose::fivept_nister(tracks.adapter(), sample);
    return {found.begin(), found.end()};
  }
  const Matrix3d start =
      from_guess ? options.R_ij_guess : Matrix3d(sampler.small_rotation() * options.R_ij_guess);
  return {essential(eigensolved(tracks, sample, start))};
}

/// Decomposes an essential matrix. Its two rotations differ by half a turn about the direction; the
/// one that aligns the rays better is right unless the camera moved farther than the scene is away.
RotationAndDirection decomposed(const Matrix3d& E, const RayPairs& rays) {
  const Eigen::JacobiSVD<Matrix3d> svd(E, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d W;
  W << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const auto rotation = [&](const Matrix3d& turn) -> Matrix3d {
    const Matrix3d R = svd.matrixU() * turn * svd.matrixV().transpose();
    return R.determinant() < 0 ? Matrix3d(-R) : R;
  };
  const auto agreement = [&](const Matrix3d& R) {
    const ArrayXd dots = rays.i.cwiseProduct(R * rays.j).colwise().sum().transpose();
    return (dots /
            (rays.i.colwise().norm().cwiseProduct(rays.j.colwise().norm())).transpose().array())
        .mean();
  };
  const Matrix3d one = rotation(W);
  const Matrix3d other = rotation(W.transpose());
  return {agreement(one) > agreement(other) ? one : other, svd.matrixU().col(2)};
}

std::optional<RotationAndDirection> best_proposal(const RayPairs& rays,
                                                  const Correspondences& tracks,
                                                  const RelativePoseOptions& options) {
  Sampler sampler(rays.group, options.seed);
  const bool five_point = options.solver == RelativeSolver::five_point;
  const int size = five_point ? 5 : 8;
  const double least_samples = five_point ? 16 : 6;  // few may all come from one plane
  const double gate2 = options.gate * options.gate;
  std::optional<RotationAndDirection> best;
  double least = std::numeric_limits<double>::infinity();
  double needed = kMostSamples;
  for (int k = 0; k < needed && k < kMostSamples; ++k) {
    const bool by_group = k % 2 == 1 && sampler.has_groups();
    const std::vector<int> sample = sampler.draw(size, by_group);
    for (const Matrix3d& E : proposals(tracks, options, k % 4 < 2, sample, sampler)) {
      if (!(squared_sampson_distances(E, rays).min(gate2).sum() < least)) continue;
      // The five-point algorithm's matrices are essential only up to rounding.
      const RotationAndDirection motion = decomposed(E, rays);
      const ArrayXd distances2 = squared_sampson_distances(essential(motion), rays);
      const double cost = distances2.min(gate2).sum();
      if (!(cost < least)) continue;
      least = cost;
      best = motion;
      const double share =
          static_cast<double>((distances2 < gate2).count()) / static_cast<double>(rays.i.cols());
      const double good = std::min(std::pow(share, size), 1 - 1e-12);
      needed = std::max(least_samples, 2 * std::log(1 - kConfidence) / std::log1p(-good));
    }
  }
  return best;
}

std::vector<int> within(const ArrayXd& distances2, double gate2) {
  std::vector<int> chosen;
  for (Eigen::Index k = 0; k < distances2.size(); ++k)
    if (distances2[k] < gate2) chosen.push_back(static_cast<int>(k));
  return chosen;
}

double noise_variance(const ArrayXd& distances2, const std::vector<int>& inliers) {
  const ArrayXd of_inliers = distances2(inliers);
  constexpr double kMedianOfSquare = 0.4549;  // for a unit Gaussian
  return std::max(median({of_inliers.begin(), of_inliers.end()}) / kMedianOfSquare, 1e-16);
}

/// Weights that turn the eigensolver's error into Sampson's, reduced for outliers.
std::vector<double> sampson_weights(const Matrix3d& E,
                                    const RayPairs& rays,
                                    const ArrayXd& distances2,
                                    double variance) {
  const ArrayXd slopes2 = ((E * rays.j).topRows<2>().colwise().squaredNorm() +
                           (E.transpose() * rays.i).topRows<2>().colwise().squaredNorm())
                              .transpose();
  const ArrayXd lengths2 =
      rays.i.colwise().squaredNorm().cwiseProduct(rays.j.colwise().squaredNorm()).transpose();
  const ArrayXd robust = (1 + distances2 / (9 * variance)).square().inverse();
  const ArrayXd weights = robust * lengths2 / slopes2.max(1e-12);
  return {weights.data(), weights.data() + weights.size()};
}

constexpr double kSmallestRad = 1e-4;  // limits the weight of a perfect pair

/// Returns x, frames x 3, that minimizes sum w |x_j - x_i - r|^2 with x_0 = 0.
Eigen::MatrixX3d solve_step(std::span<const RelativeRotation> relative,
                            const std::vector<Vector3d>& residuals,
                            const std::vector<double>& weights,
                            Eigen::Index frames) {
  Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(frames, frames);
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(frames, 3);
  for (std::size_t k = 0; k < relative.size(); ++k) {
    const auto& [i, j, R_ij, unused] = relative[k];
    const double w = weights[k];
    laplacian(i, i) += w;
    laplacian(j, j) += w;
    laplacian(i, j) -= w;
    laplacian(j, i) -= w;
    right.row(j) += w * residuals[k].transpose();
    right.row(i) -= w * residuals[k].transpose();
  }
  Eigen::MatrixX3d x = Eigen::MatrixX3d::Zero(frames, 3);
  x.bottomRows(frames - 1) = solve_symmetric(laplacian.bottomRightCorner(frames - 1, frames - 1),
                                             right.bottomRows(frames - 1));
  return x;
}

void average(std::span<const RelativeRotation> relative,
             std::vector<Matrix3d>& R_wc,
             int rounds,
             const std::function<double(double)>& weight) {
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vector3d> residuals;
    std::vector<double> weights;
    for (const auto& [i, j, R_ij, w] : relative) {
      // With R_wc <- exp(x) R_wc the residual log(R_wi R_ij R_wj^T) becomes r + x_i - x_j.
      residuals.push_back(so3_log(R_wc[i] * R_ij * R_wc[j].transpose()));
      weights.push_back(w * weight(residuals.back().norm()));
    }
    const auto frames = static_cast<Eigen::Index>(R_wc.size());
    const Eigen::MatrixX3d x = solve_step(relative, residuals, weights, frames);
    if (!x.allFinite()) return;
    for (Eigen::Index i = 1; i < frames; ++i) R_wc[i] = so3_exp(x.row(i).transpose()) * R_wc[i];
    if (x.rowwise().norm().maxCoeff() < 1e-10) return;
  }
}

}  // namespace

ArrayXd squared_sampson_distances(const Matrix3d& E, const RayPairs& rays) {
  const Eigen::Matrix3Xd lines_i = E * rays.j;
  const Eigen::Matrix3Xd lines_j = E.transpose() * rays.i;
  const Eigen::ArrayXXd algebraic = rays.i.cwiseProduct(lines_i).colwise().sum();
  const Eigen::ArrayXXd slopes2 =
      lines_i.topRows<2>().colwise().squaredNorm() + lines_j.topRows<2>().colwise().squaredNorm();
  return (algebraic.square() / slopes2.max(1e-24)).transpose();
}

std::optional<RelativePose> relative_pose(const RayPairs& rays,
                                          const RelativePoseOptions& options) {
  const auto count = static_cast<int>(rays.i.cols());
  if (count < kLeastPairRays) return std::nullopt;
  Correspondences tracks(rays);
  const auto proposed = best_proposal(rays, tracks, options);
  if (!proposed) return std::nullopt;
  RotationAndDirection motion = *proposed;
  const double gate2 = options.gate * options.gate;
  ArrayXd distances2 = squared_sampson_distances(essential(motion), rays);
  std::vector<int> inliers = within(distances2, gate2);
  for (int round = 0; round < kRefinements; ++round) {
    if (static_cast<int>(inliers.size()) < kLeastPairRays) return std::nullopt;
    const double variance = noise_variance(distances2, inliers);
    tracks.weights = sampson_weights(essential(motion), rays, distances2, variance);
    const RotationAndDirection refined = eigensolved(tracks, inliers, motion.R_ij);
    const ArrayXd refined2 = squared_sampson_distances(essential(refined), rays);
    // On a plane the eigensolver may leave the minimum.
    if (!(refined2.min(gate2).sum() < distances2.min(gate2).sum())) break;
    motion = refined;
    distances2 = refined2;
    inliers = within(distances2, gate2);
  }
  if (static_cast<int>(inliers.size()) < kLeastPairRays) return std::nullopt;
  RelativePose pose{.R_ij = motion.R_ij,
                    .direction = motion.direction,
                    .inlier = std::vector<bool>(count, false),
                    .inliers = static_cast<int>(inliers.size())};
  for (const int k : inliers) pose.inlier[k] = true;
  return pose;
}

std::vector<Matrix3d> average_rotations(std::span<const RelativeRotation> relative,
                                        std::vector<Matrix3d> R_wc) {
  average(relative, R_wc, 30, [](double r) { return 1 / std::max(r, kSmallestRad); });
  // The l_1/2 weights of Chatterjee & Govindu 2018 tolerate more outliers.
  average(relative, R_wc, 30, [](double r) { return std::pow(std::max(r, kSmallestRad), -1.5); });
  return R_wc;
}

}  // namespace gpo
