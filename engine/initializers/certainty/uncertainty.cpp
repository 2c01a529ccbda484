// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/certainty/uncertainty.h"

#include "engine/initializers/common/window_checks.h"
#include "engine/initializers/plane/plane_motion.h"
#include "engine/initializers/plane/plane_weights.h"
#include "engine/initializers/plane/shared_unknowns.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using OwnMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
constexpr int kLeastClusters = 5;  // fewer frames tell nothing of what they share

using MixedMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

int shared_size(RotationModel model) { return model == RotationModel::bias ? 5 : 2; }

/// A frame's information over what it shares (normal, bias) and what is its own (phi where the
/// rotations are free, translation last).
struct SplitInformation {
  SharedInformation ss;
  MixedMatrix so;
  OwnMatrix oo;
};

SplitInformation split(const Window& window,
                       int frame,
                       const FrameNormals& normals,
                       RotationModel model) {
  const auto& F = normals.JtJ;
  if (model == RotationModel::free)
    return {F.topLeftCorner<2, 2>(), F.topRightCorner<2, 6>(), F.bottomRightCorner<6, 6>()};
  Eigen::Matrix<double, 5, Eigen::Dynamic, 0, 5, 5> M;
  M.setZero(5, shared_size(model));
  M.topLeftCorner<2, 2>().setIdentity();
  if (model == RotationModel::bias) M.bottomRightCorner<3, 3>() = window.gyro->d_bias[frame];
  return {M.transpose() * F.topLeftCorner<5, 5>() * M,
          M.transpose() * F.topRightCorner<5, 3>(),
          F.bottomRightCorner<3, 3>()};
}

