// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/diagnosis/diagnosis.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/initialize.h"
#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/pipeline/orientations.h"
#include "engine/planes/inliers.h"
#include "engine/rotations/gyroscope_check.h"
#include "engine/rotations/rotations.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

// The stages from tracks to a verdict, in their order; each takes and returns plain values:
//
//   window_of, window_rotations, with_rotations, run_method, add_own_noise, growing_numbers,
//   finished
//
// `initialize`, and with it the live `LiveInitializer`, runs them in a row. An Inspector runs the
// same ones and caches the results of each.

/// Checks of input; each throws InputError, or SettingError for an option.
void check_options(const InitializeOptions& options);
/// `number` of the frame is for messages; `before` may be null. `time_offset_ns` of the gyroscope.
void check_frame(const Frame& frame, int number, const Frame* before, std::int64_t time_offset_ns);
/// `acceleration_m_s2` may be null.
void check_sample(std::int64_t timestamp_ns,
                  const Eigen::Vector3d& rate_rad_s,
                  const Eigen::Vector3d* acceleration_m_s2);
/// Checks order and counts of the samples; they need not cover anything yet.
void check_gyroscope(const Gyroscope& gyroscope);

/// Returns the observations of all frames, which are numbered from 0.
std::vector<TrackObservation> observations_of(std::span<const Frame> frames);

/// Returns the window of the tracks: undistorted, with inliers, homographies and planes. Rotations
/// are left at the identity. `timestamps_ns` are those of all frames of the recording,
/// `on_first_plane` as in `InlierOptions`.
Window window_of(const Tracks& tracks,
                 const Camera& camera,
                 std::span<const std::int64_t> timestamps_ns,
                 const InitializeOptions& options,
                 const std::vector<bool>& on_first_plane = {});

/// Returns why the requested plane does not lead the window: it has fewer planes. Empty if it does,
/// or without planes.
std::string missing_plane(const Window& window, const InitializeOptions& options);

/// Rotations of a window and their source.
struct ChosenRotations {
  RotationSource source = RotationSource::gyro;  ///< never automatic or raw
  Rotations rotations = {};
  std::string note = "";  ///< why the first choice of `automatic` failed; how an ambiguity ended
};

/// Inputs of the sources of rotations.
struct RotationInputs {
  const Gyroscope* gyroscope = nullptr;             ///< null if no source needs it
  std::span<const Eigen::Matrix3d> R_wc_true = {};  ///< one per frame; empty if not `truth`
  std::uint64_t seed = 1;                           ///< for relative poses
};

/// Returns the source that is tried first. `automatic`: the calibrated gyroscope, else five-point
/// rotations; `raw`: the uncalibrated gyroscope, else averaging; any other: itself.
RotationSource first_source(RotationSource requested, bool has_gyroscope);

/// Returns the window's rotations from the requested source. `automatic` falls back to the
/// uncalibrated gyroscope if images cannot calibrate it, and to averaging if five-point rotations
/// are ambiguous. Throws InputError if the gyroscope does not cover the window.
ChosenRotations chosen_rotations(const Window& window,
                                 const RotationInputs& inputs,
                                 RotationSource requested,
                                 const std::stop_token& stop);

/// Rotations of a window, and whether its gyroscope may be used for more.
struct WindowRotations {
  ChosenRotations chosen;
  std::optional<Gyroscope> corrected = std::nullopt;  ///< with the clock that fits the images
  bool gyroscope_is_usable = true;                    ///< false: not for gravity and scale either
  std::string note = "";                              ///< why one of these, for people
  std::string advice = "";                            ///< how to mend it
  GyroscopeMisfit misfit = GyroscopeMisfit::none;

  /// Returns the gyroscope to use in place of the given one, which may be null.
  const Gyroscope* usable(const Gyroscope* given) const;
};

/// Returns `chosen_rotations`. Sources `automatic` and `raw` do without a gyroscope that does not
/// cover the window. `automatic` also corrects a wrong clock, and does without a gyroscope that
/// does not fit the images. Throws InputError as `chosen_rotations` does.
WindowRotations window_rotations(const Window& window,
                                 const RotationInputs& inputs,
                                 RotationSource requested,
                                 const std::stop_token& stop);

/// Returns the window as a method gets it, with these rotations, if there are any.
Window with_rotations(Window window, const Rotations& rotations, const InitializeOptions& options);

/// Returns the method's result for the window, without assessment; a failure if there are no
/// rotations. Runs it twice if these are ambiguous (`run_from_both`). Throws InputError for an
/// unknown method.
MethodRun run_method(Window window,
                     const Rotations& rotations,
                     const Sources& sources,
                     const InitializeOptions& options,
                     const Watch& watch);

/// Adds the covariances of the method's own estimates to a result that is ok (`own_noise`).
void add_own_noise(const Window& window,
                   const Sources& sources,
                   const InitializeOptions& options,
                   const std::stop_token& stop,
                   Initialization& result);

/// Returns the numbers for the verdicts on the windows of 2, 3, ... frames, as the window grows.
std::vector<Verdict> growing_numbers(const Window& window, Lens lens, const std::stop_token& stop);

/// Estimates gravity and metric scale from a successful result and its poses. `Gravity::joint`
/// moves the result (planes, poses, bias and their covariances) to where images and accelerations
/// agree best, if it comes with a joint covariance.
InertialAlignment find_gravity(const Window& window,
                               const Sources& sources,
                               const UncertainPoses& poses,
                               const InitializeOptions& options,
                               Initialization& result);

/// Result of the last stage.
struct Finished {
  Initialization initialization;  ///< with its uncertainty and the verdict on the window
  /// Gravity and metric scale; nullopt if the initialization failed, they are not requested or
  /// there is no accelerometer.
  std::optional<InertialAlignment> inertial = std::nullopt;
  UncertainPoses poses = {};  ///< input of `inertial`
  std::vector<Finding> findings = {};
};

/// Completes a method's result: its uncertainty, gravity, and the verdict by all findings. `known`
/// is the evidence besides window and result. `growth` gives a failed result its numbers; it may be
/// empty if the result is ok.
Finished finished(const Window& window,
                  const Sources& sources,
                  const InitializeOptions& options,
                  Evidence known,
                  std::span<const Verdict> growth,
                  Initialization result);

}  // namespace gpo
