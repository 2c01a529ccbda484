// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "engine/experiment/experiment.h"
#include "engine/inspection/inspection.h"
#include "engine/recording/bags/messages.h"

#include <nlohmann/json.hpp>

namespace gpo {

/// A frame with tracks and cube, counted in the recording; CV_8UC3, BGR.
struct ReportFrame {
  int frame = 0;
  cv::Mat bgr;
};

/// One recording of a report, with its images already drawn.
struct ReportSection {
  std::shared_ptr<const Inspection> inspection;
  std::vector<Compared> methods = {};  ///< finished inspections to compare; empty: none
  std::vector<ReportFrame> frames = {};
  cv::Mat scene = {};                ///< shown where scripts do not run; CV_8UC3, BGR
  cv::Mat normals = {};              ///< hemisphere of normals; CV_8UC3, BGR
  std::vector<Figure> figures = {};  ///< curves
  std::string found = {};            ///< the table of `info`
  std::string command = {};          ///< a command line that computes the same result
};

struct Report {
  std::vector<ReportSection> sections;  ///< at least one
  std::string program;                  ///< version and build id
};

/// Largest report, so that mail servers accept it [bytes].
inline constexpr std::size_t kMostReportBytes = 5'000'000;

/// Returns one HTML page without references to other files or servers: verdicts, images, scenes
/// that the mouse turns, tables, and each result as JSON. Images get smaller until the page has at
/// most `kMostReportBytes`. Throws InputError if it is still larger.
std::string report_page(const Report& report);

/// Returns the frames to show: first, last and three between, of the inspected window.
std::vector<int> report_frames(const Inspection& inspection);

/// Draws frames, scene and normals of an inspection. Throws InputError without OpenGL.
ReportSection drawn_section(const std::shared_ptr<const Inspection>& inspection);

/// Returns the uncertainty of the normal while the window grows; no chart if it is unknown.
Figure growth_figure(const Inspection& inspection);

/// Shortest window whose report has curves over window lengths.
inline constexpr int kFewestFramesForCurves = 10;

/// Returns curves over the length of windows from the same start frame with their title. Each
/// length has one window, so its points are not drawn as few of many.
Figure with_single_windows(Figure figure, const std::string& recording, int start);

/// Returns the options with which a recording was opened, word by word: tracks, topics, and its
/// calibration from a plane.
std::vector<std::string> opening_options(const Recording& recording,
                                         const std::optional<fs::path>& tracks,
                                         const TopicChoices& topics);

/// Returns the command line, for a POSIX shell, that computes the same results. `opening`: the
/// words of `opening_options`; `compared`: empty for only the method of the settings.
std::string report_command(const fs::path& recording,
                           const std::vector<std::string>& opening,
                           const Settings& settings,
                           const std::vector<Configuration>& compared = {});

/// Returns the items of a scene in the estimate's world and its camera, for
/// assets/report/report.js.
nlohmann::ordered_json report_scene(const Inspection& inspection);

/// Returns a heading and a table of the findings; empty if there are none.
std::string findings_table(std::span<const Finding> findings);
/// Returns a table of the numbers of a result with one standard deviation each.
std::string numbers_table(const Inspection& inspection);
/// Returns a table of the settings that the result depends on; changed ones are marked.
std::string settings_table_html(const Inspection& inspection);
/// Returns a row for each result, with errors where ground truth is known. `recordings`: also
/// names the recordings.
std::string comparison_table(const std::vector<std::shared_ptr<const Inspection>>& inspections,
                             bool recordings);

/// Returns a text for the content and the attributes of HTML. Invalid UTF-8, e.g. in file names,
/// becomes the replacement character.
std::string html_text(const std::string& text);

/// Returns "data:TYPE;base64,...".
std::string data_uri(std::string_view type, std::string_view bytes);

/// Returns JSON that can be the content of a `script` element: without "<".
std::string script_json(const nlohmann::ordered_json& json);

/// A cell of a table: its text, not escaped, and the classes of its element.
struct HtmlCell {
  std::string text;
  std::string style = {};  ///< CSS classes; "number" aligns right
};

/// Returns a table. Columns whose cells are all empty are dropped; the first cell of a row is its
/// header. `row_styles`: CSS classes by row; may be empty.
std::string html_table(const std::vector<std::string>& header,
                       std::vector<std::vector<HtmlCell>> rows,
                       const std::vector<std::string>& row_styles = {});

}  // namespace gpo