/// The inverse, where the matrix is positive definite beyond rounding once its rows are scaled.
std::optional<Eigen::MatrixXd> inverse_of(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return std::nullopt;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  if (!(eigen.eigenvalues()(0) > 1e-12)) return std::nullopt;
  const Eigen::MatrixXd inverse = eigen.eigenvectors() *
                                  eigen.eigenvalues().cwiseInverse().asDiagonal() *
                                  eigen.eigenvectors().transpose();
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

/// Several planes, the frames' own unknowns eliminated.
using SharedMatrix = Eigen::MatrixXd;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, kMostShared>;
using Own = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// A frame's normal equations: what is its own (phi where rotations are free, t) is
/// -(inverse g + gain x), x what all frames share.
struct Eliminated {
  OwnMatrix inverse;
  Columns gain;
};

struct Linearization {
  std::vector<std::vector<FrameNormals>> planes;  ///< the leading one first; one a frame
  double sigma_px = 0;
};

/// Huber's loss beyond its knee, k |r|, bends along the error not at all and across it by k / |r|;
/// the weights of its least squares, k / |r| both ways, would promise too much. Nothing where every
/// weight is one, or a matrix already.
std::optional<FrameObservations> curvature_weights(const FrameObservations& f,
                                                   const FrameState& state) {
  if (!f.weight.empty()) return std::nullopt;
  if (std::all_of(f.mask.begin(), f.mask.begin() + f.count, [](double m) { return m == 1; }))
    return std::nullopt;
  FrameObservations curved = f;
  curved.weight.assign(f.count, Eigen::Matrix2d::Identity());
  for (int k = 0; k < f.count; ++k) {
    if (f.mask[k] == 1) continue;
    const Eigen::Vector2d r = transfer_error_px(f, state, k).normalized();
    curved.weight[k] = f.mask[k] * f.mask[k] * (Eigen::Matrix2d::Identity() - r * r.transpose());
  }
  return curved;
}

/// The observations of the leading plane (0) or a further one.
const std::vector<FrameObservations>& of_plane(const PlaneObservations& observations, int plane) {
  return plane == 0 ? observations.frames : observations.others[plane - 1];
}

FrameState state_of(const PlaneObservations& observations,
                    const PlaneMotion& motion,
                    int frame,
                    int plane) {
  return plane == 0 ? frame_state(observations, motion, frame)
                    : frame_state(observations, motion, frame, motion.others[plane - 1].m);
}

int own_size(RotationModel model) { return model == RotationModel::free ? 6 : 3; }

std::optional<Linearization> linearize(const PlaneObservations& observations,
                                       const PlaneMotion& motion,
                                       RotationModel model) {
  const int frames = static_cast<int>(motion.tau.size());
  const int planes = 1 + static_cast<int>(observations.others.size());
  Linearization all;
  all.planes.assign(planes, std::vector<FrameNormals>(frames));
  double cost = 0;
  bool huber = false;
  for (int k = 0; k < planes; ++k) {
    for (int i = 1; i < frames; ++i) {
      const FrameObservations& f = of_plane(observations, k)[i];
      const FrameState state = state_of(observations, motion, i, k);
      FrameNormals& normals = all.planes[k][i];
      normals = f.weight.empty() ? frame_normals(f, state, Rotating::yes)
                                 : frame_normals_by_matrix(f, state);
      if (const auto of_loss = curvature_weights(f, state)) {
        huber = true;
        const double cost_of_weights = normals.cost;
        normals = frame_normals_by_matrix(*of_loss, state);
        normals.cost = cost_of_weights;
      }
      if (!normals.in_front) return std::nullopt;
      cost += normals.cost;
    }
  }
  const int unknowns = shared_size(model) + 3 * (planes - 1) + own_size(model) * (frames - 1);
  all.sigma_px = noise_px(2 * cost, 2 * observations.count(), unknowns);
  if (huber) all.sigma_px /= kSigmaOfHuber;
  return all;
}

/// The problem around its solution, and how clusters of observations would move it.
class Sandwich {
 public:
  Sandwich(const Window& window,
           const PlaneObservations& observations,
           const PlaneMotion& motion,
           const Linearization& linearized,
           RotationModel model)
      : window_(window),
        observations_(observations),
        motion_(motion),
        layout_{static_cast<int>(observations.others.size()), model == RotationModel::bias ? 3 : 0},
        own_(own_size(model)),
        frames_(static_cast<int>(motion.tau.size())) {
    const double sigma_px = linearized.sigma_px;
    information = SharedMatrix::Zero(layout_.size(), layout_.size());
    if (layout_.gyro > 0) {
      const double ratio = sigma_px / window.gyro->prior_sigma_rad_s;
      information.diagonal().tail<3>().setConstant(ratio * ratio);
    }
    prior = information;
    eliminated.resize(frames_);
    for (int i = 1; i < frames_; ++i) eliminate(linearized, i);
  }

  SharedMatrix information;  ///< on what the frames share, with the prior [px^2]
  SharedMatrix prior;
  std::vector<Eliminated> eliminated;  ///< one a frame

  const Layout& layout() const { return layout_; }

  PlaneColumns columns(int frame, int plane) const {
    const Vector3d tau_c = motion_.R_wc[frame].transpose() * motion_.tau[frame];
    return plane_columns(plane, tau_c, gyro_columns(window_, motion_, frame, layout_.gyro));
  }

  /// Where the columns of a plane stand among all shared unknowns.
  std::vector<int> places(int plane) const {
    std::vector<int> places;
    for (int k = 0; k < Layout::size_of_plane(plane); ++k)
      places.push_back(Layout::of_plane(plane) + k);
    for (int k = 0; k < layout_.gyro; ++k) places.push_back(layout_.of_gyro() + k);
    return places;
  }

 private:
  void eliminate(const Linearization& linearized, int frame) {
    SharedMatrix so = SharedMatrix::Zero(layout_.size(), own_);
    OwnMatrix oo = OwnMatrix::Zero(own_, own_);
    for (int k = 0; k < static_cast<int>(linearized.planes.size()); ++k) {
      const auto& F = linearized.planes[k][frame].JtJ;
      const PlaneColumns M = columns(frame, k);
      const std::vector<int> at = places(k);
      information(at, at) += M.transpose() * F * M;
      so(at, Eigen::all) += M.transpose() * F.rightCols(own_);
      oo += F.bottomRightCorner(own_, own_);
    }
    const OwnMatrix inverse = oo.ldlt().solve(OwnMatrix::Identity(own_, own_));
    information -= so * inverse * so.transpose();
    eliminated[frame] = {inverse, inverse * so.transpose()};
  }

  const Window& window_;
  const PlaneObservations& observations_;
  const PlaneMotion& motion_;
  Layout layout_;
  int own_;
  int frames_;
};

/// How one observation, or a cluster of them, moves the solution.
struct Influence {
  Eigen::VectorXd shared;
  Own own;  ///< of its frame, what `shared` does to it left out
};

/// Sums over clusters, from which the covariances follow.
struct Spread {
  SharedMatrix shared;              ///< sum x x^T
  std::vector<SharedMatrix> cross;  ///< one a frame: sum x e^T
  std::vector<OwnMatrix> own;       ///< sum e e^T

  Spread(int size, int own_size, int frames)
      : shared(SharedMatrix::Zero(size, size)),
        cross(frames, SharedMatrix::Zero(size, own_size)),
        own(frames, OwnMatrix::Zero(own_size, own_size)) {}

  void add(double weight, const Eigen::VectorXd& x) { shared += weight * x * x.transpose(); }
  void add(double weight, int frame, const Eigen::VectorXd& x, const Own& e) {
    cross[frame] += weight * x * e.transpose();
    own[frame] += weight * e * e.transpose();
  }
};

/// J^T r of an observation over (u, phi, t), weighted as it is.
Eigen::Matrix<double, 8, 1> gradient_of(const FrameObservations& f,
                                        const FrameState& state,
                                        int k) {
  const Vector3d ray(f.ray_x[k], f.ray_y[k], 1);
  const Vector3d y = state.R_cw * ray - state.tau_c * state.normal.dot(ray);
  const double x = y.x() / y.z();
  const double v = y.y() / y.z();
  Eigen::Vector2d r = transfer_error_px(f, state, k);
  r = f.weight.empty() ? Eigen::Vector2d(f.mask[k] * f.mask[k] * r)
                       : Eigen::Vector2d(f.weight[k] * r);
  // dp/dy, transposed, times r; then dy/du = -tau_c (x_1.N), dy/dphi = [y]x, dy/dt = -n.x_1.
  const double a = state.fx * r.x() / y.z();
  const double b = state.fy * r.y() / y.z();
  const Vector3d g(a, b, -(a * x + b * v));
  Eigen::Matrix<double, 8, 1> gradient;
  gradient << -state.tau_c.dot(g) * (state.tangents.transpose() * ray), g.cross(y),
      -state.normal.dot(ray) * g;
  return gradient;
}

/// The observations' influences, summed by track, and of what is shared by frame, too; a frame's
/// own unknowns take up what its observations have in common. `shared_inverse` is that of the
/// information on what the frames share, zero in the rows and columns of what is held.
Spread spread_of(const Window& window,
                 const PlaneObservations& observations,
                 const PlaneMotion& motion,
                 const Sandwich& sandwich,
                 const SharedMatrix& shared_inverse,
                 double degrees_of_freedom) {
  const int frames = static_cast<int>(motion.tau.size());
  const int size = sandwich.layout().size();
  const int own = static_cast<int>(sandwich.eliminated[1].inverse.rows());
  std::vector<std::vector<std::pair<int, Influence>>> tracks(window.track_count());
  Spread by_track(size, own, frames);
  SharedMatrix by_frame = SharedMatrix::Zero(size, size);
  const bool frames_tell = frames - 1 >= kLeastClusters;
  const double of_frames = degrees_of_freedom * (frames - 1) / std::max(1, frames - 2);
  for (int i = 1; i < frames; ++i) {
    const Eliminated& eliminated = sandwich.eliminated[i];
    Eigen::VectorXd of_frame = Eigen::VectorXd::Zero(size);
    for (int k = 0; k <= static_cast<int>(observations.others.size()); ++k) {
      const FrameObservations& f = of_plane(observations, k)[i];
      const FrameState state = state_of(observations, motion, i, k);
      const PlaneColumns M = sandwich.columns(i, k);
      const std::vector<int> at = sandwich.places(k);
      for (int o = 0; o < f.count; ++o) {
        const Eigen::Matrix<double, 8, 1> g = gradient_of(f, state, o);
        Eigen::VectorXd reduced = -(eliminated.gain.transpose() * g.tail(own));
        reduced(at) += M.transpose() * g;
        Influence one{-(shared_inverse * reduced), -(eliminated.inverse * g.tail(own))};
        of_frame += one.shared;
        if (frames_tell) by_frame -= degrees_of_freedom * one.shared * one.shared.transpose();
        tracks[f.track[o]].emplace_back(i, std::move(one));
      }
    }
    if (frames_tell) by_frame += of_frames * of_frame * of_frame.transpose();
  }
  const auto clusters = static_cast<double>(
      std::ranges::count_if(tracks, [](const auto& track) { return !track.empty(); }));
  const double of_tracks = degrees_of_freedom * clusters / std::max(1.0, clusters - 1);
  for (const auto& track : tracks) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(size);
    for (const auto& [frame, influence] : track) sum += influence.shared;
    by_track.add(of_tracks, sum);
    for (const auto& [frame, influence] : track) by_track.add(of_tracks, frame, sum, influence.own);
  }
  const SharedMatrix both = by_track.shared + by_frame;
  // What frames share may add to what tracks share, never take from it: of few frames it is noise.
  const auto of_normal = [](const SharedMatrix& x) { return x.topLeftCorner<2, 2>().trace(); };
  const Eigen::SelfAdjointEigenSolver<SharedMatrix> eigen(both);
  const bool more = of_normal(both) > of_normal(by_track.shared) && eigen.eigenvalues()(0) >= 0;
  if (more) by_track.shared = both;
  return by_track;
}

