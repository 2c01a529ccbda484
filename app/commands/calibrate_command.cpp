// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "engine/base/error.h"
#include "engine/calibration/calibrate.h"
#include "engine/calibration/calibration_report.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "engine/recording/board/board.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/rotations/gyroscope_check.h"
#include "ui/views/charts/charts.h"

#include <cstdio>

namespace gpo {
namespace {

struct CalibrateArguments {
  fs::path recording, output;
  TopicChoices topics;
  std::string from = "board", model = "radial-tangential";
  std::optional<std::string> board, pattern, dictionary;
  std::vector<std::string> board_details;  ///< the given options for a board, without --board
  std::optional<double> square, marker;
  int coefficients = 4;
  bool gyroscope = false;
  std::optional<fs::path> figure;
};

constexpr std::size_t kCacheBytes = std::size_t{64} << 20;  // each frame is decoded only once

double required_length(const std::optional<double>& length, const char* option) {
  if (!length) throw InputError(fmt::format("{} is required with --board", option));
  if (*length > 0) return *length;
  throw InputError(fmt::format("{}: {:g}, expected a length in meters, > 0", option, *length));
}

/// Returns the corners of a chessboard or the squares of a ChArUco board.
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
  if (markers.side_m >= board.square_m)
    throw InputError(fmt::format("--marker: {:g}, expected less than the square's side, {:g}",
                                 markers.side_m,
                                 board.square_m));
  const std::string given = arguments.dictionary.value_or("");
  const auto name = dictionary_name(given);
  if (!name)
    throw InputError(
        fmt::format("--dictionary: '{}', expected one of {}", given, dictionary_names()));
  markers.dictionary = *name;
  if (marker_count(board) > dictionary_size(*name))
    throw InputError(fmt::format("--dictionary: {} has {} markers, the board needs {}",
                                 *name,
                                 dictionary_size(*name),
                                 marker_count(board)));
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

fs::path folder_of_images(const fs::path& recording) {
  return fs::is_directory(recording) ? recording : recording.parent_path();
}

Board board_of(const CalibrateArguments& arguments, const fs::path& recording) {
  if (arguments.board) return board_of_options(arguments);
  const fs::path folder = folder_of_images(recording);
  for (const fs::path& base : {folder, folder / "mav0"}) {
    const fs::path file = base / "board.yaml";
    if (!fs::exists(file)) continue;
    if (const auto& details = arguments.board_details; !details.empty())
      fmt::print(stderr,
                 "{}: not used, {} describes the board; add --board to describe another one\n",
                 fmt::join(details, ", "),
                 file.string());
    return read_board(file);
  }
  throw InputError(
      fmt::format("--board is required: there is no {}", (folder / "board.yaml").string()));
}

/// The camera does not depend on the unit of length, but a wrong one is a mistake worth a note.
void warn_of_large_square(double side_m) {
  constexpr double kLargest_m = 1;
  if (side_m < kLargest_m) return;
  fmt::print(
      stderr,
      "a square of {0:g} m is unusually large: lengths are in meters, and {0:g} mm are {1:g} m\n",
      side_m,
      side_m / 1000);
}

CalibrationOptions options_of(const CalibrateArguments& arguments) {
  CalibrationOptions options{.coefficients = arguments.coefficients};
  if (arguments.model != "equidistant") return options;
  options.distortion = Distortion::equidistant;
  if (arguments.coefficients != 4)
    throw InputError(fmt::format("--coefficients: {}, expected 4 with --model equidistant",
                                 arguments.coefficients));
  return options;
}

void refuse_board_options(const CalibrateArguments& arguments) {
  auto given = arguments.board_details;
  if (arguments.board) given.insert(given.begin(), "--board");
  if (arguments.model != "radial-tangential" || arguments.coefficients != 4)
    given.emplace_back("--model, --coefficients");
  if (!given.empty())
    throw InputError(fmt::format("{}: not used with --from plane", given.front()));
}

int report_failure(const std::string& reason) {
  fmt::print("calibration failed: {}\n", reason);
  return kFailed;
}

/// With its own camera.yaml as output, the recording's camera is only compared.
void check_not_of(const Recording& recording, const CalibrateArguments& arguments) {
  check_not_overwritten(recording, {{"--figure", arguments.figure}});
  if (arguments.output.filename() != "camera.yaml")
    check_not_overwritten(recording, {{"--output", arguments.output}});
}

/// Writes a camera.yaml, but not over that of the recording.
int write_camera(const CalibrateArguments& arguments,
                 const Recording* recording,
                 const std::string& yaml) {
  if (recording == nullptr || !is_read_from(*recording, arguments.output))
    write_output(arguments.output, yaml);
  else
    fmt::print("{} is not replaced; choose another --output to write the new one\n",
               arguments.output.string());
  return kDone;
}

template <class Calibration>
int report(const CalibrateArguments& arguments,
           const Recording* recording,
           const Calibration& calibration) {
  fmt::print("{}", to_text(calibration));
  if (recording != nullptr && recording->camera_source != CameraSource::guess)
    fmt::print("{}", comparison_text(calibration.camera, recording->camera));
  return write_camera(
      arguments, recording, to_yaml(calibration, arguments.recording.filename().string()));
}

int calibrate_by_plane(const CalibrateArguments& arguments, const fs::path& recording) {
  refuse_board_options(arguments);
  const auto opened = open_recording(recording, {.tracks = {}, .cache_bytes = kCacheBytes});
  if (!opened->images)
    throw InputError(recording.string() + ": has no images, expected a video or images");
  check_not_of(*opened, arguments);
  const PlaneLens calibration = self_calibrate(*opened);
  if (!calibration.ok) return report_failure(calibration.reason);
  return report(arguments, opened.get(), calibration);
}

/// Returns null if the recording cannot be opened, for example because its calibration is of
/// another size.
std::shared_ptr<const Recording> opened_or_null(const CalibrateArguments& arguments,
                                                const fs::path& recording) {
  try {
    return open_recording(recording, {.tracks = {}, .topics = arguments.topics});
  } catch (const InputError&) {
    return nullptr;
  }
}

/// Throws InputError if the output exists beside images that cannot be opened with it.
void check_new(const fs::path& output, const fs::path& folder) {
  std::error_code none;
  if (fs::exists(output, none) && fs::equivalent(folder_of(output), folder, none))
    throw InputError(fmt::format(
        "{}: does not fit the images; remove it, or choose another --output", output.string()));
}

int calibrate_by_board(const CalibrateArguments& arguments, const fs::path& recording) {
  constexpr int kMaxFrames = 600;
  CalibrationOptions options = options_of(arguments);
  const Board board = board_of(arguments, recording);
  warn_of_large_square(board.square_m);
  const auto images = open_images(recording, kCacheBytes, arguments.topics);
  std::vector<std::int64_t> times_ns;
  const auto opened = opened_or_null(arguments, recording);
  if (!opened) check_new(arguments.output, folder_of_images(recording));
  if (opened) {
    check_not_of(*opened, arguments);
    times_ns = opened->timestamps_ns;
    options.readout = opened->camera.readout;
    options.readout_direction = opened->camera.readout_direction;
  }
  ProgressBar bar("looking for the board");
  const auto search = find_calibration_views(*images, board, kMaxFrames, std::ref(bar), times_ns);
  const CameraCalibration calibration = calibrate_camera(search, board, options);
  if (!calibration.ok) return report_failure(calibration.reason);
  return report(arguments, opened.get(), calibration);
}

void write_rate_figure(const fs::path& file,
                       const std::vector<ImageRotations>& windows,
                       const Recording& recording,
                       const GyroscopeFit& fit) {
  const Figure figure{
      .name = "gyroscope",
      .title = fmt::format("{}: angular rates in the camera's axes", recording.name),
      .charts = gyroscope_charts(windows, *recording.gyroscope, fit),
      .note = fmt::format("clock {:+.2f} +- {:.2f} ms, rotation +- {:.2f} deg, residual {:.2f} deg",
                          1e3 * fit.time_offset_s,
                          1e3 * fit.time_offset_sigma_s,
                          fit.rotation_sigma_deg.maxCoeff(),
                          fit.rms_deg)};
  write_image(file, draw_figure(figure, default_figure_size(figure)));
}

/// Returns the camera in the gyroscope's axes [m]; zero if it is unknown.
Eigen::Vector3d lever_arm_m(const Recording& recording) {
  const auto& T = recording.T_body_camera;
  if (!T) return Eigen::Vector3d::Zero();
  return recording.gyroscope->R_gyro_camera * T->R_wc.transpose() * T->p_wc;
}

int calibrate_gyroscope(const CalibrateArguments& arguments, const fs::path& path) {
  if (arguments.coefficients != 4) throw InputError("--coefficients: not used with --gyroscope");
  InspectArguments opened;
  opened.recording = path;
  const auto recording = open(opened);
  if (!recording->gyroscope) throw InputError(recording->name + " has no gyroscope");
  check_not_of(*recording, arguments);
  constexpr int kWindows = 80;
  ProgressBar bar("rotations from images");
  const auto windows = rotations_over_recording(recording, kWindows, std::ref(bar), current_stop());
  check_stop();
  if (const std::string why = why_wrong_rates(windows, *recording->gyroscope); !why.empty())
    return report_failure(why);
  GyroscopeFit fit = fit_gyroscope(windows, *recording->gyroscope);
  add_lens_error(fit, recording->camera);
  if (fit.windows > 0) {
    fmt::print("{}", to_text(fit, *recording->gyroscope));
    if (arguments.figure) write_rate_figure(*arguments.figure, windows, *recording, fit);
  }
  if (!fit.ok) return report_failure(fit.reason);
  return write_camera(arguments,
                      recording.get(),
                      to_yaml(fit, recording->camera, recording->name, lever_arm_m(*recording)));
}

int calibrate_as_requested(const CalibrateArguments& arguments) {
  if (arguments.figure && arguments.figure->extension() != ".png")
    throw InputError(fmt::format("--figure: '{}', expected a file name that ends in .png",
                                 arguments.figure->string()));
  check_outputs({{"--output", arguments.output}, {"--figure", arguments.figure}},
                {{"recording", arguments.recording}});
  const fs::path recording = resolve_recordings({arguments.recording}).front();
  if (arguments.gyroscope) return calibrate_gyroscope(arguments, recording);
  if (!fs::exists(recording))
    throw InputError(fmt::format("{}: no such file or folder", recording.string()));
  return arguments.from == "plane" ? calibrate_by_plane(arguments, recording)
                                   : calibrate_by_board(arguments, recording);
}

}  // namespace

RunCommand add_calibrate(CLI::App& app) {
  const auto to = std::make_shared<CalibrateArguments>();
  CLI::App& command = *app.add_subcommand(
      "calibrate",
      "Calibrates a camera from a video or images of a printed board or of a textured plane");
  command
      .add_option("recording",
                  to->recording,
                  "Video, folder of images, or any recording with images; needs no calibration")
      ->required();
  command
      .add_option("--from", to->from, "Calibrate from a printed board, or from any textured plane")
      ->capture_default_str()
      ->check(CLI::IsMember({"board", "plane"}));
  command.add_option("--board",
                     to->board,
                     "COLUMNSxROWS inner corners (ChArUco: squares), e.g. 9x6; default: "
                     "the recording's board.yaml");
  command.add_option("--square", to->square, "Side of a square [m]");
  command.add_option("--pattern", to->pattern, "Printed pattern; default: chessboard")
      ->check(CLI::IsMember({"chessboard", "charuco"}));
  command.add_option("--marker", to->marker, "Side of a marker of a ChArUco board [m]");
  command.add_option("--dictionary",
                     to->dictionary,
                     "OpenCV's name of a ChArUco board's dictionary, e.g. DICT_5X5_100");
  command.add_option("--model", to->model, "Lens model")
      ->capture_default_str()
      ->check(CLI::IsMember({"radial-tangential", "equidistant"}));
  command
      .add_option("--coefficients",
                  to->coefficients,
                  "Number of coefficients of the radial-tangential model: 4 (k1 k2 p1 p2), 5 or 8")
      ->capture_default_str()
      ->check(CLI::IsMember({4, 5, 8}));
  CLI::Option* gyroscope = command.add_flag(
      "--gyroscope",
      to->gyroscope,
      "Calibrate orientation, clock and bias of the gyroscope instead, from image rotations");
  for (const char* lens_option :
       {"--from", "--board", "--square", "--pattern", "--marker", "--dictionary", "--model"})
    gyroscope->excludes(command.get_option(lens_option));
  command.add_option("--figure", to->figure, "Plot the angular rates before and after (.png)")
      ->needs(gyroscope);
  add_topics(command, to->topics);
  command
      .add_option("--output",
                  to->output,
                  "camera.yaml to write; that of the recording is compared, not replaced")
      ->required();
  command.callback([&command, to] {
    for (const char* name : {"--square", "--pattern", "--marker", "--dictionary"})
      if (command.count(name) > 0) to->board_details.emplace_back(name);
  });
  return
      [to](OwnMethods& /*own*/, Interrupt& /*interrupt*/) { return calibrate_as_requested(*to); };
}

}  // namespace gpo
