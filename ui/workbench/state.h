// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"
#include "engine/exports/exports.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/live/live_window.h"
#include "engine/inspection/settings/settings_table.h"
#include "engine/inspection/studies/studies.h"
#include "engine/recording/bags/messages.h"
#include "engine/recording/recording.h"
#include "engine/window/tracks.h"
#include "ui/look/look.h"
#include "ui/look/navigation.h"
#include "ui/workbench/layout.h"

#include <filesystem>
#include <map>
#include <memory>

#include <opencv2/core/types.hpp>

namespace gpo {

namespace fs = std::filesystem;

struct TimeSpan {
  int first = 0;
  int count = 0;  ///< 0: all

  bool operator==(const TimeSpan&) const = default;
};

/// The window and its length again on both sides; all frames if that is nearly all.
TimeSpan around_window(const Settings& settings, int frames);

/// The initial span: all frames, or the window's surroundings if it would be a hairline in all.
TimeSpan first_time_span(const Settings& settings, int frames);

/// Shows `factor` times as many frames and keeps the frame at `share` of the time line (0 to 1).
TimeSpan zoomed(const TimeSpan& span, int frames, double share, double factor);

/// Moves the span as little as needed to include a frame.
TimeSpan holding(TimeSpan span, int frame);

/// The nearest settings whose window fits into the recording and has at least two frames.
Settings fit_window(Settings settings, int frame_count);

/// Starts the window at `frame` and keeps its end, or its length if it would end before its start.
Settings start_window_at(Settings settings, int frame, int frame_count);

/// Ends the window at `frame` and keeps its start, or its length if it would start after its end.
Settings end_window_at(Settings settings, int frame, int frame_count);

struct Selection {
  std::vector<std::int64_t> tracks;   ///< ascending
  std::optional<std::int64_t> focus;  ///< one of `tracks`, shown in detail; the last selected one
  std::vector<Vector2d> points_px = {};  ///< picked pixels, at most two
  int points_frame = 0;                  ///< that shows them, counts in the recording

  bool contains(std::int64_t track) const;
  bool operator==(const Selection&) const = default;
};

/// Selects only `tracks`; the last one gets the focus.
Selection selected(std::span<const std::int64_t> tracks);
/// Adds `track`, or removes it if it is selected already.
Selection toggled(Selection selection, std::int64_t track);
Selection extended(Selection selection, std::span<const std::int64_t> tracks);
/// Selects the tracks of `all` that are not selected.
Selection inverted(const Selection& selection, std::span<const std::int64_t> all);

struct Hover {
  std::optional<std::int64_t> track = std::nullopt;
  std::optional<int> camera = std::nullopt;  ///< frame, counts in the recording
  std::string finding = {};                  ///< key; empty: none

  bool operator==(const Hover&) const = default;
};

struct Row;

enum class Severity { note, warning, error };

struct LogLine {
  Severity severity = Severity::note;
  std::string text;  ///< one line
};

/// View of a `Screenshot` that is written as an HTML report.
inline constexpr const char* kReportView = "report";

/// An image of the window or of one view, waiting to be written.
struct Screenshot {
  fs::path file;                      ///< .png; empty: a free name in the current folder
  std::string view = "window";        ///< a name of `panes()`, or `kReportView`: .html
  std::optional<cv::Size> size = {};  ///< nullopt: as large as shown
};

/// A result to write for another program, as the window shows it.
struct PendingExport {
  std::shared_ptr<const Inspection> inspection;
  ExportChoices choices;
  ExportRequest request;
};

struct MovieRequest {
  fs::path file;       ///< .mp4
  double rate_hz = 0;  ///< frames per second; 0: the rate of the recording
};

struct Bookmark {
  int frame = 0;     ///< counts in the recording
  std::string note;  ///< one line; may be empty

  bool operator==(const Bookmark&) const = default;
};

struct Browse {
  std::string action = "open";  ///< runs with the chosen file
  std::string text = {};        ///< initial text of the field
};

struct UndoStep {
  Settings settings;
  double cube_side = 0;                     ///< in plane distances; 0: automatic
  std::optional<Vector3d> cube_ray;         ///< from the reference camera through the cube on
                                            ///< the plane; nullopt: as in the inspection
  std::map<int, Vector3d> other_cube_rays;  ///< the same for further planes, counted from 1
};

struct WorkbenchState;

struct SavedSession {
  fs::path recording;                           ///< empty: none was open
  std::shared_ptr<const WorkbenchState> state;  ///< without recording and results
};

/// The recording, the settings and what is compared and exported.
struct Document : UndoStep {
  std::shared_ptr<const Recording> recording;  ///< null: none is open
  std::vector<UndoStep> undo, redo;            ///< the most recent one last
  double drag = 0;                             ///< the last change's, see `change_settings`
  std::map<fs::path, Settings> earlier;        ///< by recording opened before
  std::vector<Bookmark> bookmarks;             ///< by frame
  std::vector<Configuration> compared = {{"gpo"}, {"pnp_ba"}, {"ba"}, {"pba"}};
  bool metric = false;  ///< poses and points are exported in meters
  std::string model;    ///< instead of the cube: "robot", a file; empty: none
};

enum class HelpPage { keys, glossary, manual, findings, about };

struct ViewState {
  int frame = 0;  ///< counts in the recording
  bool playing = false;
  double play_seconds = 0;  ///< since `frame` is shown, while playing
  double speed = 1;         ///< relative to the recording
  bool loop = false;        ///< playing repeats the window
  TimeSpan time_span;       ///< shown in the time line