int tracks_of(const PlaneObservations& observations) {
  std::set<int> tracks;
  for (int k = 0; k <= static_cast<int>(observations.others.size()); ++k)
    for (const FrameObservations& f : of_plane(observations, k))
      tracks.insert(f.track.begin(), f.track.end());
  return static_cast<int>(tracks.size());
}

/// Covariances of a frame's camera center and of its distance ratio 1 - n.tau.
void add_frame(const PlaneMotion& motion,
               int frame,
               const Eliminated& f,
               const Spread& spread,
               Uncertainty& result) {
  const SharedMatrix& Y = spread.shared;
  const Eigen::MatrixXd cross = -Y * f.gain.transpose() + spread.cross[frame];
  const Eigen::MatrixXd gained = f.gain * spread.cross[frame];
  const Eigen::MatrixXd own =
      f.gain * Y * f.gain.transpose() - gained - gained.transpose() + spread.own[frame];
  const Matrix3d t = own.bottomRightCorner<3, 3>();
  const Eigen::Matrix<double, 2, 3> ut = cross.topRightCorner<2, 3>();
  const Matrix3d& R = motion.R_wc[frame];
  result.center_covariances.emplace_back(R * t * R.transpose());
  const Eigen::Vector2d d_u = -(normal_tangents(motion.normal).transpose() * motion.tau[frame]);
  const Vector3d d_t = -(R.transpose() * motion.normal);
  const double ratio_variance =
      d_u.dot(Y.topLeftCorner<2, 2>() * d_u) + 2 * d_u.dot(ut * d_t) + d_t.dot(t * d_t);
  result.distance_ratio_sigmas.push_back(std::sqrt(std::max(0.0, ratio_variance)));
}

