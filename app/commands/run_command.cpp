// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The command that initializes once, or from many starts.
#include "app/commands/commands.h"
#include "engine/base/error.h"
#include "engine/exports/exports.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "engine/inspection/studies/studies.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace gpo {
namespace {

using OutputFile = std::optional<fs::path>;

struct RunArguments {
  InspectArguments inspect;
  OutputFile json, trajectory, true_trajectory, points, tracks_out, scan;
  std::optional<TrajectoryFormat> trajectory_format;
  std::vector<ExportRequest> exports;
  bool metric = false;
  int extrapolate = 0;  ///< frames after the window
  bool extrapolated_trajectory = false;
  std::optional<int> scan_step;  ///< default: about 100 starts
};

std::vector<ScannedStart> scan(const std::shared_ptr<const Recording>& recording,
                               const Settings& settings,
                               std::span<const int> starts) {
  std::vector<ScannedStart> scanned;
  ProgressBar bar("scanning");
  const int of = static_cast<int>(starts.size());
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const auto take = [&](ScannedStart start) {
    scanned.push_back(std::move(start));
    bar(static_cast<int>(scanned.size()), of);
  };
  scan_starts(recording, settings, {starts, cores, current_stop()}, take);
  check_stop();
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
  if (best == nullptr)
    return text + "no start succeeds; the first one fails: " + starts.front().reason + "\n";
  return text + "best start: " + to_text(*best) + "\n";
}

int run_scan(const RunArguments& run) {
  const InspectArguments& arguments = run.inspect;
  check_outputs({{"--scan", run.scan}},
                {{"--tracks", arguments.tracks}, {"recording", arguments.recording}});
  if (std::ranges::find(arguments.given, "start") != arguments.given.end())
    fmt::print(stderr, "--start is not used. A scan covers the whole recording\n");
  const auto recording = open(arguments);
  check_not_overwritten(*recording, {{"--scan", run.scan}});
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

/// Refuses folders that exist, before any work; `run` checks files together.
void check_export_folders(const RunArguments& run) {
  for (const ExportRequest& request : run.exports)
    if (request.format->is_folder()) check_export(request);
}

/// Prints the remarks on each export.
void write_exports(const RunArguments& run, const Inspection& inspection, std::FILE* text) {
  for (const ExportRequest& request : run.exports) {
    make_folder(fs::absolute(request.path).parent_path());
    for (const std::string& note : write_export(inspection, {.metric = run.metric}, request))
      fmt::print(text, "{:<12}{}: {}\n", request.format->key, request.path.string(), note);
  }
}

/// Returns the cameras after the window; null if none are requested or the window failed.
std::shared_ptr<const Extrapolation> cameras_after(
    const RunArguments& run, const std::shared_ptr<const Inspection>& inspection) {
  if (run.extrapolate == 0 || !inspection->initialization->ok) return nullptr;
  auto after = extrapolate(inspection, run.extrapolate, current_stop());
  return after ? after : throw Stopped{};
}

void write_outputs(const RunArguments& run,
                   const Inspection& inspection,
                   const Extrapolation* after) {
  const bool ok = inspection.initialization->ok;
  check_chosen(inspection);
  if (run.json) {
    auto json = to_json(inspection);
    if (after != nullptr) json["extrapolated"] = to_json(*after);
    write_output(*run.json, json_text(json, 2));
  }
  const auto write_path = [&](const OutputFile& file, const CameraPath& path) {
    write_output(*file, to_text(path, run.trajectory_format.value_or(TrajectoryFormat::tum)));
  };
  const ExportWorld world = ok ? export_world(inspection, run.metric) : ExportWorld{};
  const bool longer = run.extrapolated_trajectory && after != nullptr && after->extended;
  const Inspection& of_trajectory = longer ? *after->extended : inspection;
  if (ok && run.trajectory) write_path(run.trajectory, estimated_path(of_trajectory, world));
  if (run.true_trajectory) write_path(run.true_trajectory, true_path(inspection));
  if (run.tracks_out) write_output(*run.tracks_out, tracks_csv(inspection));
  if (ok && run.points) write_output(*run.points, map_points_ply(inspection, world));
}

/// Names the requested files that a failure leaves out.
void report_unwritten(const RunArguments& run) {
  std::vector<std::string> unwritten;
  if (run.trajectory) unwritten.emplace_back("--trajectory");
  if (run.points) unwritten.emplace_back("--points");
  for (const ExportRequest& request : run.exports)
    unwritten.push_back(fmt::format("--export {}", request.format->key));
  if (!unwritten.empty())
    fmt::print(
        stderr, "not written, because the initialization failed: {}\n", fmt::join(unwritten, ", "));
}

int run_once(const RunArguments& run) {
  const InspectArguments& arguments = run.inspect;
  std::vector<NamedFile> outputs{{"--json", run.json},
                                 {"--trajectory", run.trajectory},
                                 {"--true-trajectory", run.true_trajectory},
                                 {"--points", run.points},
                                 {"--tracks-out", run.tracks_out}};
  for (const ExportRequest& request : run.exports)
    if (!request.format->is_folder()) outputs.push_back({"--export", request.path});
  check_export_folders(run);
  check_outputs(outputs, {{"--tracks", arguments.tracks}, {"recording", arguments.recording}});
  const auto recording = open(arguments);
  check_not_overwritten(*recording, outputs);
  const Settings settings =
      with_window_within(arguments.settings, arguments.given, recording->frame_count());
  const auto inspection = Inspector(recording).inspect(settings, current_stop());
  if (!inspection) throw Stopped{};
  report_unused(arguments.given, {&inspection, 1});
  if (run.extrapolated_trajectory && !run.trajectory)
    fmt::print(stderr, "--extrapolated-trajectory is not used. No trajectory is written\n");
  if (run.trajectory_format && !run.trajectory && !run.true_trajectory)
    fmt::print(stderr, "--trajectory-format is not used. No trajectory is written\n");
  const bool needs_stdout = std::ranges::any_of(
      outputs, [](const NamedFile& file) { return file.path && is_standard_output(*file.path); });
  std::FILE* text = needs_stdout ? stderr : stdout;
  fmt::print(text, "{}", to_text(*inspection));
  suggest_scan(*inspection);
  if (run.metric && !run.trajectory && !run.points && run.exports.empty())
    fmt::print(stderr, "--metric is not used. Neither trajectory nor points are written\n");
  const auto after = cameras_after(run, inspection);
  if (after)
    fmt::print(text,
               "after       {}{}\n",
               counted(after->cameras.size(), "camera") + " by PnP on the planes",
               after->end.empty() ? "" : ", then " + after->end);
  write_outputs(run, *inspection, after.get());
  if (!inspection->initialization->ok) {
    report_unwritten(run);
    return kFailed;
  }
  write_exports(run, *inspection, text);
  return kDone;
}

}  // namespace

void add_exports(CLI::App& command, std::vector<ExportRequest>& exports) {
  std::vector<std::string> keys;
  for (const ExportFormat& format : export_formats()) keys.emplace_back(format.key);
  command
      .add_option_function<std::vector<std::string>>(
          "--export",
          [&exports](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) exports.push_back(parse_export(text));
          },
          fmt::format("Write the result for another program, FORMAT=PATH, repeatable: {}",
                      fmt::join(keys, ", ")))
      ->type_name("FORMAT=PATH")
      ->allow_extra_args(false);  // the next word may be the recording
}