  Theme theme = Theme::dark;
  ViewToggles toggles;
  Panes panes;
  Division division;
  double text_zoom = 1;                    ///< relative to the scale of the screen
  bool fullscreen = false;                 ///< requested
  std::optional<ImageZoom> compare_zoom;   ///< for all columns; nullopt: around the cubes
  bool flip = false;                       ///< the image shows `flipped_result`
  std::vector<std::string> hidden_curves;  ///< keys of Configurations
  ImageZoom image_zoom;
  NormalsZoom normals_zoom;
  Viewpoint viewpoint = Viewpoint::oblique;  ///< in the scene
  Coloring coloring = Coloring::plane;       ///< for tracks and map points
  std::optional<OrbitCamera> orbit;          ///< once the scene is dragged; nullopt: `viewpoint`

  bool show_help = false;
  HelpPage help_page = HelpPage::keys;
  int tour = 0;                        ///< step that is shown, counts from 1; 0: none
  std::optional<std::string> palette;  ///< typed text; nullopt: closed
  std::optional<Mask> drawn_mask;      ///< being drawn with the mouse; nullopt: none
  std::optional<Browse> browse;        ///< nullopt: closed
  /// Cameras to choose from, as they were when the list was opened; nullopt: closed.
  std::optional<std::vector<CameraDevice>> sources;
};

/// A calibration of the camera that the user may accept or discard.
struct CalibrationResult {
  std::shared_ptr<const Recording> before;  ///< the recording with its camera before
  std::string report;                       ///< for people, several lines
};

/// Results computed for the document or read from files.
struct ComputedResults {
  std::shared_ptr<const Inspection> inspection;  ///< the latest; null: none yet
  std::shared_ptr<const SurveyResults> surveyed = std::make_shared<const SurveyResults>();
  std::shared_ptr<const NormalStudy> study;    ///< the latest, maybe of another window; null: none
  std::shared_ptr<const StartScan> scan;       ///< null: not requested
  std::shared_ptr<const Extrapolation> after;  ///< cameras after the latest window; null: none
  /// The latest inspection with the frames after its window, for views; null: none.
  std::shared_ptr<const Inspection> extended;
  std::shared_ptr<const CalibrationResult> calibration;  ///< not yet accepted; null: none
  const Inspection* extended_of = nullptr;               ///< the one that `extended` extends
  /// Rows of a results.csv, whose curves replace those of the survey; null: none is open.
  std::shared_ptr<const std::vector<Row>> experiment;
  std::string experiment_name;  ///< name of its file, for people
};

/// Requests of actions to the program around the workbench, which reads and clears them.
struct Requests {
  bool quit = false;
  bool cancel = false;   ///< the running computation
  bool compute = false;  ///< inspect again with the same settings
  bool open_example = false;
  bool calibrate = false;  ///< the camera, from a plane in the images
  bool undo_calibration = false;
  bool find_start = false;                 ///< find a frame to initialize from
  std::optional<fs::path> open;            ///< a recording or a session
  std::optional<std::string> live;         ///< address of a source that the user named
  bool freeze = false;                     ///< the live source
  std::optional<fs::path> save_recording;  ///< folder or bag to write the open recording to
  std::vector<Screenshot> screenshots;
  std::optional<MovieRequest> movie;
  std::vector<PendingExport> exports;
  std::optional<std::string> copied;  ///< text for the clipboard
};

struct MessageLog {
  std::string text;  ///< one line
  Severity severity = Severity::note;
  double seconds = 0;  ///< since the message appeared
  std::vector<LogLine> lines;
};

struct SessionFiles {
  bool asks = false;                            ///< a user is there to choose files
  fs::path session_file;                        ///< last saved to; empty: not yet
  std::optional<SavedSession> waiting_session;  ///< continues when its recording is open
  std::vector<fs::path> recent;                 ///< opened before, the latest first
  fs::path given;                               ///< on the command line; empty: none
  TopicChoices given_topics;                    ///< its topics on the command line
  bool has_last_session = false;                ///< `continue` has something to open
};

/// Everything the user has opened, chosen and selected. A plain value, changed only by `apply`,
/// `advance` and `apply_recording`. A field that sessions store has its row in session_fields.cpp.
struct WorkbenchState {
  MethodTable methods;  ///< to choose from
  Document document;
  ViewState view;
  Selection selection;
  Hover hover;
  ComputedResults results;
  Requests requests;
  std::optional<LiveView> live;  ///< the source that is shown; nullopt: none
  std::string live_source;       ///< address of the last one; empty: none yet
  MessageLog messages;
  SessionFiles files;

