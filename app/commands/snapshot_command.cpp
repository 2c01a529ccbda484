// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/commands/setting_options.h"
#include "app/commands/snapshots.h"
#include "app/recordings/recordings.h"
#include "app/terminal/output.h"
#include "engine/base/error.h"
#include "engine/files/folder.h"
#include "engine/files/output_file.h"
#include "ui/context/offscreen_context.h"
#include "ui/views/snapshot.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench_window.h"

#include <array>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// Runs one command and prints its messages. Throws InputError with the first error.
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

/// Runs the window's commands off-screen.
int run_script(const SnapshotArguments& snapshot, cv::Size size, OwnMethods& own) {
  const InspectArguments& arguments = snapshot.inspect;
  const std::vector<ScriptLine> lines = read_script(*snapshot.script);
  OffscreenContext context(size.width, size.height);
  Gui gui;
  WorkbenchHost host(gui,
                     opener_for_window(arguments.cache_mib, arguments.recording, arguments.topics),
                     example_recording());
  host.timings = false;
  host.size = size;
  host.state.document.settings = arguments.settings;
  host.state.methods = own.table;
  host.link.add_methods = [&own](const fs::path& session, WorkbenchState& state) {
    own.add_session(session);
    report_not_started(own);
    state.methods = own.table;
  };
  host.link.calibrates = arguments.calibrate == "auto";
  if (!arguments.recording.empty()) host.state.requests.open = arguments.recording;
  run_script_line(host, context, "");
  for (const ScriptLine& line : lines) {
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

void report_unused_by_view(const SnapshotArguments& arguments) {
  const bool curves = arguments.view == "curves";
  if (arguments.methods && !curves && arguments.view != "compare")
    fmt::print(stderr, "--methods is not used. Only the views compare and curves read it\n");
  if (arguments.lengths && !curves)
    fmt::print(stderr, "--lengths is not used. Only the view curves reads it\n");
  if (arguments.frame && curves)
    fmt::print(stderr, "--frame is not used. The view curves shows no frame\n");
}

/// Draws, and prints the unused settings and the failures.
DrawnView draw(const SnapshotArguments& arguments,
               const std::optional<cv::Size>& size,
               const MethodTable& methods) {
  const ComparisonRequest compared{.methods = arguments.methods,
                                   .lengths = arguments.lengths,
                                   .window = arguments.inspect.settings,
                                   .table = methods};
  const ViewRequest request{
      .view = arguments.view, .frame = arguments.frame, .size = size, .compared = compared};
  DrawnView drawn = draw_view(open(arguments.inspect), request);
  if (arguments.view == "compare" || arguments.view == "curves")
    report_unused(arguments.inspect.given, configurations_of(compared), drawn.inspections);
  else
    report_unused(arguments.inspect.given, *drawn.inspections.front());
  for (const std::string& failure : drawn.failures) fmt::print(stderr, "{}\n", failure);
  return drawn;
}

cv::Mat read_baseline(const fs::path& file) {
  cv::Mat image = cv::imread(file.string(), cv::IMREAD_COLOR);
  if (image.empty())
    throw InputError(fmt::format("--baseline: cannot decode {} as an image", file.string()));
  return image;
}

fs::path difference_file(const SnapshotArguments& arguments) {
  return fs::path(arguments.output).replace_extension(".diff.png");
}

int compare(const cv::Mat& image, const cv::Mat& baseline, const SnapshotArguments& arguments) {
  const std::string differs = "differs from " + arguments.baseline->string();
  const std::string output = arguments.output.string();
  if (image.size() != baseline.size()) {
    fmt::print("{}: the baseline is {}x{}, the image {}x{}; see {}\n",
               differs,
               baseline.cols,
               baseline.rows,
               image.cols,
               image.rows,
               output);
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

/// Checks the arguments of one view.
void check(const SnapshotArguments& arguments) {
  if (arguments.inspect.recording.empty()) throw InputError("recording is required");
  if (arguments.view.empty()) throw InputError("--view is required");
  if (arguments.output.empty()) throw InputError("--output is required");
  if (arguments.output.extension() != ".png")
    throw InputError(fmt::format("--output: '{}', expected a file name that ends in .png",
                                 arguments.output.string()));
  const std::array inputs{NamedFile{"--baseline", arguments.baseline},
                          NamedFile{"--tracks", arguments.inspect.tracks},
                          NamedFile{"recording", arguments.inspect.recording}};
  check_outputs(std::array{NamedFile{"--output", arguments.output}}, inputs);
  if (arguments.baseline)
    check_outputs(std::array{NamedFile{"--output's .diff.png", difference_file(arguments)}},
                  inputs);
}

}  // namespace

int snapshot_command(const SnapshotArguments& arguments, OwnMethods& own) {
  const auto size =
      arguments.size ? std::optional(image_size(*arguments.size, "--size")) : std::nullopt;
  if (arguments.script) return run_script(arguments, size.value_or(cv::Size(1280, 720)), own);
  check(arguments);
  const cv::Mat baseline = arguments.baseline ? read_baseline(*arguments.baseline) : cv::Mat();
  report_unused_by_view(arguments);
  const DrawnView drawn = draw(arguments, size, own.table);
  const cv::Mat& image = drawn.image;
  make_folder(folder_of(fs::absolute(arguments.output)));
  write_image(arguments.output, image);
  if (!drawn.ok) return kFailed;
  fmt::print("{}: {}x{}\n", arguments.output.string(), image.cols, image.rows);
  return arguments.baseline ? compare(image, baseline, arguments) : kDone;
}

}  // namespace gpo