/// The inverse information of what is unknown; of a bias that is held, only the rest's.
std::optional<SharedMatrix> shared_inverse_of(const Sandwich& sandwich, bool holds_bias) {
  const int size = sandwich.layout().size();
  const int unknown = holds_bias ? size - 3 : size;
  const auto inverse = inverse_of(sandwich.information.topLeftCorner(unknown, unknown));
  if (!inverse) return std::nullopt;
  SharedMatrix all = SharedMatrix::Zero(size, size);
  all.topLeftCorner(unknown, unknown) = *inverse;
  return all;
}

/// What is not known of the bias, beside the pictures' noise: the prior, where it is estimated; an
/// error db of one that is held moves the rest by -A_uu^-1 A_ub db.
SharedMatrix bias_share(const Window& window,
                        const Sandwich& sandwich,
                        const SharedMatrix& shared_inverse,
                        double sigma_px,
                        bool holds_bias) {
  const int size = sandwich.layout().size();
  if (sandwich.layout().gyro == 0) return SharedMatrix::Zero(size, size);
  if (!holds_bias)
    return sigma_px * sigma_px * shared_inverse * sandwich.prior * shared_inverse.transpose();
  SharedMatrix moves = -shared_inverse * sandwich.information.rightCols(3);
  moves.bottomRows<3>().setIdentity();
  return moves * window.gyro->bias_covariance * moves.transpose();
}

