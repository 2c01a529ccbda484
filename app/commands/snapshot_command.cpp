// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "engine/base/error.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "engine/recording/images/images.h"
#include "ui/views/snapshot.h"
#include "ui/workbench_window.h"

#include <cstdio>

namespace gpo {
namespace {

struct SnapshotArguments {
  InspectArguments inspect;
  ViewRequest drawn;  ///< without size, window and table
  std::optional<std::string> size;
  fs::path output;
  std::optional<fs::path> script, baseline, live;
  int tolerance = 3;
};

void run_script_line(WorkbenchHost& host, OffscreenContext& context, const std::string& line) {
  const auto& messages = host.state.messages.lines;
  const std::size_t before = messages.size();
  if (!line.empty()) run_line(host.state, line);
  host.settle();
  context.bind();
  for (const Command& command : host.draw()) apply(host.state, command);
  for (std::size_t i = before; i < messages.size(); ++i) {
    if (messages[i].severity == Severity::error) throw InputError(messages[i].text);
    fmt::print("{}\n", messages[i].text);
  }
}

int run_script(const SnapshotArguments& snapshot, cv::Size size, OwnMethods& own) {
  const InspectArguments& arguments = snapshot.inspect;
  const std::vector<ScriptLine> lines = read_script(*snapshot.script);
  OffscreenContext context(size.width, size.height);
  Gui gui;
  WorkbenchHost host(
      gui, opener_for_window(arguments.cache_mib, given_recording(arguments)), example_recording());
  host.timings = false;
  host.reads_models_at_once = true;
  host.size = size;
  host.state.document.settings = arguments.settings;
  host.state.methods = own.table;
  host.link.read_methods = session_methods(own, report_not_started);
  host.link.calibrates = arguments.calibrate == "auto";
  host.state.files.given = arguments.recording;
  host.state.files.given_topics = arguments.topics;
  if (!arguments.recording.empty()) host.state.requests.open = arguments.recording;
  run_script_line(host, context, "");
  for (const ScriptLine& line : lines) {
    check_stop();
    try {
      run_script_line(host, context, line.text);
      for (std::string& text : own.log->take())
        host.state.messages.lines.push_back({Severity::note, std::move(text)});
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}:{}: {}", snapshot.script->string(), line.number, error.what()));
    }
    if (host.state.requests.quit) break;
  }
  return kDone;
}

void report_unused_by_view(const ViewRequest& request) {
  const bool curves = request.view == "curves";
  if (request.methods && !curves && request.view != "compare")
    fmt::print(stderr, "--methods is not used. Only the views compare and curves read it\n");
  if (request.lengths && !curves)
    fmt::print(stderr, "--lengths is not used. Only the view curves reads it\n");
  if (request.frame && curves)
    fmt::print(stderr, "--frame is not used. The view curves shows no frame\n");
}

DrawnView draw(const InspectArguments& arguments, ViewRequest request, const NamedFile& output) {
  const auto recording = open(arguments);
  check_not_overwritten(*recording, {output});
  request.window = with_window_within(request.window, arguments.given, recording->frame_count());
  DrawnView drawn = draw_view(recording, request, current_stop());
  const bool compares = request.view == "compare" || request.view == "curves";
  report_unused(arguments.given,
                drawn.inspections,
                compares ? configurations_of(request) : std::vector<Configuration>{});
  for (const std::string& failure : drawn.failures) fmt::print(stderr, "{}\n", failure);
  return drawn;
}

/// Draws the window of a live source whose images are those of a recording, one by one.
DrawnView draw_live(const SnapshotArguments& arguments) {
  const std::string address = arguments.live->string();
  if (is_live_address(address))
    throw InputError("--live: '" + address + "', expected a video or a recording");
  const SourceAddress source = live_source(address);
  const Recording& recording = *source.recording;
  if (!recording.images) throw InputError("--live: " + address + " has no images");
  const int last = recording.frame_count() - 1;
  const int frame = arguments.drawn.frame.value_or(last);
  if (frame < 0 || frame > last)
    throw SettingError(
        "frame", fmt::format("{} is not in the recording, which has frames 0 to {}", frame, last));
  LiveWindow window(
      {.address = address,
       .device = "",
       .camera = LiveCamera{recording.camera, recording.camera_source, "as in " + address}});
  const Settings& settings = arguments.inspect.settings;
  for (int i = 0; i <= frame; ++i) {
    check_stop();
    window.add({recording.images->bgr(i), recording.timestamps_ns[i]}, settings.tracking);
  }
  auto answer = inspect(window.task(), settings, current_stop());
  if (!answer) throw Stopped{};
  DrawnView drawn;
  if (answer->inspection)
    add_result(drawn, answer->inspection, answer->inspection->settings.options.method);
  const LiveView live{.address = recording.name,
                      .capture = {.state = CaptureState::running,
                                  .size = recording.images->bgr(frame).size(),
                                  .captured = frame + 1},
                      .answer = std::make_shared<const LiveAnswer>(std::move(*answer)),
                      .why_anew = window.why_anew()};
  fmt::print(stderr, "{} \u00b7 {}\n", progress_text(live), counts_text(live));
  drawn.image = snapshot_live(arguments.drawn.view, live, settings, arguments.drawn.size);
  return drawn;
}

fs::path difference_file(const SnapshotArguments& arguments) {
  return fs::path(arguments.output).replace_extension(".diff.png");
}

int compare(const cv::Mat& image, const cv::Mat& baseline, const SnapshotArguments& arguments) {
  const std::string differs = "differs from " + arguments.baseline->string();
  const std::string output = arguments.output.string();
  if (image.size() != baseline.size()) {
    const auto size = [](const cv::Mat& of) { return fmt::format("{}x{}", of.cols, of.rows); };
    const std::string sizes = "the baseline is " + size(baseline) + ", the image " + size(image);
    fmt::print("{}: {}; see {}\n", differs, sizes, output);
    return kFailed;
  }
  const ImageComparison comparison = compare_images(image, baseline, arguments.tolerance);
  fmt::print("pixels that differ by more than");
  for (std::size_t k = 0; k < ImageComparison::kSweep.size(); ++k)
    fmt::print(" {}: {}{}", ImageComparison::kSweep[k], comparison.beyond[k], k < 3 ? "," : "\n");
  if (comparison.equal) return kDone;
  const fs::path difference = difference_file(arguments);
  write_image(difference, comparison.difference);
  fmt::print("{}: {}; see {} and {}\n", differs, comparison.reason, output, difference.string());
  return kFailed;
}

void check(const SnapshotArguments& arguments) {
  if (arguments.live && !arguments.inspect.recording.empty())
    throw InputError("--live: give no recording besides it");
  if (arguments.inspect.recording.empty() && !arguments.live)
    throw InputError("recording is required");
  if (arguments.drawn.view.empty()) throw InputError("--view is required");
  if (arguments.output.empty()) throw InputError("--output is required");
  if (arguments.output.extension() != ".png")
    throw InputError(fmt::format("--output: '{}', expected a file name that ends in .png",
                                 arguments.output.string()));
  const std::vector<NamedFile> inputs{{"--baseline", arguments.baseline},
                                      {"--tracks", arguments.inspect.tracks},
                                      {"--live", arguments.live},
                                      {"recording", arguments.inspect.recording}};
  check_outputs({{"--output", arguments.output}}, inputs);
  std::error_code none;
  if (arguments.baseline && !fs::exists(*arguments.baseline, none))
    throw InputError(fmt::format("--baseline: {}: no such file", arguments.baseline->string()));
  if (arguments.baseline)
    check_outputs({{"--output's .diff.png", difference_file(arguments)}}, inputs);
}

/// Reads an image as CV_8UC3.
cv::Mat read_baseline(const fs::path& file) try {
  if (!is_file(file)) throw InputError("no file");  // a pipe might never end
  cv::Mat image = read_image(file);
  if (image.depth() == CV_16U) image.convertTo(image, CV_8U, 1 / 257.0);
  return image;
} catch (const InputError&) {
  throw InputError(fmt::format("--baseline: cannot decode {} as an image", file.string()));
}

int draw_one_view(const SnapshotArguments& arguments, const ViewRequest& request) {
  check(arguments);
  const cv::Mat baseline = arguments.baseline ? read_baseline(*arguments.baseline) : cv::Mat();
  report_unused_by_view(request);
  const DrawnView drawn = arguments.live
                              ? draw_live(arguments)
                              : draw(arguments.inspect, request, {"--output", arguments.output});
  make_folder(folder_of(fs::absolute(arguments.output)));
  write_image(arguments.output, drawn.image);
  if (!drawn.ok) return kFailed;
  fmt::print("{}: {}x{}\n", arguments.output.string(), drawn.image.cols, drawn.image.rows);
  return arguments.baseline ? compare(drawn.image, baseline, arguments) : kDone;
}

}  // namespace

