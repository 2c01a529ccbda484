// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/uncertainty/information.h"

#include "engine/geometry/decompositions.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/plane/plane_weights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr int kLeastClusters = 5;  // least number of frames as clusters

/// Root of the mean square of two-dimensional Gaussian noise under Huber weights.
constexpr double kSigmaOfHuber = 0.8636;

/// Returns true if some observation is beyond the knee of Huber's loss.
bool has_huber_weights(const FrameObservations& f) {
  return f.weight.empty() &&
         std::any_of(f.mask.begin(), f.mask.begin() + f.count, [](double m) { return m != 1; });
}

/// Returns the part of the spread that frames have in common, without that of single observations;
/// zero with too few frames.
SharedMatrix spread_by_frame(const Influences& all, int frames, double degrees_of_freedom) {
  const Index size = all.shared.rows();
  if (frames - 1 < kLeastClusters) return SharedMatrix::Zero(size, size);
  Eigen::MatrixXd sums(size, frames);
  for (int i = 0; i < frames; ++i)
    sums.col(i) =
        all.shared.middleCols(all.first[i], all.first[i + 1] - all.first[i]).rowwise().sum();
  const SharedMatrix of_frames = (frames - 1.0) / (frames - 2.0) * sums * sums.transpose();
  return degrees_of_freedom * (of_frames - all.shared * all.shared.transpose());
}

/// Returns the share of `independent` in the mean with the sum over the moves' squares that has the
/// least expected error, in axes in which `independent` is the identity (Ledoit and Wolf 2004).
double shrinkage(const Eigen::MatrixXd& moves, const Eigen::MatrixXd& independent) {
  // A bias and one rotation per frame have directions without information, in which both are zero
  // up to rounding.
  constexpr double kLeast = 1e-6;
  const Eigen::VectorXd variances = independent.diagonal();
  const Eigen::VectorXd scales = (variances.array() > 0).select(variances.cwiseSqrt(), 1);
  Eigen::MatrixXd correlations = independent.array() / (scales * scales.transpose()).array();
  correlations.diagonal().array() = 1 + kLeast;
  const Eigen::LLT<Eigen::MatrixXd> factor(correlations);
  if (factor.info() != Eigen::Success) return 1;
  const Eigen::MatrixXd white = factor.matrixL().solve(scales.cwiseInverse().asDiagonal() * moves);
  Eigen::MatrixXd sum = square_of(white);
  const double chance = white.colwise().squaredNorm().squaredNorm() -
                        sum.squaredNorm() / static_cast<double>(moves.cols());
  sum.diagonal().array() -= sum.diagonal().mean();
  const double deviation = sum.squaredNorm();
  return deviation > 0 ? std::clamp(chance / deviation, 0.0, 1.0) : 1;
}

template <int kOwn>
OwnMatrix inverse_of(const OwnMatrix& oo) {
  using Matrix = Eigen::Matrix<double, kOwn, kOwn>;
  const Eigen::LDLT<Matrix> factor(oo);
  Matrix inverse;
  for (int c = 0; c < kOwn; ++c)  // Eigen unrolls the solution for a single column
    inverse.col(c) = factor.solve(Eigen::Matrix<double, kOwn, 1>::Unit(c));
  return inverse;
}

using OwnShared = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, kMostShared>;

/// Adds a plane's normal equations in a frame to the shared ones, and the frame's own unknowns with
/// the shared ones to `os`. Eigen's products for large matrices take thrice the time.
void add_plane(const Eigen::Matrix<double, 8, 8>& F,
               const PlaneColumns& M,
               int plane,
               Bread& bread,
               OwnShared& os) {
  const PlaneColumns FM = F.lazyProduct(M);
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 7, 7> MFM =
      M.transpose().lazyProduct(FM);
  const int p = UnknownsLayout::of_plane(plane), n = UnknownsLayout::size_of_plane(plane);
  const int g = bread.layout.of_gyro(), b = bread.layout.gyro;
  SharedMatrix& shared = bread.information;
  shared.block(p, p, n, n) += MFM.topLeftCorner(n, n);
  shared.block(p, g, n, b) += MFM.topRightCorner(n, b);
  shared.block(g, p, b, n) += MFM.bottomLeftCorner(b, n);
  shared.block(g, g, b, b) += MFM.bottomRightCorner(b, b);
  os.middleCols(p, n) += FM.leftCols(n).bottomRows(os.rows());
  os.middleCols(g, b) += FM.rightCols(b).bottomRows(os.rows());
}