RunCommand add_run(CLI::App& app) {
  const auto run = std::make_shared<RunArguments>();
  CLI::App& command = *app.add_subcommand("run", "Initializes once and prints a short table");
  add_tracks_and_recording(command, run->inspect)->required();
  command.add_option("--json", run->json, "Write the whole result; -: to standard output");
  command.add_option("--trajectory", run->trajectory, "Write the camera poses");
  command.add_option(
      "--true-trajectory", run->true_trajectory, "Write the true camera poses of the window");
  add_choice<TrajectoryFormat>(command,
                               "--trajectory-format",
                               "Format of both trajectories; default: tum",
                               run->trajectory_format);
  command.add_option("--points", run->points, "Write the map points as PLY");
  add_exports(command, run->exports);
  command.add_flag(
      "--metric",
      run->metric,
      "Scale trajectory and points to meters by the accelerometer; default unit: plane distance, "
      "with --scale-points meter");
  command.add_option("--tracks-out",
                     run->tracks_out,
                     "Write each track's pixels, plane, verdict, residual and reason per frame as "
                     "CSV, which --tracks can read");
  CLI::Option* after =
      command
          .add_option("--extrapolate",
                      run->extrapolate,
                      "Locate the cameras of the next N frames after the window by "
                      "PnP on its planes, for --json; marked as extrapolated")
          ->type_name("N")
          ->check(CLI::Range(0, 1'000'000));
  command
      .add_flag("--extrapolated-trajectory",
                run->extrapolated_trajectory,
                "Write these cameras to --trajectory, too")
      ->needs(after);
  CLI::Option* scan = command.add_option(
      "--scan", run->scan, "Initialize from many starts instead and write one CSV line per start");
  for (const char* other : {"--json",
                            "--trajectory",
                            "--true-trajectory",
                            "--points",
                            "--tracks-out",
                            "--export",
                            "--extrapolate"})
    scan->excludes(command.get_option(other));
  command.add_option("--scan-step", run->scan_step, "Frames between starts")
      ->check(CLI::Range(1, 1'000'000))
      ->needs(scan);
  return [run](OwnMethods& own, Interrupt& /*interrupt*/) {
    find_method(run->inspect, own.table);
    return run->scan ? run_scan(*run) : run_once(*run);
  };
}

}  // namespace gpo
