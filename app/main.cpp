// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/commands/setting_options.h"
#include "app/main_with_errors.h"
#include "app/methods/method_commands.h"
#include "app/pages.h"
#include "app/images/snapshots.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/quiet_libraries.h"
#include "engine/base/error.h"
#include "engine/experiment/configuration.h"
#include "engine/inspection/settings/setting_values.h"

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
  command.add_option("--cache", mib, "Decoded pictures that are kept in memory [MiB]")
      ->capture_default_str()
      ->check(CLI::Range(16, 1'000'000));
}

void add_topics(CLI::App& command, TopicChoices& topics) {
  command
      .add_option_function<std::vector<std::string>>(
          "--topic",
          [&topics](const std::vector<std::string>& texts) { topics = parse_topic_choices(texts); },
          fmt::format("Of a bag with several: ROLE=NAME, e.g. image=/cam0/image_raw; roles: {}",
                      fmt::join(ChoiceKeys<TopicRole>::keys, ", ")))
      ->allow_extra_args(false);
}

void add_calibrating(CLI::App& command, std::string& calibrate) {
  command
      .add_option("--calibrate",
                  calibrate,
                  "auto: what has no calibration is calibrated from a plane in view, once")
      ->capture_default_str()
      ->check(CLI::IsMember({"off", "auto"}));
}

void add_inspection(CLI::App& command, InspectArguments& arguments) {
  command
      .add_option("recording", arguments.recording, "Folder or file of a recording, or a recipe")
      ->required();
  command.add_option(
      "--tracks", arguments.tracks, "Tracks (frame,track,x,y) instead of the built-in tracker");
  add_topics(command, arguments.topics);
  add_cache(command, arguments.cache_mib);
  add_calibrating(command, arguments.calibrate);
  add_settings(command, arguments.settings, arguments.given);
}

void add_info(CLI::App& app, InfoArguments& arguments) {
  CLI::App* command = app.add_subcommand("info", "What is found in a recording");
  command->add_option(
      "recording", arguments.recording, "Folder or file of a recording, or a recipe");
  command
      ->add_option("--json",
                   arguments.json,
                   "As JSON, into a file; without one, or as -, to standard output")
      ->expected(0, 1);
  add_topics(*command, arguments.topics);
  command->callback([command, &arguments] {
    arguments.wants_json = command->count("--json") > 0;
    // `info --json RECORDING` has always printed; there the recording looks like the file.
    if (arguments.recording.empty()) std::swap(arguments.recording, arguments.json);
    if (arguments.recording.empty()) throw CLI::RequiredError("recording");
  });
}

void add_run(CLI::App& app, RunArguments& arguments) {
  CLI::App* command = app.add_subcommand("run", "One initialization; prints a short table");
  add_inspection(*command, arguments.inspect);
  command->add_option("--json", arguments.json, "Write the whole result; -: to standard output");
  command->add_option("--trajectory", arguments.trajectory, "Write the camera poses");
  command->add_option(
      "--true-trajectory", arguments.true_trajectory, "Write the true camera poses of the window");
  add_choice<TrajectoryFormat>(
      *command, "--trajectory-format", "Of both; default: tum", arguments.trajectory_format);
  command->add_option("--points", arguments.points, "Write the map points as PLY");
  command->add_flag(
      "--metric",
      arguments.metric,
      "Trajectory and points in meters, by the accelerometer; default: in distances of the plane");
  command->add_option("--tracks-out",
                      arguments.tracks_out,
                      "Write every track's pixels, plane, verdict, residual and reason a frame as "
                      "CSV, which --tracks reads back");
  CLI::Option* scan = command->add_option(
      "--scan", arguments.scan, "Initialize from everywhere instead, and write a line a start");
  for (const char* other :
       {"--json", "--trajectory", "--true-trajectory", "--points", "--tracks-out"})
    scan->excludes(command->get_option(other));
  command->add_option("--scan-step", arguments.scan_step, "Frames between starts")
      ->check(CLI::PositiveNumber)
      ->needs(scan);
}

