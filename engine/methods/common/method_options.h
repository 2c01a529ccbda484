// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

namespace gpo {

/// Who minimizes the transfer error: our own Schur solver, started from the closed form, or Ceres
/// as the paper uses it (dogleg from tau = 0, n along z). Both end in the same minimum.
enum class Solver { schur, ceres };

template <>
struct ChoiceKeys<Solver> {
  static constexpr const char* name = "solver";
  static constexpr std::array keys{"schur", "ceres"};
};

/// The error of an observation: in the later picture only (the paper), or Sampson's, which shares
/// the noise between both pictures.
enum class ErrorModel { transfer, sampson };

template <>
struct ChoiceKeys<ErrorModel> {
  static constexpr const char* name = "error";
  static constexpr std::array keys{"transfer", "sampson"};
};

enum class Loss { squared, huber };

template <>
struct ChoiceKeys<Loss> {
  static constexpr const char* name = "loss";
  static constexpr std::array keys{"squared", "huber"};
};

/// Whether the rows of a picture were read one after another, as phones do, at a pace that is
/// estimated; or all at once.
enum class Shutter { estimated, global };

template <>
struct ChoiceKeys<Shutter> {
  static constexpr const char* name = "shutter";
  static constexpr std::array keys{"estimated", "global"};
};

/// Of the window's planes, the leading one alone, or all of them at once.
enum class Planes { all, one };

template <>
struct ChoiceKeys<Planes> {
  static constexpr const char* name = "planes";
  static constexpr std::array keys{"all", "one"};
};

/// What a user may choose of the optimizations; all but `solver` are gpo_joint's.
struct MethodOptions {
  Solver solver = Solver::schur;
  ErrorModel error = ErrorModel::transfer;
  Loss loss = Loss::huber;
  Shutter shutter = Shutter::estimated;
  Planes planes = Planes::all;
  bool time_offset = false;  ///< estimate the offset between the clocks of camera and gyroscope

  bool operator==(const MethodOptions&) const = default;
};

}  // namespace gpo