/// Cramer-Rao bound of the normal's angle under independent noise [deg].
std::optional<double> bound_deg(const Window& window,
                                const PlaneObservations& observations,
                                const PlaneMotion& motion,
                                const Linearization& linearized,
                                RotationModel model) {
  const Sandwich plain(window, observations, motion, linearized, model);
  const auto covariance = inverse_of(plain.information);
  if (!covariance) return std::nullopt;
  return degrees(linearized.sigma_px * std::sqrt(covariance->topLeftCorner<2, 2>().trace()));
}

}  // namespace

SharedInformation prior_information(const Window& window, RotationModel model, double sigma_px) {
  const int size = shared_size(model);
  SharedInformation prior = SharedInformation::Zero(size, size);
  if (model == RotationModel::bias) {
    const double ratio = sigma_px / window.gyro->prior_sigma_rad_s;
    prior.diagonal().tail<3>().setConstant(ratio * ratio);
  }
  return prior;
}

SharedInformation frame_information(const Window& window,
                                    int frame,
                                    const FrameNormals& normals,
                                    RotationModel model) {
  const SplitInformation f = split(window, frame, normals, model);
  return f.ss - f.so * f.oo.ldlt().solve(f.so.transpose());
}

std::optional<double> normal_sigma_deg(const SharedInformation& information, double sigma_px) {
  const auto covariance = inverse_of(information);
  if (!covariance) return std::nullopt;
  return degrees(sigma_px * std::sqrt(covariance->topLeftCorner<2, 2>().trace()));
}

std::optional<Uncertainty> uncertainty_of(const Window& window,
                                          const PlaneObservations& observations,
                                          const PlaneMotion& motion,
                                          RotationModel model) {
  const auto linearized = linearize(observations, motion, model);
  if (!linearized) return std::nullopt;
  const bool holds_bias = model == RotationModel::known && window.gyro;
  const RotationModel moving = holds_bias ? RotationModel::bias : model;
  const Sandwich sandwich(window, observations, motion, *linearized, moving);
  const auto inverse = shared_inverse_of(sandwich, holds_bias);
  if (!inverse) return std::nullopt;
  const int frames = static_cast<int>(motion.tau.size());
  const double residuals = 2.0 * observations.count();
  const double unknowns = inverse->rows() + own_size(model) * (frames - 1.0);
  Spread spread = spread_of(window,
                            observations,
                            motion,
                            sandwich,
                            *inverse,
                            residuals / std::max(1.0, residuals - unknowns));
  spread.shared += bias_share(window, sandwich, *inverse, linearized->sigma_px, holds_bias);
  const SharedMatrix& covariance = spread.shared;
  Uncertainty result;
  result.sigma_px = linearized->sigma_px;
  result.rotations = model;
  result.tracks = tracks_of(observations);
  const auto tangents = normal_tangents(motion.normal);
  result.normal_covariance = tangents * covariance.topLeftCorner<2, 2>() * tangents.transpose();
  result.normal_sigma_deg = degrees(std::sqrt(result.normal_covariance.trace()));
  for (std::size_t k = 0; k < motion.others.size(); ++k) {
    const int at = Layout::of_plane(static_cast<int>(k) + 1);
    const auto N = normal_tangents(motion.others[k].m.normalized());
    result.others.push_back({N * covariance.block<2, 2>(at, at) * N.transpose(),
                             std::sqrt(std::max(0.0, covariance(at + 2, at + 2)))});
  }
  result.center_covariances.emplace_back(Matrix3d::Zero());
  result.distance_ratio_sigmas.push_back(0);
  for (int i = 1; i < frames; ++i) add_frame(motion, i, sandwich.eliminated[i], spread, result);
  if (model == RotationModel::bias) result.bias_covariance = covariance.bottomRightCorner<3, 3>();
  const auto bound = [&](RotationModel of) {
    return bound_deg(window, observations, motion, *linearized, of);
  };
  result.bound_known_rotations_deg = bound(RotationModel::known);
  if (window.gyro) result.bound_unknown_bias_deg = bound(RotationModel::bias);
  return result;
}

std::optional<Uncertainty> uncertainty_of(const Window& window,
                                          const Plane& plane,
                                          std::span<const Pose> cameras,
                                          RotationModel model) {
  return uncertainty_of(window, plane_observations(window), motion_of(plane, cameras), model);
}

}  // namespace gpo