void add_snapshot(CLI::App& app, SnapshotArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "snapshot", "One picture, or all that a script asks for, without a display");
  add_inspection(*command, arguments.inspect);
  command->get_option("recording")->required(false);
  CLI::Option* script = command->add_option(
      "--script", arguments.script, "Commands of the window, one a line, instead of one view");
  command->add_option("--view", arguments.view, "What to draw")
      ->check(CLI::IsMember(view_names()))
      ->excludes(script);
  command->add_option("--output", arguments.output, "PNG file to write")->excludes(script);
  command->add_option(
      "--frame", arguments.frame, "Frame of the recording to draw; default: the window's last");
  command->add_option(
      "--methods",
      arguments.methods,
      "Of the views compare and curves: methods with commas, each with settings that differ, " +
          configuration_syntax() + "; default: every method");
  command->add_option("--lengths",
                      arguments.lengths,
                      "Of the view curves: lengths of the windows [frames], FROM:TO:STEP; default: "
                      "5:FRAMES:5");
  command->add_option("--size", arguments.size, "WxH in pixels; default: the view's own");
  command->add_option("--baseline",
                      arguments.baseline,
                      "Picture to compare with; exit code 1 and OUTPUT.diff.png where it differs");
  command
      ->add_option("--tolerance",
                   arguments.tolerance,
                   "Largest difference of a color channel that counts as equal, of 255")
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
  command
      .add_option("--lengths", arguments.lengths, "Lengths of the windows [frames], FROM:TO:STEP")
      ->capture_default_str();
  command
      .add_option("--starts",
                  arguments.starts,
                  "First frames of the windows; end: the last from which the longest fits")
      ->capture_default_str();
  command.add_option("--seed", arguments.seed, "Seed of every random choice")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1'000'000'000}));
}

void add_evaluate(CLI::App& app, EvaluateArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "evaluate",
      "Methods on many windows: results.csv, summary.json, figures and the running times. "
      "Interrupted (exit code 1) or killed, the same line goes on where it was");
  command->add_option(
      "recording", arguments.recordings, "Folders or files of recordings, or recipes");
  add_topics(*command, arguments.topics);
  add_experiment(*command, arguments);
  arguments.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command->add_option("--jobs", arguments.jobs, "Windows of so many starts are computed at once")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  command
      ->add_option("--timing-jobs",
                   arguments.timing_jobs,
                   "The same for the windows of running_time.md, which come last")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  add_cache(*command, arguments.cache_mib);
  command->add_option("--shard",
                      arguments.shard,
                      "K/N: only this share of the windows, without the results; on any machine, "
                      "into a folder of its own or a common one");
  command->add_option("--merge",
                      arguments.merge,
                      "Folders of all shards, instead of recordings: makes the results of one run");
  command->add_option(
      "--figure-width",
      arguments.figure_width,
      "Figures for a page: so wide, e.g. 85mm or 175mm, with type of 7 pt and more");
  command->add_option("--output", arguments.output, "Folder to write")->required();
}

void add_calibrate(CLI::App& app, CalibrateArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "calibrate",
      "Writes the camera.yaml of a video or of pictures that show a printed board, or any plane");
  command
      ->add_option(
          "recording",
          arguments.recording,
          "Video, folder of pictures, or any recording with pictures; needs no calibration")
      ->required();
  command
      ->add_option("--from",
                   arguments.from,
                   "What tells the camera: a printed board, or a plane of unknown structure")
      ->capture_default_str()
      ->check(CLI::IsMember({"board", "plane"}));
  command->add_option("--board",
                      arguments.board,
                      "COLUMNSxROWS inner corners, of a ChArUco board squares, e.g. 9x6; default: "
                      "the recording's board.yaml");
  command->add_option("--square", arguments.square, "Side of a square [m]");
  command->add_option("--pattern", arguments.pattern, "What is printed; default: chessboard")
      ->check(CLI::IsMember({"chessboard", "charuco"}));
  command->add_option("--marker", arguments.marker, "Of a ChArUco board: side of a marker [m]");
  command->add_option(
      "--dictionary", arguments.dictionary, "Of a ChArUco board: OpenCV's name, e.g. DICT_5X5_100");
  command->add_option("--model", arguments.model, "Model of the lens")
      ->capture_default_str()
      ->check(CLI::IsMember({"radial-tangential", "equidistant"}));
  command
      ->add_option("--coefficients",
                   arguments.coefficients,
                   "Of the radial-tangential model: 4 (k1 k2 p1 p2), 5 or 8")
      ->capture_default_str()
      ->check(CLI::IsMember({4, 5, 8}));
  CLI::Option* gyroscope = command->add_flag(
      "--gyroscope",
      arguments.gyroscope,
      "Instead of the lens: rotation, clock and bias of the gyroscope, from rotations by pictures");
  for (const char* of_lens :
       {"--from", "--board", "--square", "--pattern", "--marker", "--dictionary", "--model"})
    gyroscope->excludes(command->get_option(of_lens));
  command->add_option("--figure", arguments.figure, "Picture of the rates, before and after (.png)")
      ->needs(gyroscope);
  add_topics(*command, arguments.topics);
  command->add_option("--output", arguments.output, "camera.yaml to write")->required();
}

