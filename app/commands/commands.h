// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "app/methods/method_commands.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/report/camera_path.h"
#include "engine/inspection/settings/settings.h"
#include "engine/recording/bags/messages.h"
#include "engine/recording/layouts/write_recording.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

namespace gpo {

/// Exit codes of the contract.
inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;    ///< no initialization, no calibration, or a picture differs
inline constexpr int kBadInput = 2;  ///< bad input or usage

/// Decoded pictures that are kept [MiB].
inline constexpr std::size_t kDefaultCacheMib = FrameCache::kDefaultByteLimit >> 20;

/// What `run` and `snapshot` inspect.
struct InspectArguments {
  std::filesystem::path recording;
  std::optional<std::filesystem::path> tracks;
  TopicChoices topics;  ///< of a bag
  std::size_t cache_mib = kDefaultCacheMib;
  std::string calibrate = "off";  ///< auto: what nobody calibrated, from a plane in view
  Settings settings;
  std::vector<std::string> given;  ///< keys of the settings that the command line names
};

/// Opens, says once what is missing (on standard error). Throws InputError.
std::shared_ptr<const Recording> open(const InspectArguments& arguments);
/// Opens it and inspects. Throws InputError.
std::shared_ptr<const Inspection> inspect(const InspectArguments& arguments);

struct InfoArguments {
  std::filesystem::path recording;
  bool wants_json = false;
  std::filesystem::path json;  ///< file to write; empty or "-": standard output
  TopicChoices topics;         ///< of a bag
};

struct RunArguments {
  InspectArguments inspect;
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> trajectory;
  std::optional<std::filesystem::path> true_trajectory;
  std::optional<TrajectoryFormat> trajectory_format;  ///< of both; default: tum
  std::optional<std::filesystem::path> points;
  bool metric = false;  ///< trajectory and points in meters
  std::optional<std::filesystem::path> tracks_out;
  std::optional<std::filesystem::path> scan;  ///< .csv of windows all over the recording, instead
  std::optional<int> scan_step;               ///< [frames]; default: about a hundred starts
};

struct SnapshotArguments {
  InspectArguments inspect;
  std::optional<std::filesystem::path> script;  ///< commands of the window, instead of one view
  std::string view;                 ///< image | scene | normals | compare | curves | window
  std::filesystem::path output;     ///< .png
  std::optional<int> frame;         ///< counts in the recording; default: the window's last
  std::optional<std::string> size;  ///< "WxH" [px]
  std::optional<std::filesystem::path> baseline;
  int tolerance = 3;  ///< largest difference of a color channel that counts as equal
  std::optional<std::string> methods;  ///< of compare and curves, as `evaluate` reads them
  std::optional<std::string> lengths;  ///< of curves, as `evaluate` reads them
};

struct EvaluateArguments {
  std::vector<std::filesystem::path> recordings;
  TopicChoices topics;  ///< of bags
  std::string methods = "all";
  std::string lengths = "5:60:5";            ///< of the windows [frames]
  std::string starts = "0:end:10";           ///< of the windows
  int jobs = 1;                              ///< windows of so many starts are computed at once
  int timing_jobs = 1;                       ///< the same for those whose running times are told
  std::size_t cache_mib = kDefaultCacheMib;  ///< of all recordings that are in work
  std::uint64_t seed = 1;                    ///< of every random choice
  std::optional<std::string> shard;          ///< "K/N"
  std::vector<std::filesystem::path> merge;  ///< folders of shards, instead of recordings
  std::optional<std::string> figure_width;   ///< "85mm": of figures for print
  std::filesystem::path output;              ///< folder
};

struct ViewArguments {
  std::optional<std::filesystem::path> recording;
  TopicChoices topics;  ///< of the recording, if it is a bag
  std::size_t cache_mib = kDefaultCacheMib;
  std::string calibrate = "off";  ///< auto: what nobody calibrated, from a plane in view
  Settings settings;
  std::vector<std::string> given;  ///< keys of the settings that the command line names
  std::optional<std::filesystem::path> session;
  std::optional<std::filesystem::path> script;
};

struct CalibrateArguments {
  std::filesystem::path recording;   ///< needs no calibration
  TopicChoices topics;               ///< of a bag
  std::string from = "board";        ///< or "plane": of any plane in view
  std::optional<std::string> board;  ///< "CxR" inner corners, of a ChArUco board squares; default:
                                     ///< the recording's board.yaml
  std::optional<std::string> pattern;     ///< "chessboard" (the default) or "charuco"
  std::optional<double> square;           ///< [m]
  std::optional<double> marker;           ///< [m]
  std::optional<std::string> dictionary;  ///< OpenCV's name
  std::string model = "radial-tangential";
  int coefficients = 4;
  bool gyroscope = false;  ///< calibrates the gyroscope against the camera instead
  std::optional<std::filesystem::path> figure;  ///< .png of the gyroscope's rates
  std::filesystem::path output;                 ///< camera.yaml
};

struct ConvertArguments {
  std::filesystem::path recording;
  TopicChoices topics;  ///< of a bag
  RecordingFormat format = RecordingFormat::euroc;
  std::filesystem::path output;  ///< folder, or of a bag the file
};

int calibrate_command(const CalibrateArguments& arguments);
int calibrate_gyroscope_command(const CalibrateArguments& arguments);
int convert_command(const ConvertArguments& arguments);
int evaluate_command(const EvaluateArguments& arguments, const MethodTable& methods);
int info_command(const InfoArguments& arguments);
int run_command(const RunArguments& arguments);
/// Initializes from everywhere in the recording and writes what came of it; kFailed where nothing
/// did.
int scan_command(const InspectArguments& arguments,
                 const std::filesystem::path& file,
                 std::optional<int> wanted_step);
int snapshot_command(const SnapshotArguments& arguments, OwnMethods& own);
/// Runs the window's commands off-screen; `size`: of the window.
int script_command(const std::filesystem::path& script,
                   const InspectArguments& arguments,
                   cv::Size size,
                   OwnMethods& own);
int synthesize_command(const std::filesystem::path& recipe, const std::filesystem::path& output);
int view_command(const ViewArguments& arguments, OwnMethods& own);

}  // namespace gpo
