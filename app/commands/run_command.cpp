// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/commands/setting_options.h"
#include "app/recordings/recordings.h"
#include "app/terminal/output.h"
#include "engine/files/json_text.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/plane_names.h"
#include "engine/inspection/report/camera_path.h"
#include "engine/inspection/report/result_json.h"
#include "engine/inspection/report/result_text.h"
#include "engine/inspection/studies/track_life.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include <fmt/format.h>

namespace gpo {

std::shared_ptr<const Recording> open(const InspectArguments& arguments) {
  auto recording = open_given(arguments.recording,
                              {.tracks = arguments.tracks,
                               .cache_bytes = arguments.cache_mib << 20,
                               .topics = arguments.topics},
                              arguments.calibrate == "auto");
  for (const std::string& note : recording->notes) fmt::print(stderr, "{}\n", note);
  return recording;
}

std::shared_ptr<const Inspection> inspect(const InspectArguments& arguments) {
  return Inspector(open(arguments)).inspect(arguments.settings);
}

namespace {

std::vector<NamedFile> outputs_of(const RunArguments& arguments) {
  return {{"--json", arguments.json},
          {"--trajectory", arguments.trajectory},
          {"--true-trajectory", arguments.true_trajectory},
          {"--points", arguments.points},
          {"--tracks-out", arguments.tracks_out}};
}

/// The table makes room where standard output is wanted for something else.
std::FILE* table_stream(const std::vector<NamedFile>& outputs) {
  const auto taken = [](const NamedFile& file) {
    return file.path && is_standard_output(*file.path);
  };
  return std::ranges::any_of(outputs, taken) ? stderr : stdout;
}

/// Whether another window would do is one option away. A user's own method may have failed by
/// itself.
void tell_of_scan(const Inspection& inspection) {
  const Settings& settings = inspection.settings;
  if (inspection.initialization->ok || !settings.options.method.row().identity.empty()) return;
  if (inspection.recording->frame_count() > settings.frames)
    fmt::print(stderr, "--scan - lists the frames from which a window can be initialized\n");
}

}  // namespace

int run_command(const RunArguments& arguments) {
  if (arguments.scan) return scan_command(arguments.inspect, *arguments.scan, arguments.scan_step);
  const auto outputs = outputs_of(arguments);
  check_outputs(outputs,
                std::array{NamedFile{"--tracks", arguments.inspect.tracks},
                           NamedFile{"recording", arguments.inspect.recording}});
  const auto inspection = inspect(arguments.inspect);
  const bool ok = inspection->initialization->ok;
  tell_unused(arguments.inspect.given, *inspection);
  if (arguments.trajectory_format && !arguments.trajectory && !arguments.true_trajectory)
    fmt::print(stderr, "--trajectory-format is not used. No trajectory is written\n");
  fmt::print(table_stream(outputs), "{}", to_text(*inspection));
  tell_of_scan(*inspection);
  if (arguments.metric && !arguments.trajectory && !arguments.points)
    fmt::print(stderr, "--metric is not used. Neither trajectory nor points are written\n");
  if (arguments.json) write_output(*arguments.json, json_text(to_json(*inspection), 2));
  const auto write_trajectory = [&](const auto& file, const CameraPath& path) {
    write_output(file, to_text(path, arguments.trajectory_format.value_or(TrajectoryFormat::tum)));
  };
  const auto meters =
      ok && arguments.metric ? std::optional(meters_a_unit(*inspection)) : std::nullopt;
  if (ok && arguments.trajectory)
    write_trajectory(*arguments.trajectory, estimated_path(*inspection, meters));
  if (arguments.true_trajectory)
    write_trajectory(*arguments.true_trajectory, true_path(*inspection));
  if (arguments.tracks_out) write_output(*arguments.tracks_out, tracks_csv(*inspection));
  if (ok && arguments.points) write_output(*arguments.points, to_ply(*inspection, meters));
  return ok ? kDone : kFailed;
}

}  // namespace gpo
