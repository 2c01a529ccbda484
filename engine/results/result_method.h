// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/results/result_poses.h"

namespace gpo {

/// The unit of a result: meters or arbitrary.
enum class ResultScale { metric, free };

template <>
struct ChoiceKeys<ResultScale> : NamedKeys<"scale", "metric", "free"> {};

/// The addition to the times of a result.
enum class TimeShift { none, estimated, given };

/// Another program's result as named on the command line (see README.md).
struct ProgramResult {
  std::string name;                       ///< key and title of the method
  fs::path poses;                         ///< a trajectory or a COLMAP model
  fs::path points;                        ///< in the same world; empty: none
  std::optional<PosedFrame> frame = {};   ///< nullopt: the default of the layout
  std::optional<ResultScale> scale = {};  ///< nullopt: body poses are metric, camera poses are not
  TimeShift shift = TimeShift::none;
  double shift_s = 0;  ///< if given
};

/// Parses "NAME=FILE[,POINTS][,frame=camera|body][,scale=metric|free][,offset=auto|SECONDS]".
/// Throws InputError.
ProgramResult parse_program_result(const std::string& text);

/// Receives each distinct message about a result's frames, poses and plane once.
using ResultLog = std::function<void(const std::string& name, const std::string& line)>;

/// Returns the result as a method. For each window it has the result's cameras, with missing ones
/// resected, and the plane through the result's points near the window's inlier tracks or, if these
/// are few, through points triangulated from its cameras. Windows that the result does not cover
/// fail with a reason. The time offset is estimated from the whole recording, or else from the
/// window. Reads the files; throws InputError. If the path of the poses contains `{recording}`, the
/// files are those of each recording: the method reads them at the first window of a recording and
/// throws InputError if it has none. `number` as for `own_method`.
Method result_method(const ProgramResult& result, const ResultLog& log, int number);

}  // namespace gpo
