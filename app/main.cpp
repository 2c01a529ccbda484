// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/commands/setting_options.h"
#include "app/commands/snapshots.h"
#include "app/methods/method_commands.h"
#include "app/pages.h"
#include "app/terminal/output.h"
#include "app/terminal/progress.h"
#include "engine/base/error.h"
#include "engine/experiment/experiment.h"
#include "engine/inspection/settings/settings_table.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <functional>
#include <system_error>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

template <Choice E>
void add_choice(CLI::App& command, const std::string& name, const std::string& help, auto& value) {
  command.add_option_function<std::string>(
      name,
      [&value](const std::string& key) { value = choice<E>(key); },
      help + fmt::format(": {}", fmt::join(ChoiceKeys<E>::keys, ", ")));
}

void add_cache(CLI::App& command, std::size_t& mib) {
  command.add_option("--cache", mib, "Limit for decoded images that are cached in memory [MiB]")
      ->capture_default_str()
      ->check(CLI::Range(16, 1'000'000));
}

void add_topics(CLI::App& command, TopicChoices& topics) {
  command
      .add_option_function<std::vector<std::string>>(
          "--topic",
          [&topics](const std::vector<std::string>& texts) { topics = parse_topic_choices(texts); },
          fmt::format(
              "Topic of a bag that has several: ROLE=NAME, e.g. image=/cam0/image_raw; roles: {}",
              fmt::join(ChoiceKeys<TopicRole>::keys, ", ")))
      ->allow_extra_args(false);
}

constexpr const char* kRecordingHelp = "Folder or file of a recording, or a recipe";

CLI::Option* add_recording(CLI::App& command, InspectArguments& arguments) {
  auto* recording = command.add_option("recording", arguments.recording, kRecordingHelp);
  add_topics(command, arguments.topics);
  add_cache(command, arguments.cache_mib);
  command
      .add_option("--calibrate",
                  arguments.calibrate,
                  "auto: calibrates an uncalibrated camera from a plane in view, once")
      ->capture_default_str()
      ->check(CLI::IsMember({"off", "auto"}));
  add_settings(command, arguments.settings, arguments.given);
  return recording;
}

void add_view(CLI::App& app, ViewArguments& arguments) {
  CLI::App* command = app.add_subcommand("view", "Opens the window (the default)");
  add_recording(*command, arguments.inspect);
  command->add_option("--session", arguments.session, "Session to continue, a JSON file");
  command->add_option("--script", arguments.script, "File of commands to start with, one per line");
}

CLI::Option* add_tracks_and_recording(CLI::App& command, InspectArguments& arguments) {
  command.add_option(
      "--tracks", arguments.tracks, "Tracks (frame,track,x,y) instead of the built-in tracker");
  return add_recording(command, arguments);
}

void add_info(CLI::App& app, InfoArguments& arguments) {
  CLI::App* command = app.add_subcommand("info", "Describes a recording");
  command->add_option("recording", arguments.recording, kRecordingHelp);
  command
      ->add_option("--json", arguments.json, "Write JSON to a file; none or -: to standard output")
      ->expected(0, 1);
  add_topics(*command, arguments.topics);
  command->callback([command, &arguments] {
    arguments.wants_json = command->count("--json") > 0;
    // In `info --json RECORDING` the recording is parsed as the file.
    if (arguments.recording.empty()) std::swap(arguments.recording, arguments.json);
    if (arguments.recording.empty()) throw CLI::RequiredError("recording");
  });
}