/// Returns the gradients over (u, phi, t) of half the loss, one column for each observation.
Eigen::Matrix<double, 8, Eigen::Dynamic> gradients_of(const FrameObservations& f,
                                                      const FrameState& state) {
  Eigen::Matrix<double, 8, Eigen::Dynamic> all(8, f.count);
  for (int k = 0; k < f.count; ++k) {
    const Transfer transfer = transfer_of(f, state, k);
    const Eigen::Vector2d r = transfer.pixel - Eigen::Vector2d(f.u[k], f.v[k]);
    all.col(k).noalias() = transfer.jacobian(state.tangents).transpose() * (weight_of(f, k) * r);
  }
  return all;
}

}  // namespace

Eigen::MatrixXd power_of_positive(const Eigen::MatrixXd& A, double power) {
  const auto [values, vectors] = symmetric_eigen(A);
  const double least = 1e-12 * values.cwiseAbs().maxCoeff();
  const Eigen::VectorXd powers =
      values.unaryExpr([&](double v) { return v > least ? std::pow(v, power) : 0; });
  return vectors * powers.asDiagonal() * vectors.transpose();
}

Eigen::MatrixXd square_of(const Eigen::MatrixXd& moves) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(moves.rows(), moves.rows());
  if (moves.cols() > 0) all.selfadjointView<Eigen::Lower>().rankUpdate(moves);
  all.triangularView<Eigen::StrictlyUpper>() = all.transpose();
  return all;
}

int own_size(RotationModel model, const PlaneMotion& motion) {
  const bool noisy = model == RotationModel::bias && !motion.gyro_noise_rad.empty();
  return model == RotationModel::free || noisy ? 6 : 3;
}

std::optional<Linearization> linearize(const SolvedPlanes& solved, RotationModel model) {
  const PlaneObservations& observations = solved.observations;
  const int frames = solved.frame_count();
  Linearization all;
  all.planes.assign(observations.plane_count(), std::vector<FrameNormals>(frames));
  double cost = 0;
  bool huber = false;
  for (int k = 0; k < observations.plane_count(); ++k) {
    for (int i = 1; i < frames; ++i) {
      const FrameObservations& f = observations.plane(k)[i];
      const FrameState state = frame_state(observations, solved.motion, i, k);
      FrameNormals& normals = all.planes[k][i] = curved_normals(f, state);
      huber = huber || has_huber_weights(f);
      if (!normals.in_front) return std::nullopt;
      cost += normals.cost;
    }
  }
  const UnknownsLayout layout{observations.plane_count() - 1, gyro_unknowns(solved.window, model)};
  const int unknowns = layout.size() + own_size(model, solved.motion) * (frames - 1);
  all.sigma_px = noise_px(2 * cost, 2 * observations.count(), unknowns);
  if (huber) all.sigma_px /= kSigmaOfHuber;
  return all;
}

std::vector<int> Bread::places(int plane) const {
  std::vector<int> places(UnknownsLayout::size_of_plane(plane) + layout.gyro);
  const auto gyro = places.end() - layout.gyro;
  std::iota(places.begin(), gyro, UnknownsLayout::of_plane(plane));
  std::iota(gyro, places.end(), layout.of_gyro());
  return places;
}

Bread bread_of(const SolvedPlanes& solved, const Linearization& linearized, RotationModel model) {
  const auto& [window, observations, motion] = solved;
  const int planes = static_cast<int>(linearized.planes.size());
  const int frames = solved.frame_count();
  Bread bread{.layout = {planes - 1, gyro_unknowns(window, model)}, .own = own_size(model, motion)};
  bread.columns.assign(planes, std::vector<PlaneColumns>(frames));
  bread.prior = prior_information(window, bread.layout, linearized.sigma_px);
  const bool noisy = model == RotationModel::bias && bread.own == 6;
  if (noisy) bread.noise_weights.resize(frames);
  for (int i = 1; i < frames; ++i) {
    const GyroColumns by_gyro = gyro_columns(window, motion, i, bread.layout.gyro);
    const Vector3d tau_c = motion.R_wc[i].transpose() * motion.tau[i];
    for (int k = 0; k < planes; ++k) bread.columns[k][i] = plane_columns(k, tau_c, by_gyro);
    if (noisy)
      bread.noise_weights[i] = prior_weight(linearized.sigma_px, gyro_noise_sigma_rad(window, i));
  }
  eliminate(linearized, bread);
  return bread;
}