void add_convert(CLI::App& app, ConvertArguments& arguments) {
  CLI::App* command =
      app.add_subcommand("convert", "Writes any recording as an EuRoC folder, or as a bag of ROS");
  command
      ->add_option("recording", arguments.recording, "Folder or file of a recording, or a recipe")
      ->required();
  add_topics(*command, arguments.topics);
  add_choice<RecordingFormat>(*command, "--format", "Default: euroc", arguments.format);
  command
      ->add_option(
          "--output", arguments.output, "Folder to write; of a bag the file, .bag or .mcap")
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
  CLI::App* view = app.add_subcommand("view", "The window; the default");
  view->add_option(
      "recording", arguments.view.recording, "Folder or file of a recording, or a recipe");
  add_topics(*view, arguments.view.topics);
  add_cache(*view, arguments.view.cache_mib);
  add_calibrating(*view, arguments.view.calibrate);
  add_settings(*view, arguments.view.settings, arguments.view.given);
  view->add_option("--session", arguments.view.session, "Session to go on with, a JSON file");
  view->add_option("--script", arguments.view.script, "Commands to begin with, one a line");
  add_info(app, arguments.info);
  add_convert(app, arguments.convert);
  add_run(app, arguments.run);
  add_snapshot(app, arguments.snapshot);
  add_evaluate(app, arguments.evaluate);
  for (const char* command : {"view", "run", "snapshot", "evaluate"})
    add_method_commands(*app.get_subcommand(command), arguments.methods);
  add_calibrate(app, arguments.calibrate);
  CLI::App* synthesize =
      app.add_subcommand("synthesize", "A recording with perfect ground truth, from a recipe");
  synthesize->add_option("recipe", arguments.recipe, "Recipe, a YAML file")->required();
  synthesize->add_option("--output", arguments.synthesize_output, "Folder to write, EuRoC layout")
      ->required();
  add_pages(app, arguments.page);
}

/// Methods that options name, which are known once all options are read.
void find_methods(AllArguments& arguments, OwnMethods& own) {
  const ViewArguments& view = arguments.view;
  const auto& session = view.session ? view.session : view.recording;
  if (session) own.add_session(*session);
  own.add_shards(arguments.evaluate.merge);
  for (Settings* settings : {&arguments.run.inspect.settings,
                             &arguments.snapshot.inspect.settings,
                             &arguments.view.settings})
    *settings = with_setting(*settings, "method", settings->options.method.key(), own.table);
}

int dispatch(const CLI::App& app, const AllArguments& arguments, OwnMethods& own) {
  if (app.got_subcommand("info")) return info_command(arguments.info);
  if (app.got_subcommand("convert")) return convert_command(arguments.convert);
  if (app.got_subcommand("run")) return run_command(arguments.run);
  if (app.got_subcommand("snapshot")) return snapshot_command(arguments.snapshot, own);
  if (app.got_subcommand("calibrate"))
    return arguments.calibrate.gyroscope ? calibrate_gyroscope_command(arguments.calibrate)
                                         : calibrate_command(arguments.calibrate);
  if (app.got_subcommand("evaluate")) return evaluate_command(arguments.evaluate, own.table);
  if (app.got_subcommand("synthesize"))
    return synthesize_command(arguments.recipe, arguments.synthesize_output);
  if (app.got_subcommand("pages")) {
    fmt::print("{}", page_of(app, arguments.page, GPO_VERSION));
    return kDone;
  }
  return view_command(arguments.view, own);
}

int complain(const std::string& message) {
  fmt::print(stderr, "gpo-inspector: {}\n", message);
  return kBadInput;
}

/// In one line, and where there is more to read.
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
    return complain(fmt::format("standard output: cannot be written: {}",
                                std::generic_category().message(errno)));
  } catch (const CLI::Success& asked_for_help) {
    return app.exit(asked_for_help);
  } catch (const CLI::ParseError& error) {
    return complain(usage_error(app, error));
  } catch (const Interrupted& interrupted) {
    complain(interrupted.what());
    return kFailed;
  } catch (const SettingError& error) {
    return complain(option_name(error.name) + std::string(error.what()).substr(error.name.size()));
  } catch (const std::exception& error) {
    return complain(message_of(error));
  }
}

}  // namespace gpo
