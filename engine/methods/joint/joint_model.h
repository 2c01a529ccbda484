// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// One least-squares problem over everything that is unknown in a window: planes, cameras,
// gyroscope, row delay, positions of the tracks in the reference frame, errors of the lens and of
// the surfaces (engine/method.md, "Joint model").
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/smooth_path.h"
#include "engine/window/window.h"

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace gpo::joint {

struct Options {
  RotationModel rotations = RotationModel::known;
  bool gyro_noise = false;
  bool time_offset = false;
  std::optional<RowDelayPrior> row_delay = std::nullopt;  ///< nullopt: global shutter
  bool huber = true;
  /// The velocities of the frames are unknowns, around those of the smoothed path.
  bool free_velocities = false;
};

inline constexpr double kHuberSigmas = 1.345;
inline constexpr double kGateSigmas = 5;           ///< observations beyond have no weight
inline constexpr int kMonomials = 7;               ///< degrees 2 and 3 in the pixel
inline constexpr int kLensTerms = 2 * kMonomials;  ///< for both coordinates
using Monomials = Eigen::Matrix<double, kMonomials, 1>;

/// Order of the unknowns: those that all frames share (`UnknownsLayout`), row delay, lens
/// parameters (held: they only contribute to the uncertainty), lens residual, the frames' own ones:
/// t, or (phi, t), and their velocities: rotation, translation.
struct JointLayout {
  UnknownsLayout shared;
  int row_delay = 0;  ///< 0 or 1
  int lens_parameters = 0;
  bool typical_lens = false;  ///< the lens parameters have a typical uncertainty
  int planes = 1;
  int own = 3;  ///< unknowns of a frame
  int frames = 0;
  int velocity = 0;  ///< unknown components of each frame's velocity: 0, or 6

  int at_row_delay() const { return shared.size(); }
  int at_parameters() const { return at_row_delay() + row_delay; }
  int at_lens() const { return at_parameters() + lens_parameters; }
  int at_frame(int frame) const { return at_lens() + kLensTerms + own * (frame - 1); }
  int at_translation(int frame) const { return at_frame(frame) + own - 3; }
  int at_velocity(int frame) const { return at_frame(frames) + velocity * frame; }
  int size() const { return at_velocity(frames); }
};

struct State {
  PlaneMotion motion;
  double row_delay_s = 0;
  Eigen::VectorXd lens;              ///< coefficients of its residual [px]
  Eigen::Matrix2Xd shift_px;         ///< latent minus observed reference position, one per track
  std::vector<Velocity> velocities;  ///< one per frame, held within an iteration
};

/// Standard deviations that weight the parts of the cost; those of a part that is absent are zero.
struct Scales {
  double sigma_px = 0.5;      ///< noise of a coordinate
  double reference_px = 0.5;  ///< the same in the reference frame
  double lens_px = 0;         ///< each coefficient of the lens residual
};

/// A track with its observations; the first one is in the reference frame.
struct Track {
  struct Seen {
    int frame = 0;
    int index = 0;  ///< in the frame's observations
  };
  int plane = 0;
  int column = 0;                ///< in the window
  Eigen::Vector2d reference_px;  ///< observed, relative to the principal point
  std::vector<Seen> seen = {{}};
};

/// Normal equations with the latent positions eliminated, without priors [px^2].
struct Normals {
  Eigen::MatrixXd A;               ///< over all unknowns of `JointLayout`
  Eigen::MatrixXd by_track;        ///< gradient of each track's cost in a column
  Eigen::MatrixXd E;               ///< unknowns x latent positions
  std::vector<Eigen::Matrix2d> V;  ///< over the latent position of each track
  std::vector<Eigen::Vector2d> v;
  double cost = 0;
  bool in_front = true;
};

/// Prior information, with its gradient and cost [px^2].
struct Priors {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  double cost = 0;
};

/// Second derivatives of the robust loss, or the weights of the least squares.
enum class Curvature { of_loss, of_weights };

class Model {
 public:
  /// `observations`: of the main plane and of the planes of `start`, unweighted.
  Model(const Window& window,
        const PlaneObservations& observations,
        const PlaneMotion& start,
        const Options& options);

  const JointLayout& layout() const { return layout_; }
  const Options& options() const { return options_; }
  const Window& window() const { return window_; }
  std::span<const Track> tracks() const { return tracks_; }
  /// Returns the noise of a track's observation in that of a typical one.
  double noise_ratio(int track, int frame) const {
    return window_.noise_ratio_of(frame, tracks_[track].column);
  }
  int observation_count() const { return observations_.count(); }

  State first(const PlaneMotion& start) const;
  Normals linearize(const State& state, const Scales& scales, Curvature curvature) const;
  Priors priors(const State& state, const Scales& scales) const;
  /// Moves all unknowns by `x` and the latent positions to their optimum.
  State moved(const State& from,
              const Eigen::VectorXd& x,
              const Normals& at,
              const Scales& scales) const;
  /// Returns the errors of the reference positions, one per track [px].
  Eigen::Matrix2Xd reference_errors_px(const State& state) const;
  /// Returns the errors of the observations in all other frames, over their noise ratios [px].
  Eigen::Matrix2Xd errors_px(const State& state) const;

 private:
  using Row = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 64>;
  /// The predicted observation and what its derivatives share.
  struct Prediction {
    double seconds = 0;  ///< from the frame's time stamp
    FrameState at;       ///< the frame when it reads the row
    Transfer transfer;
    Eigen::Vector2d d_height;
    Monomials lens;
    Eigen::Vector2d r;  ///< error [px]

    Eigen::Matrix2d jacobian_of_latent() const {
      const Eigen::Matrix3d A = at.R_cw - at.tau_c * at.normal.transpose();
      const Eigen::Vector2d per_px(1 / at.fx, 1 / at.fy);
      return transfer.d_y * A.leftCols<2>() * per_px.asDiagonal();
    }
  };

  void gather_tracks();
  Eigen::MatrixXd walk_information(const PlaneMotion& start) const;
  std::vector<int> columns_of(int plane, int frame) const;
  Eigen::Vector2d observed_px(const Track& track, Track::Seen seen) const;
  /// Returns the states at the frames' time stamps, for each plane one per frame.
  std::vector<std::vector<FrameState>> stamps(const State& state) const;
  Prediction predict(const State& state,
                     const FrameState& at_stamp,
                     int track,
                     Track::Seen seen) const;
  /// Inputs of the derivatives that all observations of a plane in a frame share.
  struct Shared {
    int frame = 0;
    FrameState at_stamp;
    GyroColumns gyro;
    std::vector<int> columns;  ///< their unknowns
  };
  /// Returns the derivatives of an error over the shared columns.
  Row jacobian(const State& state,
               const Prediction& prediction,
               const Track& track,
               const Shared& shared) const;
  void add_group(const State& state,
                 std::span<const std::pair<int, Track::Seen>> group,
                 const Scales& scales,
                 Curvature curvature,
                 Normals& all) const;
  /// Returns the noise of the poses with all unknowns of other frames fixed.
  PathNoise path_noise(const Normals& at, const Scales& scales) const;
  void update_velocities(State& state, const PathNoise& noise) const;

  const Window& window_;
  std::vector<std::vector<Eigen::Matrix2Xd>> lens_moves_px_;
  const PlaneObservations& observations_;
  Options options_;
  JointLayout layout_;
  double image_px_ = 1;  ///< from the principal point to a corner
  std::vector<Track> tracks_;
  Eigen::MatrixXd walk_;  ///< prior information of the gyroscope noise [1 / rad^2]; may be empty
};

}  // namespace gpo::joint