void eliminate(const Linearization& linearized, Bread& bread) {
  const int own = bread.own;
  const auto frames = bread.columns[0].size();
  bread.information = bread.prior;
  bread.frames.resize(frames);
  for (std::size_t i = 1; i < frames; ++i) {
    OwnShared os = OwnShared::Zero(own, bread.layout.size());
    OwnMatrix oo = OwnMatrix::Zero(own, own);
    for (int k = 0; k < std::ssize(bread.columns); ++k) {
      const auto& F = linearized.planes[k][i].JtJ;
      add_plane(F, bread.columns[k][i], k, bread, os);
      oo += F.bottomRightCorner(own, own);
    }
    if (!bread.noise_weights.empty()) oo.diagonal().head<3>().array() += bread.noise_weights[i];
    auto& [inverse, gain] = bread.frames[i];
    inverse = own == 3 ? inverse_of<3>(oo) : inverse_of<6>(oo);
    gain = inverse.lazyProduct(os);
    bread.information -= os.transpose().lazyProduct(gain);
  }
}

Eigen::VectorXd reduced_gradient(const Linearization& linearized, const Bread& bread) {
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(bread.layout.size());
  for (int i = 1; i < std::ssize(bread.frames); ++i) {
    const auto& gain = bread.frames[i].gain;
    for (int k = 0; k < std::ssize(bread.columns); ++k) {
      const auto& g = linearized.planes[k][i].Jtr;
      reduced(bread.places(k)) += bread.columns[k][i].transpose() * g;
      reduced -= gain.transpose() * g.tail(gain.rows());
    }
  }
  return reduced;
}

void Spread::add(const SolutionMove& move) {
  const auto& [x, e] = move;
  shared += x * x.transpose();
  for (std::size_t i = 1; i < e.size(); ++i) {
    cross[i] += x * e[i].transpose();
    own[i] += e[i] * e[i].transpose();
  }
}

Influences influences_of(const Sandwich& sandwich) {
  const auto& [solved, bread, inverse] = sandwich;
  const auto own = bread.frames[1].inverse.rows();
  const int count = solved.observations.count();
  Influences all{.shared = Eigen::MatrixXd(inverse.rows(), count),
                 .own = Eigen::MatrixXd(own, count),
                 .track = {},
                 .first = {0}};
  for (int i = 1; i < solved.frame_count(); ++i) {
    all.first.push_back(std::ssize(all.track));
    const Eliminated& frame = bread.frames[i];
    for (int k = 0; k < std::ssize(bread.columns); ++k) {
      const FrameObservations& f = solved.observations.plane(k)[i];
      const FrameState state = frame_state(solved.observations, solved.motion, i, k);
      const auto g = gradients_of(f, state);
      Eigen::MatrixXd reduced = frame.gain.transpose() * g.bottomRows(own);
      reduced(bread.places(k), Eigen::all) -= bread.columns[k][i].transpose() * g;
      const Index at = std::ssize(all.track);
      all.shared.middleCols(at, f.count).noalias() = inverse * reduced;
      all.own.middleCols(at, f.count).noalias() = -frame.inverse * g.bottomRows(own);
      all.track.insert(all.track.end(), f.track.begin(), f.track.end());
    }
  }
  all.first.push_back(count);
  return all;
}

Eigen::MatrixXd shrunk_covariance(const Eigen::MatrixXd& moves,
                                  const Eigen::MatrixXd& square,
                                  const Eigen::MatrixXd& independent) {
  const double share = shrinkage(moves, independent);
  return (1 - share) * square + share * independent;
}

Eigen::MatrixXd with_blocks_of(const Eigen::MatrixXd& blocks,
                               std::span<const int> sizes,
                               Eigen::MatrixXd covariance) {
  Index at = 0;
  for (const int size : sizes) {
    const auto rows = Eigen::seqN(at, size);
    const Eigen::MatrixXd F = power_of_positive(blocks(rows, rows), 0.5) *
                              power_of_positive(covariance(rows, rows), -0.5);
    covariance(rows, Eigen::all) = (F * covariance(rows, Eigen::all)).eval();
    covariance(Eigen::all, rows) = (covariance(Eigen::all, rows) * F.transpose()).eval();
    at += size;
  }
  return covariance;
}