void add_run(CLI::App& app, RunArguments& arguments) {
  CLI::App* command = app.add_subcommand("run", "Initializes once and prints a short table");
  add_tracks_and_recording(*command, arguments.inspect)->required();
  command->add_option("--json", arguments.json, "Write the whole result; -: to standard output");
  command->add_option("--trajectory", arguments.trajectory, "Write the camera poses");
  command->add_option(
      "--true-trajectory", arguments.true_trajectory, "Write the true camera poses of the window");
  add_choice<TrajectoryFormat>(*command,
                               "--trajectory-format",
                               "Format of both trajectories; default: tum",
                               arguments.trajectory_format);
  command->add_option("--points", arguments.points, "Write the map points as PLY");
  command->add_flag(
      "--metric",
      arguments.metric,
      "Scale trajectory and points to meters by the accelerometer; default unit: plane distance");
  command->add_option("--tracks-out",
                      arguments.tracks_out,
                      "Write each track's pixels, plane, verdict, residual and reason per frame as "
                      "CSV, which --tracks can read");
  CLI::Option* scan = command->add_option(
      "--scan", arguments.scan, "Initialize from many starts instead and write one line per start");
  for (const char* other :
       {"--json", "--trajectory", "--true-trajectory", "--points", "--tracks-out"})
    scan->excludes(command->get_option(other));
  command->add_option("--scan-step", arguments.scan_step, "Frames between starts")
      ->check(CLI::PositiveNumber)
      ->needs(scan);
}

void add_snapshot(CLI::App& app, SnapshotArguments& arguments) {
  CLI::App* command =
      app.add_subcommand("snapshot", "Draws one view or runs a script, without a display");
  add_tracks_and_recording(*command, arguments.inspect);
  CLI::Option* script = command->add_option(
      "--script", arguments.script, "File of window commands, one per line, instead of one view");
  command->add_option("--view", arguments.view, "View to draw")
      ->check(CLI::IsMember(view_names()))
      ->excludes(script);
  command->add_option("--output", arguments.output, "PNG file to write")->excludes(script);
  command->add_option(
      "--frame", arguments.frame, "Frame of the recording to draw; default: the window's last");
  command->add_option(
      "--methods",
      arguments.methods,
      "Methods of the views compare and curves, with commas, each with settings that differ, " +
          configuration_syntax() + "; default: every method");
  command->add_option("--lengths",
                      arguments.lengths,
                      "Window lengths of the view curves [frames], FROM:TO:STEP; default: "
                      "5:FRAMES:5");
  command->add_option("--size", arguments.size, "WxH [px]; default: depends on the view");
  command->add_option("--baseline",
                      arguments.baseline,
                      "Image to compare with; if it differs, exit code 1 and OUTPUT.diff.png");
  command
      ->add_option("--tolerance",
                   arguments.tolerance,
                   "Largest difference of a color channel (0 to 255) that counts as equal")
      ->capture_default_str()
      ->check(CLI::Range(0, 255));
}

void add_experiment(CLI::App& command, EvaluateArguments& arguments) {
  command
      .add_option("--methods",
                  arguments.methods,
                  "Methods with commas, each with settings that differ from its defaults: " +
                      configuration_syntax() + "; all: every method and the paper's ablations")
      ->capture_default_str();
  command.add_option("--lengths", arguments.lengths, "Window lengths [frames], FROM:TO:STEP")
      ->capture_default_str();
  command
      .add_option("--starts",
                  arguments.starts,
                  "First frames of the windows; end: the last one that fits the longest window")
      ->capture_default_str();
  command.add_option("--seed", arguments.seed, "Seed of the random number generators")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1'000'000'000}));
}

void add_evaluate(CLI::App& app, EvaluateArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "evaluate",
      "Compares methods on many windows: results.csv, summary.json, figures and running times. "
      "After an interruption (exit code 1), the same command continues");
  command->add_option(
      "recording", arguments.recordings, "Folders or files of recordings, or recipes");
  add_topics(*command, arguments.topics);
  add_experiment(*command, arguments);
  arguments.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command->add_option("--jobs", arguments.jobs, "Number of starts that are computed at once")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  command
      ->add_option("--timing-jobs",
                   arguments.timing_jobs,
                   "The same for the windows of running_time.md, which are computed last")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  add_cache(*command, arguments.cache_mib);
  command->add_option(
      "--shard",
      arguments.shard,
      "K/N: compute only this share of the windows, without the results. Shards may "
      "run on any machine and share a folder");
  command->add_option(
      "--merge",
      arguments.merge,
      "Folders of all shards, instead of recordings: writes the results of one run");
  command->add_option(
      "--figure-width",
      arguments.figure_width,
      "Width of the figures in print, e.g. 85mm or 175mm, with type of at least 7 pt");
  command->add_option("--output", arguments.output, "Folder to write")->required();
}

