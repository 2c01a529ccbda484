// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/commands/setting_options.h"
#include "app/recordings/recordings.h"
#include "app/terminal/output.h"
#include "app/terminal/progress.h"
#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/report/result.h"
#include "engine/inspection/studies/planes.h"
#include "engine/inspection/studies/scan.h"
#include "engine/inspection/studies/track_life.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <thread>

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

namespace {

std::vector<ScannedStart> scan(const std::shared_ptr<const Recording>& recording,
                               const Settings& settings,
                               std::span<const int> starts) {
  std::vector<ScannedStart> scanned;
  ProgressBar bar("scanning");
  const int of = static_cast<int>(starts.size());
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  scan_starts(recording, settings, {starts, cores}, [&](ScannedStart start) {
    scanned.push_back(std::move(start));
    bar(static_cast<int>(scanned.size()), of);
  });
  std::ranges::sort(scanned, {}, &ScannedStart::start);
  return scanned;
}

std::string summary(std::span<const ScannedStart> starts, int frames, int step) {
  const auto count = [&](Readiness readiness) {
    return std::ranges::count_if(
        starts, [&](const auto& start) { return start.ok && start.readiness == readiness; });
  };
  std::string text = fmt::format(
      "{}, {} apart, windows of {} frames: {} ready, {} weak, {} degenerate, {} failed\n",
      counted(starts.size(), "start"),
      counted(step, "frame"),
      frames,
      count(Readiness::ready),
      count(Readiness::weak),
      count(Readiness::degenerate),
      std::ranges::count(starts, false, &ScannedStart::ok));
  const ScannedStart* best = best_start(starts);
  if (best == nullptr) return text + "none succeeds; the first: " + starts.front().reason + "\n";
  return text + "best start: " + to_text(*best) + "\n";
}

/// Initializes from starts all over the recording and writes the results.
int run_scan(const RunArguments& run) {
  const InspectArguments& arguments = run.inspect;
  check_outputs(std::array{NamedFile{"--scan", run.scan}},
                std::array{NamedFile{"--tracks", arguments.tracks},
                           NamedFile{"recording", arguments.recording}});
  if (std::ranges::find(arguments.given, "start") != arguments.given.end())
    fmt::print(stderr, "--start is not used. A scan covers the whole recording\n");
  const auto recording = open(arguments);
  const int frames = arguments.settings.frames;
  const int step = run.scan_step.value_or(scan_step(recording->frame_count(), frames));
  const auto starts = starts_to_scan(recording->frame_count(), frames, step);
  if (starts.empty())
    throw InputError(fmt::format(
        "--frames: {}, but {} has {} frames", frames, recording->name, recording->frame_count()));
  const auto scanned = scan(recording, arguments.settings, starts);
  fmt::print(is_standard_output(*run.scan) ? stderr : stdout, "{}", summary(scanned, frames, step));
  write_output(*run.scan, to_csv(scanned, *recording));
  return best_start(scanned) != nullptr ? kDone : kFailed;
}

/// Another window may succeed, unless the failed method is the user's own.
void suggest_scan(const Inspection& inspection) {
  const Settings& settings = inspection.settings;
  if (inspection.initialization->ok || !settings.options.method.row().identity.empty()) return;
  if (inspection.recording->frame_count() > settings.frames)
    fmt::print(stderr, "--scan - lists the frames from which a window can be initialized\n");
}

}  // namespace

int run_command(const RunArguments& arguments) {
  if (arguments.scan) return run_scan(arguments);
  const std::array outputs{NamedFile{"--json", arguments.json},
                           NamedFile{"--trajectory", arguments.trajectory},
                           NamedFile{"--true-trajectory", arguments.true_trajectory},
                           NamedFile{"--points", arguments.points},
                           NamedFile{"--tracks-out", arguments.tracks_out}};
  check_outputs(outputs,
                std::array{NamedFile{"--tracks", arguments.inspect.tracks},
                           NamedFile{"recording", arguments.inspect.recording}});
  const auto inspection = Inspector(open(arguments.inspect)).inspect(arguments.inspect.settings);
  const bool ok = inspection->initialization->ok;
  report_unused(arguments.inspect.given, *inspection);
  if (arguments.trajectory_format && !arguments.trajectory && !arguments.true_trajectory)
    fmt::print(stderr, "--trajectory-format is not used. No trajectory is written\n");
  const bool needs_stdout = std::ranges::any_of(
      outputs, [](const NamedFile& file) { return file.path && is_standard_output(*file.path); });
  fmt::print(needs_stdout ? stderr : stdout, "{}", to_text(*inspection));
  suggest_scan(*inspection);
  if (arguments.metric && !arguments.trajectory && !arguments.points)
    fmt::print(stderr, "--metric is not used. Neither trajectory nor points are written\n");
  if (arguments.json) write_output(*arguments.json, json_text(to_json(*inspection), 2));
  const auto write_trajectory = [&](const auto& file, const CameraPath& path) {
    write_output(file, to_text(path, arguments.trajectory_format.value_or(TrajectoryFormat::tum)));
  };
  const auto meters =
      ok && arguments.metric ? std::optional(meters_per_unit(*inspection)) : std::nullopt;
  if (ok && arguments.trajectory)
    write_trajectory(*arguments.trajectory, estimated_path(*inspection, meters));
  if (arguments.true_trajectory)
    write_trajectory(*arguments.true_trajectory, true_path(*inspection));
  if (arguments.tracks_out) write_output(*arguments.tracks_out, tracks_csv(*inspection));
  if (ok && arguments.points) write_output(*arguments.points, to_ply(*inspection, meters));
  return ok ? kDone : kFailed;
}

}  // namespace gpo