RunCommand add_snapshot(CLI::App& app) {
  const auto to = std::make_shared<SnapshotArguments>();
  CLI::App& command =
      *app.add_subcommand("snapshot", "Draws one view or runs a script, without a display");
  add_tracks_and_recording(command, to->inspect);
  CLI::Option* script = command.add_option(
      "--script", to->script, "File of window commands, one per line, instead of one view");
  command
      .add_option("--live",
                  to->live,
                  "Video or recording whose images arrive one by one up to --frame, as in `view "
                  "--live`")
      ->excludes(script);
  command.add_option("--view", to->drawn.view, "View to draw")
      ->check(CLI::IsMember(pane_names()))
      ->excludes(script);
  command.add_option("--output", to->output, "PNG file to write")->excludes(script);
  command.add_option(
      "--frame",
      to->drawn.frame,
      "Frame of the recording to draw, after the window with an extrapolated camera; default: the "
      "window's last");
  command.add_option(
      "--methods",
      to->drawn.methods,
      "Comma-separated methods of the views compare and curves, each with changed settings: " +
          configuration_syntax() + "; default: every method");
  command.add_option(
      "--lengths",
      to->drawn.lengths,
      "Window lengths of the view curves [frames], FROM:TO:STEP; default: 5:FRAMES:5");
  command.add_option("--size", to->size, "Size WxH [px]; default: depends on the view");
  command.add_option(
      "--baseline",
      to->baseline,
      "Image to compare with; if they differ, exits with 1 and writes OUTPUT.diff.png");
  command
      .add_option("--tolerance",
                  to->tolerance,
                  "Largest difference of a color channel (0 to 255) that counts as equal")
      ->capture_default_str()
      ->check(CLI::Range(0, 255));
  return [to](OwnMethods& own, Interrupt& /*interrupt*/) {
    find_method(to->inspect, own.table);
    ViewRequest& drawn = to->drawn;
    if (to->size) drawn.size = image_size(*to->size, "--size");
    if (to->script) return run_script(*to, drawn.size.value_or(cv::Size(1280, 720)), own);
    drawn.window = to->inspect.settings;
    drawn.table = own.table;
    return draw_one_view(*to, drawn);
  };
}

}  // namespace gpo
