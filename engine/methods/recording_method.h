// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/methods.h"

namespace gpo {

/// Rotations of the camera over a whole recording, on its clock, with which the clocks of other
/// programs' results are compared.
struct ClockReference {
  std::string source;                       ///< for people: "the ground truth"
  std::vector<std::int64_t> timestamps_ns;  ///< ascending
  std::vector<Eigen::Matrix3d> R_wc;        ///< one per time
  bool rates_are_biased = false;            ///< integrated from a gyroscope
};

/// Data of a recording that a result of another program needs.
struct RecordingFacts {
  std::string name = {};                             ///< empty: unknown
  std::optional<Pose> T_body_camera = {};            ///< body: the axes of the IMU
  std::shared_ptr<const ClockReference> clock = {};  ///< null: the window's rotations serve instead
};

/// Initializes a window of one recording and describes the result.
using BoundMethod = std::function<Initialization(
    const Window& window, const Sources& sources, ImportedResult& imported)>;

/// A `Method::initialize_from` that depends on the recording: a result of another program.
struct RecordingMethod {
  /// Throws InputError if the files for the recording are absent or cannot be read.
  std::function<BoundMethod(const RecordingFacts& recording)> bind;
  /// Describes the result over the whole recording; nullopt if it has no times or the recording no
  /// clock reference. Throws InputError like `bind`.
  std::function<std::optional<ImportedResult>(const RecordingFacts& recording)> describe;
  /// Distinguishes the files for a recording, by its name. Returns nullopt if there are none;
  /// throws InputError if they cannot be read. Null if all recordings have the same files.
  std::function<std::optional<std::string>(const std::string& recording)> identity_for = {};

  Initialization operator()(const Window& window,
                            const Sources& sources,
                            const Watch& /*watch*/) const {
    ImportedResult imported;
    return bind({.T_body_camera = sources.T_body_camera})(window, sources, imported);
  }
};

/// Returns the method's dependence on the recording; null if it has none.
inline const RecordingMethod* recording_method(const Method& method) {
  return method.initialize_from.target<RecordingMethod>();
}

}  // namespace gpo
