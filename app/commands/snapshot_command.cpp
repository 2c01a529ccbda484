// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/commands/setting_options.h"
#include "app/images/snapshots.h"
#include "app/terminal/output.h"
#include "engine/base/error.h"
#include "engine/files/folder.h"
#include "engine/files/output_file.h"
#include "ui/views/snapshot.h"
#include "ui/workbench/session/script.h"

#include <array>
#include <cstdio>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// Of what only some views heed.
void tell_unused_by_view(const SnapshotArguments& arguments) {
  const bool curves = arguments.view == "curves";
  if (arguments.methods && !curves && arguments.view != "compare")
    fmt::print(stderr, "--methods is not used. Only the views compare and curves read it\n");
  if (arguments.lengths && !curves)
    fmt::print(stderr, "--lengths is not used. Only the view curves reads it\n");
  if (arguments.frame && curves)
    fmt::print(stderr, "--frame is not used. The view curves shows no frame\n");
}

/// Draws, and says what was not used and what failed.
DrawnView draw(const SnapshotArguments& arguments,
               const std::optional<cv::Size>& size,
               const MethodTable& methods) {
  const ComparisonRequest compared{
      arguments.methods, arguments.lengths, arguments.inspect.settings, methods};
  const ViewRequest request{arguments.view, arguments.frame, size, compared};
  DrawnView drawn = draw_view(open(arguments.inspect), request);
  if (arguments.view == "compare" || arguments.view == "curves")
    tell_unused(arguments.inspect.given, configurations_of(compared), drawn.inspections);
  else
    tell_unused(arguments.inspect.given, *drawn.inspections.front());
  for (const std::string& failure : drawn.failures) fmt::print(stderr, "{}\n", failure);
  return drawn;
}

cv::Mat read_baseline(const fs::path& file) {
  cv::Mat image = cv::imread(file.string(), cv::IMREAD_COLOR);
  if (image.empty()) {
    throw InputError(
        fmt::format("--baseline: {} is not a picture that can be read", file.string()));
  }
  return image;
}

/// Where the picture and the baseline are drawn as they differ.
fs::path difference_file(const SnapshotArguments& arguments) {
  return fs::path(arguments.output).replace_extension(".diff.png");
}

int tell_other_size(const cv::Mat& image,
                    const cv::Mat& baseline,
                    const SnapshotArguments& arguments) {
  fmt::print("differs from {}: the baseline is {}x{}, the picture {}x{}; see {}\n",
             arguments.baseline->string(),
             baseline.cols,
             baseline.rows,
             image.cols,
             image.rows,
             arguments.output.string());
  return kFailed;
}

int compare(const cv::Mat& image, const cv::Mat& baseline, const SnapshotArguments& arguments) {
  if (image.size() != baseline.size()) return tell_other_size(image, baseline, arguments);
  const ImageComparison comparison = compare_images(image, baseline, arguments.tolerance);
  fmt::print("pixels that differ by more than");
  for (std::size_t k = 0; k < ImageComparison::kSweep.size(); ++k) {
    fmt::print(" {}: {}{}", ImageComparison::kSweep[k], comparison.beyond[k], k < 3 ? "," : "\n");
  }
  if (comparison.equal) return kDone;
  write_image(difference_file(arguments), comparison.difference);
  fmt::print("differs from {}: {}; see {} and {}\n",
             arguments.baseline->string(),
             comparison.reason,
             arguments.output.string(),
             difference_file(arguments).string());
  return kFailed;
}

/// Before the work: what is written must be writable, and must not be what is read.
void check_files(const SnapshotArguments& arguments) {
  const std::array read{NamedFile{"--baseline", arguments.baseline},
                        NamedFile{"--tracks", arguments.inspect.tracks},
                        NamedFile{"recording", arguments.inspect.recording}};
  check_outputs(std::array{NamedFile{"--output", arguments.output}}, read);
  if (arguments.baseline)
    check_outputs(std::array{NamedFile{"--output's .diff.png", difference_file(arguments)}}, read);
}

/// Without a script: one view of one recording.
void check_required(const SnapshotArguments& arguments) {
  if (arguments.inspect.recording.empty()) throw InputError("recording is required");
  if (arguments.view.empty()) throw InputError("--view is required");
  if (arguments.output.empty()) throw InputError("--output is required");
}

}  // namespace

int snapshot_command(const SnapshotArguments& arguments, OwnMethods& own) {
  const auto size =
      arguments.size ? std::optional(image_size(*arguments.size, "--size")) : std::nullopt;
  if (arguments.script)
    return script_command(
        *arguments.script, arguments.inspect, size.value_or(cv::Size(1280, 720)), own);
  check_required(arguments);
  if (arguments.output.extension() != ".png") {
    throw InputError(fmt::format("--output: '{}', expected a file name that ends in .png",
                                 arguments.output.string()));
  }
  check_files(arguments);
  const cv::Mat baseline = arguments.baseline ? read_baseline(*arguments.baseline) : cv::Mat();
  tell_unused_by_view(arguments);
  const DrawnView drawn = draw(arguments, size, own.table);
  const cv::Mat& image = drawn.image;
  make_folder(folder_of(fs::absolute(arguments.output)));
  write_image(arguments.output, image);
  if (!drawn.ok) return kFailed;
  fmt::print("{}: {}x{}\n", arguments.output.string(), image.cols, image.rows);
  return arguments.baseline ? compare(image, baseline, arguments) : kDone;
}

}  // namespace gpo
