// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "app/methods/method_commands.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/report/result.h"
#include "engine/inspection/settings/settings_table.h"
#include "engine/recording/bags/messages.h"
#include "engine/recording/layouts/write_recording.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

inline constexpr int kDone = 0;      ///< exit code
inline constexpr int kFailed = 1;    ///< no initialization, no calibration, or an image differs
inline constexpr int kBadInput = 2;  ///< bad input or usage

/// Runs one command line and returns its exit code. Prints errors on standard error.
int main_with_errors(int argc, char** argv);

/// Limit for the decoded frames that are cached [MiB].
inline constexpr std::size_t kDefaultCacheMib = FrameCache::kDefaultByteLimit >> 20;

/// The recording and settings of `run`, `snapshot` and `view`.
struct InspectArguments {
  std::filesystem::path recording;  ///< empty if none is given
  std::optional<std::filesystem::path> tracks;
  TopicChoices topics;  ///< for bags
  std::size_t cache_mib = kDefaultCacheMib;
  std::string calibrate = "off";  ///< auto: calibrates an uncalibrated camera from a plane in view
  Settings settings;
  std::vector<std::string> given;  ///< keys of the settings that the command line names
};

/// Opens the recording and prints its notes on standard error. Throws InputError.
std::shared_ptr<const Recording> open(const InspectArguments& arguments);

struct InfoArguments {
  std::filesystem::path recording;
  bool wants_json = false;
  std::filesystem::path json;  ///< output file; empty or "-": standard output
  TopicChoices topics;
};

struct RunArguments {
  InspectArguments inspect;
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> trajectory;
  std::optional<std::filesystem::path> true_trajectory;
  std::optional<TrajectoryFormat> trajectory_format;  ///< format of both; default: tum
  std::optional<std::filesystem::path> points;
  bool metric = false;  ///< trajectory and points in meters
  std::optional<std::filesystem::path> tracks_out;
  std::optional<std::filesystem::path> scan;  ///< .csv: initializes from every start instead
  std::optional<int> scan_step;               ///< [frames]; default: about 100 starts
};

struct SnapshotArguments {
  InspectArguments inspect;
  std::optional<std::filesystem::path> script;  ///< commands of the window, instead of one view
  std::string view;                             ///< a pane's key or its other name
  std::filesystem::path output;                 ///< .png
  std::optional<int> frame;         ///< frame of the recording; default: the window's last
  std::optional<std::string> size;  ///< "WxH" [px]
  std::optional<std::filesystem::path> baseline;
  int tolerance = 3;  ///< largest difference of a color channel that counts as equal
  std::optional<std::string> methods;  ///< for compare and curves, as in `evaluate`
  std::optional<std::string> lengths;  ///< for curves, as in `evaluate`
};

struct EvaluateArguments {
  std::vector<std::filesystem::path> recordings;
  TopicChoices topics;
  std::string methods = "all";
  std::string lengths = "5:60:5";   ///< window lengths [frames]
  std::string starts = "0:end:10";  ///< reference frames of the windows
  int jobs = 1;                     ///< starts that are computed at once
  int timing_jobs = 1;              ///< the same for windows whose running time is reported
  std::size_t cache_mib = kDefaultCacheMib;  ///< shared by all open recordings
  std::uint64_t seed = 1;
  std::optional<std::string> shard;          ///< "K/N"
  std::vector<std::filesystem::path> merge;  ///< folders of shards, instead of recordings
  std::optional<std::string> figure_width;   ///< for figures in print, e.g. "85mm"
  std::filesystem::path output;              ///< folder
};

struct ViewArguments {
  InspectArguments inspect;  ///< without tracks
  std::optional<std::filesystem::path> session;
  std::optional<std::filesystem::path> script;
};

struct CalibrateArguments {
  std::filesystem::path recording;  ///< needs no calibration
  TopicChoices topics;
  std::string from = "board";             ///< or "plane": any plane in view
  std::optional<std::string> board;       ///< "CxR" inner corners, or squares of a ChArUco board;
                                          ///< default: the recording's board.yaml
  std::optional<std::string> pattern;     ///< "chessboard" (the default) or "charuco"
  std::optional<double> square;           ///< [m]
  std::optional<double> marker;           ///< [m]
  std::optional<std::string> dictionary;  ///< OpenCV's name
  std::string model = "radial-tangential";
  int coefficients = 4;
  bool gyroscope = false;  ///< calibrates the gyroscope against the camera instead
  std::optional<std::filesystem::path> figure;  ///< .png of the angular rates
  std::filesystem::path output;                 ///< camera.yaml
};

struct ConvertArguments {
  std::filesystem::path recording;
  TopicChoices topics;
  RecordingFormat format = RecordingFormat::euroc;
  std::filesystem::path output;  ///< folder, or the file of a bag
};

int calibrate_command(const CalibrateArguments& arguments);
int convert_command(const ConvertArguments& arguments);
int evaluate_command(const EvaluateArguments& arguments, const MethodTable& methods);
int info_command(const InfoArguments& arguments);
int run_command(const RunArguments& arguments);
int snapshot_command(const SnapshotArguments& arguments, OwnMethods& own);
int synthesize_command(const std::filesystem::path& recipe, const std::filesystem::path& output);
int view_command(const ViewArguments& arguments, OwnMethods& own);

}  // namespace gpo
