// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// One least-squares problem over everything that is unknown in a window: planes, cameras,
// gyroscope, row delay, positions of the tracks in the reference frame, errors of the lens and of
// the surfaces (engine/method.md, "Joint model").
#include "engine/geometry/lens_residual.h"
#include "engine/methods/joint/self_product.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/smooth_path.h"
#include "engine/window/window.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo::joint {

struct Options {
  RotationModel rotations = RotationModel::known;
  bool gyro_noise = false;
  std::optional<RowDelayPrior> row_delay = std::nullopt;  ///< nullopt: global shutter
  bool huber = true;
  /// False: a restart without a part of the tracks, whose solution has no uncertainty.
  bool uncertainty = true;
  // Unknowns that are held contribute to the uncertainty only.
  bool lens_parameters = true;
  bool lens_residual = true;
  /// Components of each frame's velocity, around that of the smoothed path: 0, 3 (translation) or 6
  /// (also rotation).
  int velocity = 0;
};

inline constexpr double kGateSigmas = 5;               ///< observations beyond have no weight
inline constexpr int kLensTerms = 2 * kLensMonomials;  ///< for both coordinates

/// Order of the unknowns: those that all frames share (`UnknownsLayout`), row delay, lens
/// parameters (held: they only contribute to the uncertainty), lens residual, the frames' own ones:
/// t, or (phi, t), and their velocities: translation, rotation.
struct JointLayout {
  UnknownsLayout shared;
  int row_delay = 0;  ///< 0 or 1
  int lens_parameters = 0;
  bool typical_lens = false;  ///< the lens parameters have a typical uncertainty
  int lens = 0;               ///< coefficients of the lens residual
  int planes = 1;
  int own = 3;  ///< unknowns of a frame
  int frames = 0;
  int velocity = 0;  ///< unknown components of each frame's velocity

  int at_row_delay() const { return shared.size(); }
  int at_parameters() const { return at_row_delay() + row_delay; }
  int at_lens() const { return at_parameters() + lens_parameters; }
  int at_frame(int frame) const { return at_lens() + lens + own * (frame - 1); }
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

struct Track {
  int column = 0;                ///< in the window
  Eigen::Vector2d reference_px;  ///< observed, relative to the principal point
};

/// The observations of a plane in a frame; all of the plane's tracks are in the reference frame.
struct Group {
  int plane = 0;
  int frame = 0;
  std::vector<int> tracks;  ///< one per observation
};

/// A predicted observation and what its derivatives share.
struct Prediction {
  double seconds = 0;        ///< from the frame's time stamp
  Transfer transfer;         ///< when the frame reads the row
  Eigen::Matrix2d d_latent;  ///< by the latent position
  Eigen::Vector2d r;         ///< error [px]
};

/// One per observation of each group.
using Predictions = std::vector<std::vector<Prediction>>;

/// Normal equations with the latent positions eliminated, without priors [px^2].
struct Normals {
  Eigen::MatrixXd A;  ///< over all unknowns of `JointLayout`
  Eigen::VectorXd gradient;
  Eigen::MatrixXd by_track;        ///< each track's part of it in a column; empty without a lens
  Panels half;                     ///< E L^-T: unknowns x latent positions, V = L L^T
  std::vector<Eigen::Matrix2d> V;  ///< over the latent position of each track
  std::vector<Eigen::Vector2d> v;  ///< gradient by the same, times L^-1
  /// V with the weights of the least squares, without the reference frame.
  std::vector<Eigen::Matrix2d> latent_weights;
  std::vector<double> reference_weights;  ///< weight of each track in the reference frame
  double cost = 0;
  double curvature = 0;  ///< the loss's mean over the observations; 1 for least squares
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
  std::span<const Group> groups() const { return groups_; }
  /// Returns the noise of a track's observation in that of a typical one.
  double noise_ratio(int track, int frame) const {
    return window_.noise_ratio_of(frame, tracks_[track].column);
  }
  int observation_count() const { return observations_.count(); }
  /// Returns the same model with other unknowns.
  Model with(const Options& options) const;
  LensResidual lens_residual(const State& state) const;

  State first(const PlaneMotion& start) const;
  /// Sets the predictions of all observations.
  void predict(const State& state, Predictions& all) const;
  /// `reused`: provides the memory.
  Normals linearize(const State& state,
                    const Predictions& predictions,
                    const Scales& scales,
                    Curvature curvature,
                    Normals reused = {}) const;
  Priors priors(const State& state, const Scales& scales, Priors reused = {}) const;
  /// Moves all unknowns by `x` and the latent positions to their optimum; the velocities stay.
  State moved(const State& from, const Eigen::VectorXd& x, const Normals& at) const;
  /// Returns the noise of the poses with all unknowns of other frames fixed.
  PathNoise path_noise(const Normals& at, const Scales& scales) const;
  void update_velocities(State& state, const PathNoise& noise) const;

 private:
  /// Derivatives by the shared columns, transposed.
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 2>;

  void lay_out();
  void gather_tracks();
  Eigen::MatrixXd walk_information(const PlaneMotion& start) const;
  std::vector<int> columns_of(int plane, int frame) const;
  Eigen::Vector2d observed_px(const Group& group, int observation) const;
  void predict_group(const State& state, const Group& group, std::vector<Prediction>& all) const;
  /// Inputs of the derivatives that all observations of a group share.
  struct Shared {
    int plane = 0;
    int frame = 0;
    bool turns = true;  ///< unknowns rotate the frame
    FrameState at_stamp;
    GyroColumns gyro;
    Velocity velocity;
    std::vector<int> columns;            ///< their unknowns
    std::vector<Eigen::Index> in_panel;  ///< their first elements in `Normals::half`
  };
  Shared shared_by(const State& state, const Group& group) const;
  /// Sets the derivatives of an error over the shared columns.
  void differentiate(const Prediction& prediction,
                     const Track& track,
                     const Shared& shared,
                     Rows& J) const;
  struct Weighting {
    Scales scales;
    Curvature curvature;
  };
  /// Returns the number of observations with a weight.
  int add_group(const Shared& shared,
                const Group& group,
                std::span<const Prediction> predictions,
                const Weighting& weighting,
                Normals& all) const;
  void eliminate_latent_positions(Normals& all) const;

  const Window& window_;
  std::vector<std::vector<Eigen::Matrix2Xd>> lens_moves_px_;
  const PlaneObservations& observations_;
  Options options_;
  JointLayout layout_;
  double image_px_ = 1;  ///< from the principal point to a corner
  std::vector<Track> tracks_;
  std::vector<Group> groups_;  ///< by plane and frame
  PathTimes path_times_;
  Eigen::MatrixXd walk_;  ///< prior information of the gyroscope noise [1 / rad^2]; may be empty
};

}  // namespace gpo::joint
