// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/recordings/recordings.h"
#include "app/terminal/output.h"
#include "app/terminal/progress_bar.h"
#include "engine/base/error.h"
#include "engine/calibration/calibrate.h"
#include "engine/calibration/calibration_report.h"
#include "engine/calibration/self_calibration.h"
#include "engine/files/text_file.h"
#include "engine/recording/board/board.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/layouts/open_recording.h"

#include <array>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

constexpr int kMostFrames = 600;
constexpr std::size_t kCacheBytes = std::size_t{64} << 20;  // each picture is looked at once

double required_length(const std::optional<double>& length, const char* option) {
  if (!length) throw InputError(fmt::format("{} is required with --board", option));
  if (*length > 0) return *length;
  throw InputError(fmt::format("{}: {:g}, expected a length in meters, > 0", option, *length));
}

/// Corners of a chessboard, squares of a ChArUco board.
cv::Size board_counts(const std::string& text, bool charuco) {
  const auto good = [](int count) { return count >= 3 && count <= 100; };
  const auto counts = parse_size(text);
  if (counts && good(counts->first) && good(counts->second)) return {counts->first, counts->second};
  throw InputError(fmt::format("--board: '{}', expected COLUMNSxROWS of {}, 3 to 100 each, e.g. {}",
                               text,
                               charuco ? "squares" : "inner corners",
                               charuco ? "8x6" : "9x6"));
}

BoardMarkers markers_of(const CalibrateArguments& arguments, const Board& board) {
  BoardMarkers markers{required_length(arguments.marker, "--marker"), ""};
  if (markers.side_m >= board.square_m) {
    throw InputError(fmt::format("--marker: {:g}, expected less than the square's side, {:g}",
                                 markers.side_m,
                                 board.square_m));
  }
  const auto name = dictionary_name(arguments.dictionary.value_or(""));
  if (!name) {
    throw InputError(fmt::format("--dictionary: '{}', expected one of {}",
                                 arguments.dictionary.value_or(""),
                                 dictionary_names()));
  }
  markers.dictionary = *name;
  if (marker_count(board) > dictionary_size(*name)) {
    throw InputError(
        fmt::format("--dictionary: {} has {} markers, expected {}, as many as the board",
                    *name,
                    dictionary_size(*name),
                    marker_count(board)));
  }
  return markers;
}

Board board_of_options(const CalibrateArguments& arguments) {
  const bool charuco = arguments.pattern.value_or("chessboard") == "charuco";
  const cv::Size counts = board_counts(*arguments.board, charuco);
  const double square = required_length(arguments.square, "--square");
  if (!charuco) return {counts.width, counts.height, square};
  Board board{counts.width - 1, counts.height - 1, square};
  board.markers = markers_of(arguments, board);
  return board;
}

/// Beside a board.yaml what describes another board is not read unless `--board` is there, too.
void tell_unused_options(const CalibrateArguments& arguments, const fs::path& board_file) {
  std::vector<std::string> unused;
  if (arguments.square) unused.emplace_back("--square");
  if (arguments.pattern) unused.emplace_back("--pattern");
  if (arguments.marker) unused.emplace_back("--marker");
  if (arguments.dictionary) unused.emplace_back("--dictionary");
  if (unused.empty()) return;
  fmt::print(stderr,
             "{}: not used, the board is that of {}; --board describes another one\n",
             fmt::join(unused, ", "),
             board_file.string());
}

/// The options', else that of the recording's board.yaml.
Board board_of(const CalibrateArguments& arguments, const fs::path& recording) {
  if (arguments.board) return board_of_options(arguments);
  const fs::path folder = fs::is_directory(recording) ? recording : recording.parent_path();
  for (const fs::path& base : {folder, folder / "mav0"}) {
    const fs::path file = base / "board.yaml";
    if (!fs::exists(file)) continue;
    tell_unused_options(arguments, file);
    return read_board(file);
  }
  throw InputError(
      fmt::format("--board is required: there is no {}", (folder / "board.yaml").string()));
}

/// The camera does not depend on the unit, but who takes the wrong one will want to know.
void question_square(double side_m) {
  constexpr double kLargest_m = 1;
  if (side_m < kLargest_m) return;
  fmt::print(
      stderr,
      "a square of {0:g} m: are these millimeters? Lengths are in meters ({0:g} mm are {1:g})\n",
      side_m,
      side_m / 1000);
}

CalibrationOptions options_of(const CalibrateArguments& arguments) {
  CalibrationOptions options;
  options.coefficients = arguments.coefficients;
  if (arguments.model == "equidistant") {
    options.distortion = Distortion::equidistant;
    if (arguments.coefficients != 4) {
      throw InputError(fmt::format("--coefficients: {}, expected 4 with --model equidistant",
                                   arguments.coefficients));
    }
  }
  return options;
}

/// What describes a board says nothing of a plane.
void refuse_board_options(const CalibrateArguments& arguments) {
  const std::array<std::pair<bool, const char*>, 6> given{
      {{arguments.board.has_value(), "--board"},
       {arguments.square.has_value(), "--square"},
       {arguments.pattern.has_value(), "--pattern"},
       {arguments.marker.has_value(), "--marker"},
       {arguments.dictionary.has_value(), "--dictionary"},
       {arguments.model != "radial-tangential" || arguments.coefficients != 4,
        "--model, --coefficients"}}};
  for (const auto& [is_given, name] : given)
    if (is_given) throw InputError(fmt::format("{}: not used with --from plane", name));
}

int calibrate_by_plane(const CalibrateArguments& arguments, const fs::path& recording) {
  refuse_board_options(arguments);
  const auto opened = open_recording(recording, {.tracks = {}, .cache_bytes = kCacheBytes});
  if (!opened->images)
    throw InputError(recording.string() + ": found no pictures, expected a video or pictures");
  const SelfCalibration calibration = self_calibrate(*opened);
  if (!calibration.lens.ok) {
    fmt::print("calibration failed: {}\n", calibration.lens.reason);
    return kFailed;
  }
  fmt::print("{}", to_text(calibration));
  write_output(arguments.output, to_yaml(calibration, arguments.recording.filename().string()));
  return kDone;
}

}  // namespace

int calibrate_command(const CalibrateArguments& arguments) {
  check_outputs(std::array{NamedFile{"--output", arguments.output}},
                std::array{NamedFile{"recording", arguments.recording}});
  const fs::path recording = resolve_recordings({arguments.recording}).front();
  if (!fs::exists(recording)) {
    throw InputError(fmt::format("{}: no such file or folder", recording.string()));
  }
  if (arguments.from == "plane") return calibrate_by_plane(arguments, recording);
  const CalibrationOptions options = options_of(arguments);
  const Board board = board_of(arguments, recording);
  question_square(board.square_m);
  const auto images = open_images(recording, kCacheBytes, arguments.topics);
  ProgressBar bar("looking for the board");
  const BoardSearch search = find_calibration_views(
      *images, board, kMostFrames, [&](int done, int of) { bar.show(done, of); });
  const CameraCalibration calibration = calibrate_camera(search, board, options);
  if (!calibration.ok) {
    fmt::print("calibration failed: {}\n", calibration.reason);
    return kFailed;
  }
  fmt::print("{}", to_text(calibration));
  write_output(arguments.output, to_yaml(calibration, arguments.recording.filename().string()));
  return kDone;
}

}  // namespace gpo