void add_calibrate(CLI::App& app, CalibrateArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "calibrate",
      "Writes the camera.yaml of a video or of images that show a printed board, or any plane");
  command
      ->add_option("recording",
                   arguments.recording,
                   "Video, folder of images, or any recording with images; needs no calibration")
      ->required();
  command
      ->add_option("--from",
                   arguments.from,
                   "Calibrate from a printed board, or from a plane of unknown structure")
      ->capture_default_str()
      ->check(CLI::IsMember({"board", "plane"}));
  command->add_option("--board",
                      arguments.board,
                      "COLUMNSxROWS inner corners (ChArUco: squares), e.g. 9x6; default: "
                      "the recording's board.yaml");
  command->add_option("--square", arguments.square, "Side of a square [m]");
  command->add_option("--pattern", arguments.pattern, "Printed pattern; default: chessboard")
      ->check(CLI::IsMember({"chessboard", "charuco"}));
  command->add_option("--marker", arguments.marker, "Side of a marker of a ChArUco board [m]");
  command->add_option("--dictionary",
                      arguments.dictionary,
                      "OpenCV's name of a ChArUco board's dictionary, e.g. DICT_5X5_100");
  command->add_option("--model", arguments.model, "Lens model")
      ->capture_default_str()
      ->check(CLI::IsMember({"radial-tangential", "equidistant"}));
  command
      ->add_option("--coefficients",
                   arguments.coefficients,
                   "Coefficients of the radial-tangential model: 4 (k1 k2 p1 p2), 5 or 8")
      ->capture_default_str()
      ->check(CLI::IsMember({4, 5, 8}));
  CLI::Option* gyroscope = command->add_flag(
      "--gyroscope",
      arguments.gyroscope,
      "Calibrate rotation, clock and bias of the gyroscope instead, from rotations in the images");
  for (const char* lens_option :
       {"--from", "--board", "--square", "--pattern", "--marker", "--dictionary", "--model"})
    gyroscope->excludes(command->get_option(lens_option));
  command
      ->add_option(
          "--figure", arguments.figure, "Plot of the angular rates before and after (.png)")
      ->needs(gyroscope);
  add_topics(*command, arguments.topics);
  command->add_option("--output", arguments.output, "camera.yaml to write")->required();
}

void add_convert(CLI::App& app, ConvertArguments& arguments) {
  CLI::App* command =
      app.add_subcommand("convert", "Writes any recording as an EuRoC folder or as a ROS bag");
  command->add_option("recording", arguments.recording, kRecordingHelp)->required();
  add_topics(*command, arguments.topics);
  add_choice<RecordingFormat>(
      *command, "--format", "Format to write; default: euroc", arguments.format);
  command->add_option("--output", arguments.output, "Folder or bag (.bag or .mcap) to write")
      ->required();
}

struct AllArguments {
  MethodArguments methods;
  CalibrateArguments calibrate;
  EvaluateArguments evaluate;
  InfoArguments info;
  RunArguments run;
  SnapshotArguments snapshot;
  ConvertArguments convert;
  std::filesystem::path recipe;
  std::filesystem::path synthesize_output;
  ViewArguments view;
  Page page = Page::man;
};

