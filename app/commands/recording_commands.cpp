// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The commands that read, write and make recordings: info, convert, record, synthesize.
#include "app/commands/commands.h"
#include "engine/base/error.h"
#include "engine/calibration/calibration_report.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "engine/recording/board/board.h"
#include "engine/recording/live/live_recording.h"
#include "engine/rotations/gyroscope_check.h"
#include "engine/synthesis/recipe.h"
#include "engine/synthesis/synthesize.h"
#include "ui/workbench/work/writers.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include <nlohmann/json.hpp>

namespace gpo {
namespace {

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
  const Gyroscope& gyroscope = *recording->gyroscope;
  if (const std::string why = why_wrong_rates(windows, gyroscope); !why.empty()) return why;
  return why_it_does_not_fit(fit_gyroscope(windows, gyroscope), gyroscope, 1 / rate_hz);
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
  std::vector<int> frames(recording.frame_count());
  std::iota(frames.begin(), frames.end(), 0);
  return board_truth(recording, frames, current_stop(), std::ref(bar));
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

struct RecordArguments {
  std::string source;
  fs::path output;
  std::optional<RecordingFormat> format;  ///< default: as the output's extension tells
  std::optional<double> seconds;          ///< default: until it ends
};

struct Recorded {
  CaptureStatus status;
  std::string end;  ///< why it ended, one line; empty: as requested
};

/// Fills the spool until the source ends, `seconds` are recorded or the user stops it.
Recorded record_into(FrameSpool& spool, Capture& capture, std::optional<double> seconds) {
  std::optional<ProgressBar> bar;
  std::int64_t first_ns = 0;
  while (const auto image = capture.take(current_stop())) {
    if (spool.count() == 0) {
      first_ns = image->timestamp_ns;
      fmt::print(stderr, "recording; Ctrl-C ends it\n");
      if (seconds) bar.emplace("recording", "s");
    }
    if (image->segment > 0)
      return {capture.status(),
              fmt::format("the size changed to {}x{}", image->bgr.cols, image->bgr.rows)};
    const double time_s = 1e-9 * static_cast<double>(image->timestamp_ns - first_ns);
    if (seconds && time_s > *seconds) return {capture.status(), ""};
    spool.add(*image);
    if (bar) (*bar)(static_cast<int>(time_s), std::max(1, static_cast<int>(*seconds)));
  }
  const CaptureStatus status = capture.status();
  return {status, status.message};
}

void check_new_output(const fs::path& output, RecordingFormat format) {
  if (format == RecordingFormat::euroc) return check_output_folder(output);
  check_writable(output);
  if (fs::exists(output)) throw InputError(output.string() + ": already exists; choose a new file");
}

/// Writes the recording and returns where. If files of other recordings beside a bag forbid it, the
/// bag gets a folder of its own, because what was recorded must not be lost.
fs::path write_recorded(const Recording& recording,
                        RecordingFormat format,
                        const fs::path& output) {
  ProgressBar bar("writing " + output.string());
  try {
    write_recording(recording, std::nullopt, format, output, std::ref(bar));
    return output;
  } catch (const InputError& error) {
    if (format == RecordingFormat::euroc) throw;
    fs::path own = folder_of(output) / output.stem();
    for (int k = 2; fs::exists(own); ++k)
      own.replace_filename(fmt::format("{}-{}", output.stem().string(), k));
    write_recording(recording, std::nullopt, format, own / output.filename(), std::ref(bar));
    fmt::print(stderr, "{}\n", error.what());
    return own / output.filename();
  }
}

int record_source(const RecordArguments& arguments, Interrupt& interrupt) {
  constexpr int kQueue = 60;
  const fs::path& output = arguments.output;
  const RecordingFormat format = recording_format(output, arguments.format);
  check_new_output(output, format);
  const SourceAddress address = live_source(arguments.source);
  FrameSpool spool(output);
  interrupt.let_finish();
  Recorded recorded;
  {
    Capture capture(address, {.queue = kQueue});
    recorded = record_into(spool, capture, arguments.seconds);
  }
  if (spool.count() == 0) {
    if (recorded.status.is_over()) throw InputError(recorded.end);
    throw Stopped{"there was no image yet, nothing was written"};
  }
  const StopScope to_the_end(nullptr);  // Ctrl-C ended the capture, not the writing
  const LiveImages live = spool.images();
  const Recording recording =
      live_recording({.address = arguments.source,
                      .device = recorded.status.device,
                      .camera = camera_of_source(address, recorded.status.device, spool.size())},
                     live);
  const fs::path written = write_recorded(recording, format, output);
  if (!recorded.end.empty()) fmt::print(stderr, "{}\n", recorded.end);
  const auto& times_ns = live.timestamps_ns;
  fmt::print("{}: {} frames, {}x{}, {:.1f} s, {} dropped\n",
             written.string(),
             spool.count(),
             spool.size().width,
             spool.size().height,
             1e-9 * static_cast<double>(times_ns.back() - times_ns.front()),
             recorded.status.dropped);
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

RunCommand add_record(CLI::App& app) {
  const auto to = std::make_shared<RecordArguments>();
  CLI::App& command = *app.add_subcommand(
      "record", "Records a camera or a stream as an EuRoC folder or as a ROS bag");
  command.add_option("source", to->source, kSourceHelp)->required();
  command.add_option("--output", to->output, "Folder or bag (.bag or .mcap) to write")->required();
  add_choice<RecordingFormat>(
      command,
      "--format",
      "Format to write; default: as the extension of the output, else euroc",
      to->format);
  command
      .add_option(
          "--seconds", to->seconds, "Length to record [s]; default: until Ctrl-C or its end")
      ->check(number_within(0.001, 1e6));
  return [to](OwnMethods& /*own*/, Interrupt& interrupt) { return record_source(*to, interrupt); };
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

}  // namespace gpo