Spread spread_of(const Sandwich& sandwich, const Influences& all, double degrees_of_freedom) {
  const int frames = sandwich.solved.frame_count();
  const auto size = all.shared.rows(), own = all.own.rows();
  const int columns = sandwich.solved.window.track_count();
  Eigen::MatrixXd of_track = Eigen::MatrixXd::Zero(size, columns);
  std::vector<char> seen(columns, 0);
  for (Index o = 0; o < all.shared.cols(); ++o) {
    of_track.col(all.track[o]) += all.shared.col(o);
    seen[all.track[o]] = 1;
  }
  const auto tracks = static_cast<double>(std::ranges::count(seen, 1));
  const double of_tracks = degrees_of_freedom * tracks / std::max(1.0, tracks - 1);
  Spread spread{of_tracks * of_track * of_track.transpose(),
                std::vector<SharedMatrix>(frames, SharedMatrix::Zero(size, own)),
                std::vector<OwnMatrix>(frames, OwnMatrix::Zero(own, own))};
  for (int i = 1; i < frames; ++i) {
    const auto columns_of_frame = Eigen::seq(all.first[i], all.first[i + 1] - 1);
    const Eigen::MatrixXd e = all.own(Eigen::all, columns_of_frame);
    const std::span of_frame(all.track.data() + all.first[i], e.cols());
    spread.cross[i] = of_tracks * of_track(Eigen::all, of_frame) * e.transpose();
    spread.own[i] = of_tracks * e * e.transpose();
  }
  // The frames' part may only increase the spread: a decrease is noise of few frames.
  const SharedMatrix both = spread.shared + spread_by_frame(all, frames, degrees_of_freedom);
  const auto of_normal = [](const SharedMatrix& x) { return x.topLeftCorner<2, 2>().trace(); };
  if (of_normal(both) > of_normal(spread.shared) && symmetric_eigen(both).values(0) >= 0)
    spread.shared = both;
  return spread;
}

SharedInformation prior_information(const Window& window,
                                    const UnknownsLayout& layout,
                                    double sigma_px) {
  SharedInformation prior = SharedInformation::Zero(layout.size(), layout.size());
  const GyroVector sigmas = gyro_prior_sigmas(window, layout.gyro);
  for (int k = 0; k < layout.gyro; ++k)
    prior(layout.of_gyro() + k, layout.of_gyro() + k) = prior_weight(sigma_px, sigmas(k));
  return prior;
}

SharedInformation frame_information(const Window& window,
                                    int frame,
                                    const FrameNormals& normals,
                                    RotationModel model) {
  const int gyro = gyro_unknowns(window, model);
  const int own = model == RotationModel::free ? 6 : 3;
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(8, 2 + gyro);  // d(u, phi, t) / d(shared unknowns)
  M.topLeftCorner<2, 2>().setIdentity();
  if (gyro > 0) M.block<3, 3>(2, 2) = window.gyro->d_bias[frame];
  if (gyro > 3) M.block<3, 1>(2, 5) = window.gyro->d_offset[frame];
  const Eigen::MatrixXd FM = normals.JtJ * M;
  const auto os = FM.bottomRows(own);
  return M.transpose() * FM -
         os.transpose() * solve_symmetric(normals.JtJ.bottomRightCorner(own, own), os);
}

std::optional<double> normal_sigma_deg(const SharedInformation& information, double sigma_px) {
  const auto covariance = inverse_information(information);
  if (!covariance) return std::nullopt;
  return degrees(sigma_px * std::sqrt(covariance->topLeftCorner<2, 2>().trace()));
}

std::optional<double> normal_bound_deg(const Window& window,
                                       const Plane& plane,
                                       std::span<const Pose> cameras,
                                       double sigma_px) {
  const PlaneObservations observations = plane_observations(window);
  const PlaneMotion motion = motion_of(plane, cameras);
  SharedInformation information = SharedInformation::Zero(2, 2);
  for (int i = 1; i < window.frame_count(); ++i) {
    const FrameNormals normals =
        frame_normals(observations.frames[i], frame_state(observations, motion, i), Rotating::no);
    information += frame_information(window, i, normals, RotationModel::known);
  }
  return normal_sigma_deg(information, sigma_px);
}

std::optional<Eigen::MatrixXd> inverse_information(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return std::nullopt;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const auto [values, vectors] = symmetric_eigen(scaled);
  if (!(values(0) > 1e-12)) return std::nullopt;
  const Eigen::MatrixXd inverse =
      vectors * values.cwiseInverse().asDiagonal() * vectors.transpose();
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

}  // namespace gpo
