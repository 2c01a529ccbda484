// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/paths.h"
#include "engine/methods/methods.h"

#include <atomic>
#include <chrono>

#include <nlohmann/json_fwd.hpp>

namespace gpo {

/// The name of a user's method with its command or files.
struct NamedText {
  std::string name;  ///< key and title
  std::string text;
};

/// Parses "NAME=TEXT". Throws InputError that names the option and the expected syntax.
NamedText parse_named(const std::string& text, const char* option, const char* expected);

/// Returns a row of the method table for a user's method. `number`, its position among these,
/// determines the color.
Method own_method(const std::string& name,
                  int number,
                  decltype(Method::initialize_from) initialize_from,
                  std::string identity);

/// Returns the CRC-32 of a file, 8 digits; empty if it is no file.
std::string checksum_of(const fs::path& file);

/// The user's own methods as written in options and sessions.
struct MethodSpecs {
  std::vector<std::string> commands;  ///< "NAME=COMMAND"
  std::vector<std::string> results;   ///< "NAME=FILE[,POINTS][,frame=camera|body]"
};

/// Returns the user's methods of a table, for a session.
MethodSpecs specs_in(const MethodTable& methods);

/// Returns a result's text with absolute paths.
std::string with_whole_paths(const std::string& result);

/// `method_commands` and `results` of a session (JSON); empty for other files. Throws InputError.
MethodSpecs methods_in_session(const fs::path& file);

/// Parses "NAME=COMMAND". Throws InputError.
NamedText parse_method_command(const std::string& text);

struct CommandOptions {
  std::chrono::milliseconds time_limit{30'000};  ///< per window, including the start of the process
  bool resampled = false;  ///< `Method::resampled`: nine more windows for its own uncertainty
  /// Called for each line on a command's standard error, up to a limit per window, on the calling
  /// thread of the method.
  std::function<void(const std::string& name, const std::string& line)> on_line = {};
  /// While false, no process is started; null: the user gave the command.
  std::shared_ptr<const std::atomic<bool>> allowed = {};
};

/// Returns a user's own method: a shell command that reads each window as a line and answers with a
/// line (see README.md). It starts one process per calling thread and keeps the processes until its
/// last copy is destroyed. Errors of a command are failures of that window with a reason in one
/// line. `number` as for `own_method`.
Method command_method(const NamedText& command, const CommandOptions& options, int number);

/// Returns the input of a user's own method, as in `method_window.schema.json` but without `id`.
/// Unknown values are missing; unseen pixels are null.
nlohmann::ordered_json window_json(const Window& window, const Sources& sources);

/// The result of a user's own method for a window, in any world and scale.
struct Answer {
  std::optional<std::string> failed;         ///< the reason; all other members are then empty
  std::vector<std::optional<Pose>> cameras;  ///< one per frame; never nullopt for the first
  std::optional<Plane> plane;                ///< unit normal
  std::vector<PlaneEstimate> planes;         ///< each of the window's planes at most once
  std::vector<MapPoint> points;              ///< each track at most once
  std::optional<double> milliseconds;        ///< running time as reported by the method
};

struct ExpectedAnswer {
  int id = 0;  ///< id of the question; an answer may repeat it
  int frames = 0;
  int tracks = 0;
  int planes = 0;
};

/// Parses an answer, one line (`method_answer.schema.json`). Throws InputError that names the key:
/// "cameras[3].R_wc: expected 9 numbers".
Answer read_answer(std::string_view line, const ExpectedAnswer& expected);

/// Converts an answer into a result in the axes of the reference camera with the leading plane at
/// distance 1. Missing points are those on the plane or, without a plane, triangulated; a missing
/// plane is fitted to the inlier points; a missing camera is resected from the points. Fails with a
/// reason if that is impossible or if the result does not fit the window's tracks.
Initialization initialization_of(const Window& window, const Answer& answer);

/// Returns the camera of a frame from the points that it sees; nullopt if these are too few.
std::optional<Pose> resected(const Window& window, const std::vector<MapPoint>& points, int frame);

}  // namespace gpo
