// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/window/gyroscope.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

namespace gpo {

/// Minimizer of the transfer error: our own Schur solver, started from the closed form, or Ceres as
/// in the paper (dogleg from tau = 0, n along z). Both end in the same minimum.
enum class Solver { schur, ceres };

template <>
struct ChoiceKeys<Solver> : NamedKeys<"solver", "schur", "ceres"> {};

/// Noise of an observation. transfer: in the later image only (the paper); sampson: in both, by
/// Sampson's error; latent: in all images, and the track's position in the reference frame is
/// unknown. automatic: transfer if positions in the reference frame are exact, else latent.
enum class ErrorModel { automatic, transfer, sampson, latent };

template <>
struct ChoiceKeys<ErrorModel> : NamedKeys<"error", "automatic", "transfer", "sampson", "latent"> {};

enum class Loss { squared, huber };

template <>
struct ChoiceKeys<Loss> : NamedKeys<"loss", "squared", "huber"> {};

/// Rolling shutter with the window's row delay if it has one (`Window::row_delay`), otherwise
/// estimated; rolling shutter with an estimated row delay in any case; or global shutter.
enum class Shutter { known, estimated, global };

template <>
struct ChoiceKeys<Shutter> : NamedKeys<"shutter", "known", "estimated", "global"> {};

/// All planes of the window, or only the main plane.
enum class Planes { all, one };

template <>
struct ChoiceKeys<Planes> : NamedKeys<"planes", "all", "one"> {};

/// Normal of a bundle adjustment over a plane: estimated or fixed.
enum class PlaneNormal { free, held };

/// Options of the optimizations; all but `solver` apply to gpo_joint only.
struct MethodOptions {
  Solver solver = Solver::schur;
  ErrorModel error = ErrorModel::automatic;
  Loss loss = Loss::huber;
  Shutter shutter = Shutter::known;
  Planes planes = Planes::all;
  bool time_offset = true;  ///< estimate the offset between the clocks of camera and gyroscope

  bool operator==(const MethodOptions&) const = default;
};

/// The data that a window was made from. Only a user's own methods read it. Null or empty if
/// unavailable.
struct Sources {
  const Camera* camera = nullptr;          ///< model of the raw images
  const Gyroscope* gyroscope = nullptr;    ///< samples of the whole recording
  std::optional<Pose> T_body_camera = {};  ///< body: the axes of the IMU
  /// A video of the whole recording, or one image per frame of the window.
  std::vector<std::filesystem::path> images = {};
};

/// Cancels an optimization and observes its progress.
struct Watch {
  std::stop_token stop;
  /// Called after each iteration on the same thread, with half the summed squares [px^2].
  std::function<void(int iteration, double cost)> on_iteration;

  Watch() = default;
  Watch(std::stop_token stop_by, std::function<void(int, double)> callback = {})
      : stop(std::move(stop_by)), on_iteration(std::move(callback)) {}

  bool stop_requested() const { return stop.stop_requested(); }
  void report(int iteration, double cost) const {
    if (on_iteration) on_iteration(iteration, cost);
  }
};

}  // namespace gpo
