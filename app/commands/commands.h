// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "app/methods/method_commands.h"
#include "app/recordings/recordings.h"
#include "app/terminal/terminal.h"
#include "engine/base/chart.h"
#include "engine/base/choice.h"
#include "engine/experiment/experiment.h"
#include "engine/experiment/row.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/settings/settings_table.h"
#include "engine/recording/bags/messages.h"
#include "engine/recording/layouts/write_recording.h"

#include <cstddef>
#include <optional>
#include <span>
#include <stop_token>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core/mat.hpp>

namespace gpo {

inline constexpr int kDone = 0;      ///< exit code
inline constexpr int kFailed = 1;    ///< no initialization, no calibration, or an image differs
inline constexpr int kBadInput = 2;  ///< bad input or usage

/// Runs a command whose options are parsed. Returns its exit code.
using RunCommand = std::function<int(OwnMethods& own, Interrupt& interrupt)>;

struct CommandRow {
  const char* name;
  RunCommand (*add)(CLI::App& app);
  bool has_methods = false;  ///< has the options of the user's own methods
};

/// All commands, in the order of --help; "view" is the default. Links the libraries that draw.
std::span<const CommandRow> all_commands();

/// Runs one command line and returns its exit code. Prints errors on standard error.
int main_with_errors(int argc, char** argv, std::span<const CommandRow> rows);

RunCommand add_calibrate(CLI::App& app);
RunCommand add_convert(CLI::App& app);
RunCommand add_evaluate(CLI::App& app);
RunCommand add_findings(CLI::App& app);
RunCommand add_info(CLI::App& app);
RunCommand add_pages(CLI::App& app);  ///< for packagers, not listed in --help
RunCommand add_record(CLI::App& app);
RunCommand add_report(CLI::App& app);
RunCommand add_run(CLI::App& app);
RunCommand add_snapshot(CLI::App& app);
RunCommand add_synthesize(CLI::App& app);
/// `interrupt` ends the program even if a system call blocks the closing of the window.
RunCommand add_view(CLI::App& app);

/// Returns the commands that --help lists.
std::vector<const CLI::App*> commands_of(const CLI::App& app);
std::string names_of_commands(const CLI::App& app, const char* separator);

/// Adds an option whose help ends with the keys of an enumeration.
template <Choice E>
CLI::Option* add_choice(CLI::App& command,
                        const std::string& name,
                        const std::string& help,
                        auto& value) {
  return command.add_option_function<std::string>(
      name,
      [&value](const std::string& key) { value = choice<E>(key); },
      fmt::format("{}: {}", help, fmt::join(ChoiceKeys<E>::keys, ", ")));
}

/// Returns what `info` finds in a recording, also why its gyroscope does not fit the images.
RecordingInfo found_in(const std::shared_ptr<const Recording>& recording);

inline constexpr const char* kRecordingHelp = "Folder or file of a recording, or a recipe";
inline constexpr const char* kSourceHelp =
    "camera:NUMBER[,WIDTHxHEIGHT[,HZ]], a stream (rtsp://, http://, udp://), or a recording, which "
    "is played in real time";

/// Returns the format to write: `wanted`, else as the extension of the output tells. Throws
/// InputError if the extension is that of another format.
RecordingFormat recording_format(const std::filesystem::path& output,
                                 const std::optional<RecordingFormat>& wanted);

void add_topics(CLI::App& command, TopicChoices& topics);
void add_cache(CLI::App& command, std::size_t& mib);

/// The recording and settings of `run`, `snapshot` and `view`.
struct InspectArguments {
  std::filesystem::path recording;              ///< empty if none is given
  std::optional<std::filesystem::path> tracks;  ///< not for `view`
  TopicChoices topics;
  std::size_t cache_mib = FrameCache::kDefaultByteLimit >> 20;
  std::string calibrate = "off";  ///< auto: calibrates an uncalibrated camera from a plane in view
  Settings settings;
  std::vector<std::string> given;  ///< keys of the settings that the command line names
};

CLI::Option* add_recording(CLI::App& command, InspectArguments& arguments);
CLI::Option* add_tracks_and_recording(CLI::App& command, InspectArguments& arguments);

/// Looks up the method of the settings, which may be one of the user's. Throws SettingError.
void find_method(InspectArguments& arguments, const MethodTable& methods);

/// Returns the recording of the arguments for the window, with the frames that it searches.
GivenRecording given_recording(const InspectArguments& arguments);

/// Opens the recording and prints its notes on standard error. Throws InputError.
std::shared_ptr<const Recording> open(const InspectArguments& arguments);

/// Throws InputError if an output is a file that the recording was read from.
void check_not_overwritten(const Recording& recording, const std::vector<NamedFile>& outputs);

/// Prints the given settings that had no effect, with the reason, one per line on standard error.
void report_unused(std::span<const std::string> given,
                   std::span<const std::shared_ptr<const Inspection>> inspections,
                   std::span<const Configuration> compared = {});

struct ViewRequest {
  std::string view;                    ///< a name of `panes()`
  std::optional<int> frame;            ///< frame of the recording; default: the window's last
  std::optional<cv::Size> size;        ///< default: the view's own [px]
  std::optional<std::string> methods;  ///< for compare and curves, as in `evaluate`; default: all
  std::optional<std::string> lengths;  ///< for curves; default: 5 to the window's, step 5
  Settings window;                     ///< settings that no configuration names
  MethodTable table = {};
};

struct DrawnView {
  cv::Mat image;                                               ///< CV_8UC3, BGR
  bool ok = false;                                             ///< at least one method succeeded
  std::vector<std::shared_ptr<const Inspection>> inspections;  ///< for curves: the longest window
  std::vector<std::string> failures = {};                      ///< one line each, for people
};

/// Returns the configurations of compare and curves. Throws InputError.
std::vector<Configuration> configurations_of(const ViewRequest& request);

/// Adds an inspection, and the reason if it failed; `name` is for people.
void add_result(DrawnView& drawn,
                const std::shared_ptr<const Inspection>& inspection,
                const std::string& name);

/// Inspects and draws without a display. Throws InputError, and Stopped if it is stopped.
DrawnView draw_view(const std::shared_ptr<const Recording>& recording,
                    const ViewRequest& request,
                    const std::stop_token& stop = {});

/// Inspects windows of growing length from the same start. Returns their errors over the length, or
/// without ground truth their residuals; adds inspections and failures to `drawn`. Throws as
/// `draw_view` does.
Figure curves_over_length(const std::shared_ptr<const Recording>& recording,
                          const ViewRequest& request,
                          DrawnView& drawn,
                          const std::stop_token& stop);

/// A recording of a report, opened under the path that the user gave.
struct ReportRecording {
  fs::path path;
  std::shared_ptr<const Recording> recording;
  TopicChoices topics = {};
  std::optional<fs::path> tracks = {};  ///< file that replaces the tracker; nullopt: none
};

struct ReportRequest {
  std::vector<ReportRecording> recordings;
  std::optional<std::string> methods;  ///< to compare, as in `evaluate`; the first is the main one
  Settings window;
  std::vector<std::string> given = {};  ///< keys of the settings that the user named
  MethodTable table = {};
};

struct WrittenReport {
  std::string page;  ///< HTML
  bool ok = false;   ///< at least one method succeeded on a recording
  std::vector<std::shared_ptr<const Inspection>> inspections;  ///< the main one of each recording
};

/// Inspects recordings and returns their report, without a display. Throws as `draw_view` does.
WrittenReport make_report(const ReportRequest& request, const std::stop_token& stop = {});

/// Writes the tables and figures of a finished experiment into its folder. `figure_width`: of a
/// print, "85mm"; `bare_figures`: without titles and notes. Returns the rows. Throws InputError.
std::vector<Row> write_evaluation(const std::filesystem::path& folder,
                                  const Experiment& experiment,
                                  const std::optional<std::string>& figure_width = {},
                                  bool bare_figures = false);

}  // namespace gpo