void declare(CLI::App& app, AllArguments& arguments) {
  app.require_subcommand(0, 1);
  add_view(app, arguments.view);
  add_info(app, arguments.info);
  add_convert(app, arguments.convert);
  add_run(app, arguments.run);
  add_snapshot(app, arguments.snapshot);
  add_evaluate(app, arguments.evaluate);
  for (const char* command : {"view", "run", "snapshot", "evaluate"})
    add_method_commands(*app.get_subcommand(command), arguments.methods);
  add_calibrate(app, arguments.calibrate);
  CLI::App* synthesize = app.add_subcommand(
      "synthesize", "Renders a recording with perfect ground truth from a recipe");
  synthesize->add_option("recipe", arguments.recipe, "Recipe, a YAML file")->required();
  synthesize->add_option("--output", arguments.synthesize_output, "Folder to write (EuRoC layout)")
      ->required();
  add_pages(app, arguments.page);
}

/// Adds the methods of sessions and shards, then resolves the names of methods in the settings.
void find_methods(AllArguments& arguments, OwnMethods& own) {
  const ViewArguments& view = arguments.view;
  if (const auto& session = view.session.value_or(view.inspect.recording); !session.empty())
    own.add_session(session);
  own.add_shards(arguments.evaluate.merge);
  for (InspectArguments* one :
       {&arguments.run.inspect, &arguments.snapshot.inspect, &arguments.view.inspect})
    one->settings =
        with_setting(one->settings, "method", one->settings.options.method.key(), own.table);
}

int dispatch(const CLI::App& app, const AllArguments& arguments, OwnMethods& own) {
  if (app.got_subcommand("info")) return info_command(arguments.info);
  if (app.got_subcommand("convert")) return convert_command(arguments.convert);
  if (app.got_subcommand("run")) return run_command(arguments.run);
  if (app.got_subcommand("snapshot")) return snapshot_command(arguments.snapshot, own);
  if (app.got_subcommand("calibrate")) return calibrate_command(arguments.calibrate);
  if (app.got_subcommand("evaluate")) return evaluate_command(arguments.evaluate, own.table);
  if (app.got_subcommand("synthesize"))
    return synthesize_command(arguments.recipe, arguments.synthesize_output);
  if (app.got_subcommand("pages")) {
    fmt::print("{}", page_of(app, arguments.page, GPO_VERSION));
    return kDone;
  }
  return view_command(arguments.view, own);
}

int report_error(const std::string& message) {
  fmt::print(stderr, "gpo-inspector: {}\n", message);
  return kBadInput;
}

/// Returns the message in one line with the command that prints more help.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  std::string message = error.what();
  std::ranges::replace(message, '\n', ' ');
  std::string help = app.get_name();
  const auto commands = app.get_subcommands();
  const auto words = app.remaining();
  if (!commands.empty()) {
    help += " " + commands.front()->get_name();
  } else if (!words.empty() && !words.front().starts_with('-')) {
    message = fmt::format(
        "unknown command '{}', expected one of {}", words.front(), names_of_commands(app, ", "));
  }
  return InputError(fmt::format("{}; see {} --help", message, help)).what();
}

}  // namespace

int main_with_errors(int argc, char** argv) {
  CLI::App app("gpo-inspector: inspects monocular initialization on planar scenes",
               "gpo-inspector");
  AllArguments arguments;
  try {
    quiet_libraries();
    declare(app, arguments);
    app.set_version_flag("--version", "gpo-inspector " GPO_VERSION);
    app.parse(argc, argv);
    OwnMethods own(arguments.methods);
    find_methods(arguments, own);
    const int code = dispatch(app, arguments, own);
    if (std::fflush(stdout) == 0) return code;
    return report_error(fmt::format("standard output: cannot be written: {}",
                                    std::generic_category().message(errno)));
  } catch (const CLI::Success& help_requested) {
    return app.exit(help_requested);
  } catch (const CLI::ParseError& error) {
    return report_error(usage_error(app, error));
  } catch (const Interrupted& interrupted) {
    report_error(interrupted.what());
    return kFailed;
  } catch (const SettingError& error) {
    return report_error(option_name(error.name) +
                        std::string(error.what()).substr(error.name.size()));
  } catch (const std::exception& error) {
    return report_error(message_of(error));
  }
}

}  // namespace gpo