  int frame_count() const { return document.recording ? document.recording->frame_count() : 0; }
};

void say(WorkbenchState& state, const std::string& text, Severity severity = Severity::note);
/// Clears the message line if it shows this error, whose cause is gone. The log keeps it.
void retract_error(WorkbenchState& state, const std::string& text);
/// Time for which the message is still shown, infinite for errors; nullopt if there is none.
std::optional<double> seconds_of_message(const WorkbenchState& state);

void go_to_frame(WorkbenchState& state, int frame);
/// Advances the time: playing follows the timestamps of the recording and stops at its last frame.
void advance(WorkbenchState& state, double seconds);
/// Time until `advance` shows another frame [s]; nullopt if it will not.
std::optional<double> seconds_to_next_frame(const WorkbenchState& state);

/// Changes the settings; `undo` restores the old ones. Another start removes excluded tracks and
/// masks, which belong to the reference frame. `drag`: when the mouse button went down; 0: none.
/// All changes of a drag are one step.
void change_settings(WorkbenchState& state, Settings settings, double drag = 0);
/// Changes the side of the cubes, as a step for `undo` like `change_settings`.
void change_cube_side(WorkbenchState& state, double side, double drag = 0);
/// Moves a plane's cube to where the ray of the reference camera meets the plane; nullopt: resets
/// all. `plane` counts from 1; 0: the leading plane. `dragging`: `undo` restores the place before
/// the last move without it.
void move_cube(WorkbenchState& state,
               const std::optional<Vector3d>& ray,
               int plane = 0,
               bool dragging = false);
/// Picks a pixel of the current frame: the second point next to one of the same frame, else the
/// first one.
void pick_point(WorkbenchState& state, const Vector2d& raw_px);
/// Clears the selection or, if there is none, closes the drawer.
void close_next(WorkbenchState& state);
/// Undoes the last change, or repeats the one undone last, if there is one.
void undo(WorkbenchState& state);
void redo(WorkbenchState& state);

// Ids of tracks of the current inspection, ascending; empty outside of its window.

std::vector<std::int64_t> tracks_of_window(const WorkbenchState& state);
std::vector<std::int64_t> tracks_in_view(const WorkbenchState& state);
std::vector<std::int64_t> outliers_in_view(const WorkbenchState& state);
/// The tracks seen in the current frame between two corners [raw px].
std::vector<std::int64_t> tracks_within(const WorkbenchState& state,
                                        const Vector2d& a,
                                        const Vector2d& b);
/// Returns the setting `plane` that makes the track's plane leading; nullopt if on no other plane.
std::optional<int> to_main_plane(const Inspection& inspection, std::int64_t id);

/// Returns the ids of the findings' tracks that are among the tracks, ascending.
std::vector<std::int64_t> tracks_of(std::span<const Finding> findings, const Tracks& tracks);

/// Column in the window of the track with this id; nullopt if the window has no such track.
std::optional<int> column_of(const Tracks& tracks, std::int64_t id);

/// The inspection with the leading plane's cube moved to a ray of the reference camera (nullopt:
/// not moved) and with those of further planes, which count from 1.
std::shared_ptr<const Inspection> with_cube(std::shared_ptr<const Inspection> inspection,
                                            const std::optional<Vector3d>& ray_c,
                                            const std::map<int, Vector3d>& others_c = {});

/// The configuration that names and colors settings: their difference from what all compared share.
Configuration name_among_compared(const WorkbenchState& state, const Settings& settings);

/// Returns `compared_settings`, preceded by `window` if it is not among them.
std::vector<Settings> settings_with_current(const WorkbenchState& state, const Settings& window);

/// The settings of all compared configurations; what none of them sets is that of `window`.
std::vector<Settings> compared_settings(const WorkbenchState& state, const Settings& window);

/// The results of `compared_with_current`, all cubes on one ray; `flip` swaps the first two.
std::vector<Compared> compared_results(const WorkbenchState& state);

/// The results of `state.document.compared`, preceded by the current one if it is not among them.
std::vector<Compared> compared_with_current(const WorkbenchState& state);

/// The result shown instead of the current one while `flip` is on; nullopt if there is none.
std::optional<Compared> flipped_result(const WorkbenchState& state);

/// The window lengths of the curves, the longest first: `frames`, then multiples of five.
std::vector<int> curve_lengths(int frames);

/// The inspections that the open views need, at shorter lengths, too, if the curves are open or a
/// report waits for them.
std::vector<Settings> wanted_inspections(const WorkbenchState& state);

/// Returns whether a report waits for its inspections.
inline bool wants_report(const WorkbenchState& state) {
  return std::ranges::count(state.requests.screenshots, kReportView, &Screenshot::view) > 0;
}

/// Returns the open recording, with the camera of the latest inspection if there is one: it differs
/// by the setting `intrinsics_scale`. Null if none is open.
const std::shared_ptr<const Recording>& shown_recording(const WorkbenchState& state);

/// Returns whether the open recording was made by freezing a live source.
bool is_frozen(const WorkbenchState& state);

/// The current result first, then the computed compared ones of the same window. Empty before.
std::vector<ShownResult> shown_results(const WorkbenchState& state);

}  // namespace gpo
