// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.h"
#include "app/comparison.h"
#include "app/output.h"
#include "app/setting_options.h"
#include "engine/base/error.h"
#include "engine/experiment/configuration.h"
#include "engine/files/folder.h"
#include "engine/files/output_file.h"
#include "ui/views/charts/figure_view.h"
#include "ui/views/picture_compare.h"
#include "ui/views/snapshot.h"
#include "ui/workbench/session/picture_size.h"
#include "ui/workbench_window.h"

#include <array>
#include <cstdio>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// A picture, and whether what it shows could be computed.
struct Drawn {
  cv::Mat picture;
  bool ok = false;  ///< of several: at least one
};

void tell_failure(const std::string& what, const std::string& reason) {
  fmt::print(stderr, "{}: initialization failed: {}\n", what, reason);
}

/// The frame that is asked for, or the window's last.
int frame_to_draw(const SnapshotArguments& arguments, const Recording& recording) {
  const Settings& settings = arguments.inspect.settings;
  const int frame = arguments.frame.value_or(settings.start + settings.frames - 1);
  if (frame < 0 || frame >= recording.frame_count()) {
    throw InputError(fmt::format("--frame: {} is not in the recording, which has frames 0 to {}",
                                 frame,
                                 recording.frame_count() - 1));
  }
  return frame;
}

ComparisonRequest request_of(const SnapshotArguments& arguments) {
  return {arguments.methods, arguments.lengths, arguments.inspect.settings};
}

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

Drawn draw_compare(const SnapshotArguments& arguments, const std::optional<cv::Size>& size) {
  const auto recording = open(arguments.inspect);
  const ComparisonRequest request = request_of(arguments);
  const auto inspections = inspect_each(recording, request);
  tell_unused(arguments.inspect.given, configurations_of(request), inspections);
  const int frame = frame_to_draw(arguments, *recording);
  Drawn drawn{snapshot_compare(inspections, frame, size)};
  for (const auto& inspection : inspections) {
    const Initialization& result = *inspection->initialization;
    drawn.ok |= result.ok;
    if (!result.ok) tell_failure(key_of(configuration_of(inspection->settings)), result.reason);
  }
  return drawn;
}

Drawn draw_curves(const SnapshotArguments& arguments, const std::optional<cv::Size>& size) {
  const ComparisonRequest request = request_of(arguments);
  const LengthCurves curves = curves_over_length(open(arguments.inspect), request);
  tell_unused(arguments.inspect.given, configurations_of(request), curves.longest);
  for (const std::string& failure : curves.failures) fmt::print(stderr, "{}\n", failure);
  const cv::Size pixels = size.value_or(default_figure_size(curves.figure));
  return {draw_figure(curves.figure, pixels), curves.any_ok};
}

Drawn draw_one(const SnapshotArguments& arguments, const std::optional<cv::Size>& size) {
  const auto inspection = inspect(arguments.inspect);
  tell_unused(arguments.inspect.given, *inspection);
  const int frame = frame_to_draw(arguments, *inspection->recording);
  const Initialization& result = *inspection->initialization;
  if (!result.ok) tell_failure(inspection->settings.method, result.reason);
  if (arguments.view == "image") return {snapshot_image(*inspection, frame, size), result.ok};
  if (arguments.view == "scene")
    return {snapshot_scene(*inspection, frame, size.value_or(cv::Size(960, 720))), result.ok};
  if (arguments.view == "normals")
    return {snapshot_normals(inspection, frame, size.value_or(cv::Size(720, 760))), result.ok};
  return {snapshot_window(inspection, frame, size.value_or(cv::Size(1280, 720))), result.ok};
}

Drawn draw(const SnapshotArguments& arguments, const std::optional<cv::Size>& size) {
  if (arguments.view == "compare") return draw_compare(arguments, size);
  if (arguments.view == "curves") return draw_curves(arguments, size);
  return draw_one(arguments, size);
}

cv::Mat read_baseline(const fs::path& file) {
  cv::Mat picture = cv::imread(file.string(), cv::IMREAD_COLOR);
  if (picture.empty()) {
    throw InputError(
        fmt::format("--baseline: {} is not a picture that can be read", file.string()));
  }
  return picture;
}

/// Where the picture and the baseline are drawn as they differ.
fs::path difference_file(const SnapshotArguments& arguments) {
  return fs::path(arguments.output).replace_extension(".diff.png");
}

int tell_other_size(const cv::Mat& picture,
                    const cv::Mat& baseline,
                    const SnapshotArguments& arguments) {
  fmt::print("differs from {}: the baseline is {}x{}, the picture {}x{}; see {}\n",
             arguments.baseline->string(),
             baseline.cols,
             baseline.rows,
             picture.cols,
             picture.rows,
             arguments.output.string());
  return kFailed;
}

int compare(const cv::Mat& picture, const cv::Mat& baseline, const SnapshotArguments& arguments) {
  if (picture.size() != baseline.size()) return tell_other_size(picture, baseline, arguments);
  const PictureComparison comparison = compare_pictures(picture, baseline, arguments.tolerance);
  fmt::print("pixels that differ by more than");
  for (std::size_t k = 0; k < PictureComparison::kSweep.size(); ++k) {
    fmt::print(" {}: {}{}", PictureComparison::kSweep[k], comparison.beyond[k], k < 3 ? "," : "\n");
  }
  if (comparison.equal) return kDone;
  write_picture(difference_file(arguments), comparison.difference);
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

int snapshot_command(const SnapshotArguments& arguments, const OwnMethods& own) {
  const auto size =
      arguments.size ? std::optional(picture_size(*arguments.size, "--size")) : std::nullopt;
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
  const auto [picture, ok] = draw(arguments, size);
  make_folder(folder_of(fs::absolute(arguments.output)));
  write_picture(arguments.output, picture);
  if (!ok) return kFailed;
  fmt::print("{}: {}x{}\n", arguments.output.string(), picture.cols, picture.rows);
  return arguments.baseline ? compare(picture, baseline, arguments) : kDone;
}

}  // namespace gpo
