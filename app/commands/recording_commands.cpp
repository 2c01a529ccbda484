// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The commands that read, write and make recordings: run, info, convert, synthesize.
#include "app/commands/commands.h"
#include "app/recordings/recordings.h"
#include "app/terminal/terminal.h"
#include "engine/base/error.h"
#include "engine/calibration/calibration_report.h"
#include "engine/exports/exports.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "engine/recording/board/board.h"
#include "engine/recording/layouts/write_recording.h"
#include "engine/synthesis/recipe.h"
#include "engine/synthesis/synthesize.h"
#include "ui/workbench/work/recording_writer.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace gpo {
namespace {

using OutputFile = std::optional<fs::path>;

struct InfoArguments {
  fs::path recording, json;
  bool wants_json = false;
  TopicChoices topics;
};

struct ConvertArguments {
  fs::path recording, output;
  TopicChoices topics;
  std::optional<RecordingFormat> format;  ///< default: as the output's extension tells
};

/// Refuses an existing file without .json: `--json` may have been followed by a recording.
void check_json_file(const InfoArguments& arguments) {
  const auto& file = arguments.json;
  if (fs::exists(file) && file.extension() != ".json")
    throw InputError(fmt::format(
        "--json: {} already exists and is not a .json file; choose another file", file.string()));
  check_outputs({{"--json", file}}, {{"recording", arguments.recording}});
}

/// Returns why the gyroscope disagrees with the rotations of a few windows; empty if it agrees.
std::string gyroscope_disagreement(const std::shared_ptr<const Recording>& recording,
                                   double rate_hz) {
  constexpr int kWindows = 12;
  constexpr int kMinFrames = 20;
  if (!recording->gyroscope || recording->frame_count() < kMinFrames) return "";
  if (!recording->images && recording->tracks.empty()) return "";
  const auto windows = rotations_over_recording(recording, kWindows, {}, current_stop());
  check_stop();
  return why_it_does_not_fit(
      fit_gyroscope(windows, *recording->gyroscope), *recording->gyroscope, 1 / rate_hz);
}

std::shared_ptr<const Recording> open_or_print_topics(const InfoArguments& arguments,
                                                      const std::vector<TopicInfo>& topics) {
  try {
    return open_given(arguments.recording, {.tracks = {}, .topics = arguments.topics});
  } catch (const InputError&) {
    if (!arguments.wants_json) {
      fmt::print("{}", to_text(topics));
      std::fflush(stdout);
    }
    throw;
  }
}

/// Returns the stored poses, or computes them from a board in view.
std::optional<GroundTruth> truth_of(const Recording& recording) {
  if (recording.truth || !recording.board || !recording.images) return recording.truth;
  ProgressBar bar("finding the board");
  return board_truth(recording, 0, recording.frame_count(), current_stop(), std::ref(bar));
}

int print_info(const InfoArguments& arguments) {
  const bool to_file = !arguments.json.empty() && !is_standard_output(arguments.json);
  if (to_file) check_json_file(arguments);
  const auto topics = describe_topics(arguments.recording, arguments.topics);
  const auto recording = open_or_print_topics(arguments, topics);
  const RecordingInfo info = found_in(recording);
  if (!arguments.wants_json) {
    fmt::print("{}{}", to_text(info), to_text(topics));
    return kDone;
  }
  nlohmann::json json = to_json(info);
  if (!topics.empty()) json["topics"] = to_json(topics);
  write_output(to_file ? arguments.json : "-", json_text(json, 2));
  return kDone;
}

int convert_recording(const ConvertArguments& arguments) {
  const fs::path& output = arguments.output;
  const RecordingFormat format = recording_format(output, arguments.format);
  const auto opened = open_given(
      arguments.recording, {.tracks = {}, .topics = arguments.topics}, false, kAllFrames);
  saying(output.string() + " was not written", [&] {
    const auto truth = truth_of(*opened);
    check_stop();
    ProgressBar bar("writing " + output.string());
    write_recording(*opened, truth, format, output, [&](int done, int of) {
      bar(done, of);
      check_stop();
    });
  });
  fmt::print("{}: {} frames\n", output.string(), opened->frame_count());
  return kDone;
}

int synthesize_recipe(const fs::path& recipe_file, const fs::path& output) {
  const Recipe recipe = read_recipe(recipe_file);
  saying(output.string() + " was not written", [&] {
    ProgressBar bar("synthesizing " + output.string());
    synthesize(recipe, output, [&](int done, int of) {
      bar(done, of);
      check_stop();
    });
  });
  const auto [width, height] = std::pair(recipe.camera.width, recipe.camera.height);
  fmt::print("{}: {} frames, {}x{}\n", output.string(), recipe.frame_count, width, height);
  return kDone;
}

struct RunArguments {
  InspectArguments inspect;
  OutputFile json, trajectory, true_trajectory, points, tracks_out, scan;
  std::optional<TrajectoryFormat> trajectory_format;
  std::vector<ExportRequest> exports;
  bool metric = false;
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

void write_outputs(const RunArguments& run, const Inspection& inspection) {
  const bool ok = inspection.initialization->ok;
  check_chosen(inspection);
  if (run.json) write_output(*run.json, json_text(to_json(inspection), 2));
  const auto write_path = [&](const OutputFile& file, const CameraPath& path) {
    write_output(*file, to_text(path, run.trajectory_format.value_or(TrajectoryFormat::tum)));
  };
  const ExportWorld world = ok ? export_world(inspection, run.metric) : ExportWorld{};
  if (ok && run.trajectory) write_path(run.trajectory, estimated_path(inspection, world));
  if (run.true_trajectory) write_path(run.true_trajectory, true_path(inspection));
  if (run.tracks_out) write_output(*run.tracks_out, tracks_csv(inspection));
  if (ok && run.points) write_output(*run.points, map_points_ply(inspection, world));
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
  const Settings settings =
      with_window_within(arguments.settings, arguments.given, recording->frame_count());
  const auto inspection = Inspector(recording).inspect(settings, current_stop());
  if (!inspection) throw Stopped{};
  report_unused(arguments.given, {&inspection, 1});
  if (run.trajectory_format && !run.trajectory && !run.true_trajectory)
    fmt::print(stderr, "--trajectory-format is not used. No trajectory is written\n");
  const bool needs_stdout = std::ranges::any_of(
      outputs, [](const NamedFile& file) { return file.path && is_standard_output(*file.path); });
  std::FILE* text = needs_stdout ? stderr : stdout;
  fmt::print(text, "{}", to_text(*inspection));
  suggest_scan(*inspection);
  if (run.metric && !run.trajectory && !run.points && run.exports.empty())
    fmt::print(stderr, "--metric is not used. Neither trajectory nor points are written\n");
  write_outputs(run, *inspection);
  if (inspection->initialization->ok) write_exports(run, *inspection, text);
  return inspection->initialization->ok ? kDone : kFailed;
}

}  // namespace

RecordingInfo found_in(const std::shared_ptr<const Recording>& recording) {
  RecordingInfo info = describe(*recording);
  if (const auto why = gyroscope_disagreement(recording, info.rate_hz); !why.empty())
    info.notes.push_back(why);
  return info;
}

RecordingFormat recording_format(const fs::path& output,
                                 const std::optional<RecordingFormat>& wanted) {
  const RecordingFormat named = recording_format_of(output);
  const RecordingFormat format = wanted.value_or(named);
  if (format == RecordingFormat::euroc && named != format)
    throw InputError(fmt::format("--format euroc writes a folder, but {} names a {} file",
                                 output.string(),
                                 to_string(named)));
  return format;
}

RunCommand add_info(CLI::App& app) {
  const auto to = std::make_shared<InfoArguments>();
  CLI::App& command = *app.add_subcommand("info", "Describes a recording");
  command.add_option("recording", to->recording, kRecordingHelp);
  command
      .add_option(
          "--json", to->json, "Write JSON to a file; without one or with -: to standard output")
      ->expected(0, 1);
  add_topics(command, to->topics);
  command.callback([&command, to] {
    to->wants_json = command.count("--json") > 0;
    // In `info --json RECORDING` the recording is parsed as the file.
    if (to->recording.empty()) std::swap(to->recording, to->json);
    if (to->recording.empty()) throw CLI::RequiredError("recording");
  });
  return [to](OwnMethods& /*own*/, Interrupt& /*interrupt*/) { return print_info(*to); };
}

RunCommand add_convert(CLI::App& app) {
  const auto to = std::make_shared<ConvertArguments>();
  CLI::App& command =
      *app.add_subcommand("convert", "Writes any recording as an EuRoC folder or as a ROS bag");
  command.add_option("recording", to->recording, kRecordingHelp)->required();
  add_topics(command, to->topics);
  add_choice<RecordingFormat>(
      command,
      "--format",
      "Format to write; default: as the extension of the output, else euroc",
      to->format);
  command.add_option("--output", to->output, "Folder or bag (.bag or .mcap) to write")->required();
  return [to](OwnMethods& /*own*/, Interrupt& /*interrupt*/) { return convert_recording(*to); };
}

RunCommand add_synthesize(CLI::App& app) {
  const auto recipe = std::make_shared<fs::path>(), output = std::make_shared<fs::path>();
  CLI::App& command = *app.add_subcommand(
      "synthesize", "Renders a recording with perfect ground truth from a recipe");
  command.add_option("recipe", *recipe, "Recipe, a YAML file")->required();
  command.add_option("--output", *output, "Folder to write (EuRoC layout)")->required();
  return [recipe, output](OwnMethods& /*own*/, Interrupt& /*interrupt*/) {
    return synthesize_recipe(*recipe, *output);
  };
}

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
  CLI::Option* scan = command.add_option(
      "--scan", run->scan, "Initialize from many starts instead and write one CSV line per start");
  for (const char* other :
       {"--json", "--trajectory", "--true-trajectory", "--points", "--tracks-out", "--export"})
    scan->excludes(command.get_option(other));
  command.add_option("--scan-step", run->scan_step, "Frames between starts")
      ->check(CLI::PositiveNumber)
      ->needs(scan);
  return [run](OwnMethods& own, Interrupt& /*interrupt*/) {
    find_method(run->inspect, own.table);
    return run->scan ? run_scan(*run) : run_once(*run);
  };
}

}  // namespace gpo
