// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.h"
#include "app/progress_bar.h"
#include "app/recordings.h"
#include "engine/base/error.h"
#include "engine/calibration/calibrate.h"
#include "engine/calibration/calibration_report.h"
#include "engine/files/output_file.h"
#include "engine/recording/board/charuco.h"
#include "engine/recording/layouts/pictures_reader.h"
#include "engine/recording/layouts/sidecar_files.h"

#include <cstdio>

#include <fmt/format.h>

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
  cv::Size counts;
  char rest = 0;
  const int read = std::sscanf(text.c_str(), "%dx%d%c", &counts.width, &counts.height, &rest);
  const auto good = [](int count) { return count >= 3 && count <= 100; };
  if (read == 2 && good(counts.width) && good(counts.height)) return counts;
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
  const bool charuco = arguments.pattern == "charuco";
  const cv::Size counts = board_counts(*arguments.board, charuco);
  const double square = required_length(arguments.square, "--square");
  if (!charuco) return {counts.width, counts.height, square};
  Board board{counts.width - 1, counts.height - 1, square};
  board.markers = markers_of(arguments, board);
  return board;
}

/// The options', else that of the recording's board.yaml.
Board board_of(const CalibrateArguments& arguments, const fs::path& recording) {
  if (arguments.board) return board_of_options(arguments);
  const fs::path folder = fs::is_directory(recording) ? recording : recording.parent_path();
  for (const fs::path& base : {folder, folder / "mav0"}) {
    if (fs::exists(base / "board.yaml")) return read_board(base / "board.yaml");
  }
  throw InputError(
      fmt::format("--board is required: there is no {}", (folder / "board.yaml").string()));
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

}  // namespace

int calibrate_command(const CalibrateArguments& arguments) {
  check_writable(arguments.output);
  const CalibrationOptions options = options_of(arguments);
  const fs::path recording = resolve_recordings({arguments.recording}).front();
  if (!fs::exists(recording)) {
    throw InputError(fmt::format("{}: no such file or folder", recording.string()));
  }
  const Board board = board_of(arguments, recording);
  const auto pictures = open_pictures(recording, kCacheBytes);
  ProgressBar bar("looking for the board");
  const BoardSearch search = find_calibration_views(
      *pictures, board, kMostFrames, [&](int done, int of) { bar.show(done, of); });
  const CameraCalibration calibration = calibrate_camera(search, board, options);
  if (!calibration.ok) {
    fmt::print("calibration failed: {}\n", calibration.reason);
    return kFailed;
  }
  fmt::print("{}", to_text(calibration));
  write_file(arguments.output, to_yaml(calibration, arguments.recording.filename().string()));
  return kDone;
}

}  // namespace gpo
