// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.h"
#include "app/recordings.h"
#include "app/setting_options.h"
#include "engine/files/json_text.h"
#include "engine/files/output_file.h"
#include "engine/inspection/camera_path.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/report.h"

#include <fmt/format.h>

namespace gpo {

std::shared_ptr<const Recording> open(const InspectArguments& arguments) {
  auto recording = open_given(
      arguments.recording, {.tracks = arguments.tracks, .cache_bytes = arguments.cache_mib << 20});
  for (const std::string& note : recording->notes) fmt::print(stderr, "{}\n", note);
  return recording;
}

std::shared_ptr<const Inspection> inspect(const InspectArguments& arguments) {
  return Inspector(open(arguments)).inspect(arguments.settings);
}

int run_command(const RunArguments& arguments) {
  for (const auto& file :
       {arguments.json, arguments.trajectory, arguments.true_trajectory, arguments.points}) {
    if (file) check_writable(*file);
  }
  const auto inspection = inspect(arguments.inspect);
  const bool ok = inspection->initialization->ok;
  tell_unused(arguments.inspect.given, *inspection);
  if (arguments.trajectory_format && !arguments.trajectory && !arguments.true_trajectory)
    fmt::print(stderr, "--trajectory-format is not used. No trajectory is written\n");
  fmt::print("{}", to_text(*inspection));
  if (arguments.json) write_file(*arguments.json, json_text(to_json(*inspection), 2));
  const auto write_trajectory = [&](const auto& file, const CameraPath& path) {
    write_file(file, to_text(path, arguments.trajectory_format.value_or(TrajectoryFormat::tum)));
  };
  if (ok && arguments.trajectory)
    write_trajectory(*arguments.trajectory, estimated_path(*inspection));
  if (arguments.true_trajectory)
    write_trajectory(*arguments.true_trajectory, true_path(*inspection));
  if (ok && arguments.points) write_file(*arguments.points, to_ply(*inspection));
  return ok ? kDone : kFailed;
}

}  // namespace gpo
