// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings.h"
#include "engine/inspection/survey.h"
#include "engine/recording/recording.h"
#include "ui/look/palette.h"
#include "ui/views/normals/normals_disc.h"
#include "ui/views/picture/image_geometry.h"
#include "ui/views/scene/orbit_camera.h"
#include "ui/workbench/panes.h"
#include "ui/workbench/selection.h"
#include "ui/workbench/time_span.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <opencv2/core/types.hpp>

namespace gpo {

struct Row;

/// What is drawn into picture and scene.
struct ViewToggles {
  bool tracks = true;
  bool tails = true;
  bool residuals = false;
  bool cube = true;
  bool truth = true;
  int uncertainty = 1;  ///< of the scene, enlarged so many times: 0 (not shown), 1, 10, 100

  bool operator==(const ViewToggles&) const = default;
};

/// Which views are open.
struct Panes {
  SidePane side = SidePane::scene;
  std::optional<Drawer> drawer = std::nullopt;  ///< nothing: shut
  bool compare = false;  ///< one column a compared configuration, in place of picture and side pane

  bool operator==(const Panes&) const = default;
};

enum class Severity { note, warning, error };

struct LogLine {
  Severity severity = Severity::note;
  std::string text;  ///< one line
};

/// A picture of the window, or of one view alone, on its way to the disk.
struct Screenshot {
  std::filesystem::path file;         ///< .png; empty: a free name in the current folder
  std::string view = "window";        ///< window | picture | a key of SidePane | compare | curves
  std::optional<cv::Size> size = {};  ///< nothing: as large as it is shown
};

/// A movie of the window's frames on its way to the disk.
struct MovieWish {
  std::filesystem::path file;  ///< .mp4
  double rate_hz = 0;          ///< frames a second; 0: the recording's own
};

/// A frame that the user wants to find again.
struct Bookmark {
  int frame = 0;     ///< counts in the recording
  std::string note;  ///< one line; may be empty

  bool operator==(const Bookmark&) const = default;
};

struct WorkbenchState;

/// A session from a file, see `read_session`.
struct SavedSession {
  std::filesystem::path recording;              ///< empty: none was open
  std::shared_ptr<const WorkbenchState> state;  ///< without a recording and what comes of it
};

/// What an action asks of the world around the workbench: who runs it reads and clears it.
struct Wishes {
  bool quit = false;
  bool cancel = false;   ///< what the worker does
  bool compute = false;  ///< inspect again with the same settings
  bool open_example = false;
  std::optional<std::filesystem::path> open;  ///< a recording or a session
  std::vector<Screenshot> screenshots;
  std::optional<MovieWish> movie;
};

/// What the user has open, chosen and selected. A plain value; it changes in `apply`, `advance` and
/// `adopt` alone.
struct WorkbenchState {
  std::shared_ptr<const Recording> recording;    ///< null: nothing is open
  std::shared_ptr<const Inspection> inspection;  ///< the last one of it; null: none yet
  std::shared_ptr<const SurveyResults> surveyed = std::make_shared<const SurveyResults>();
  std::shared_ptr<const NormalStudy> study;  ///< the last one, maybe of another window; null: none

  Settings settings;
  std::vector<Settings> undo, redo;  ///< earlier settings, and those that were undone; last first
  bool dragging_settings = false;    ///< the last change was one of many small ones
  int frame = 0;                     ///< shown, counts in the recording
  bool playing = false;
  double play_seconds = 0;          ///< since `frame` is shown, while playing
  double speed = 1;                 ///< of playing, in the recording's own
  bool loop = false;                ///< playing repeats the window
  std::vector<Bookmark> bookmarks;  ///< by frame
  TimeSpan time_span;               ///< of the time line

  Theme theme = Theme::dark;
  ViewToggles view;
  Panes panes;
  std::vector<std::string> compared = {"gpo", "pnp_ba", "ba", "pba"};  ///< keys of Configurations
  std::optional<PictureZoom> compare_zoom;  ///< of all columns; nothing: around the cubes
  bool flip = false;  ///< the picture shows the first compared other result; see `flipped`
  std::vector<std::string> hidden_curves;  ///< keys of Configurations
  /// Of a results.csv, whose curves take the place of the survey's; null: none is open.
  std::shared_ptr<const std::vector<Row>> experiment;
  std::string experiment_name;              ///< of that file, for people
  double cube_side = 0;                     ///< in plane distances; 0: automatic
  std::optional<Eigen::Vector3d> cube_ray;  ///< of the reference camera: where the cube stands on
                                            ///< the plane; nothing: where the inspection puts it
  PictureZoom picture_zoom;                 ///< of the picture
  NormalsZoom normals_zoom;                 ///< of the disc of normals
  std::optional<OrbitCamera> orbit;         ///< of the scene; nothing: everything in view
  Selection selection;
  Hover hover;
  bool show_help = false;
  std::optional<std::string> palette;  ///< open, with this typed already; nothing: shut

  std::vector<std::filesystem::path> recent;  ///< opened before, the last one first
  bool has_last_session = false;              ///< `continue` has something to open

  std::string message;  ///< the last one, one line
  std::vector<LogLine> log;
  Wishes wishes;
  std::optional<SavedSession> waiting_session;  ///< goes on when its recording is open

  int frame_count() const { return recording ? recording->frame_count() : 0; }
};

/// Says so in the message line and in the log.
void say(WorkbenchState& state, const std::string& text, Severity severity = Severity::note);

struct RunAction {
  std::string line;  ///< a line of a script: an action's name and what it needs, see `run_line`
};
struct ChangeSettings {
  Settings settings;
  bool dragging = false;  ///< one of many small changes: they are undone together
};
struct GoToFrame {
  int frame;
};
struct SetCubeSide {
  double side;
};
/// Puts the cube where the ray of the reference camera meets the plane; nothing: back to its place.
struct MoveCube {
  std::optional<Eigen::Vector3d> ray;
};
struct ZoomPicture {
  PictureZoom zoom;
};
/// All columns of the comparison; nothing: around the cubes.
struct ZoomCompare {
  std::optional<PictureZoom> zoom;
};
struct ZoomNormals {
  NormalsZoom zoom;
};
struct OrbitScene {
  OrbitCamera camera;
};
struct FitScene {};
struct OpenPath {
  std::filesystem::path path;
};
struct HoverOver {
  Hover hover;
};
struct SelectTracks {
  Selection selection;
};

/// Everything that a user can do. Panels push commands and change nothing themselves; so keys,
/// menus, panels and tests take one path.
using Command = std::variant<RunAction,
                             ChangeSettings,
                             GoToFrame,
                             SetCubeSide,
                             MoveCube,
                             ZoomPicture,
                             ZoomCompare,
                             ZoomNormals,
                             OrbitScene,
                             FitScene,
                             OpenPath,
                             HoverOver,
                             SelectTracks>;

/// What the user did while a frame was drawn, to be applied after it.
using Commands = std::vector<Command>;
/// Not `push_back`: inlined, it makes GCC 12 warn of members that are not there.
void push(Commands& commands, const Command& command);

void apply(WorkbenchState& state, const Command& command);

/// Lets `seconds` pass: plays at the recording's own rate, and stops at its last frame.
void advance(WorkbenchState& state, double seconds);

/// Until `advance` shows another frame [s]; nothing where it will not.
std::optional<double> seconds_to_next_frame(const WorkbenchState& state);

/// Takes other settings; the old ones can be had back by `undo`. Those that follow each other while
/// `dragging` are undone together.
void change_settings(WorkbenchState& state, Settings settings, bool dragging = false);

/// The inspections that the open views ask for beside the current one: every compared configuration
/// in the current window, and with the curves open at shorter lengths, too.
std::vector<Settings> wanted_inspections(const WorkbenchState& state);

/// Takes a recording that was opened: fits the window into it and shows the window's last frame.
void adopt(WorkbenchState& state, std::shared_ptr<const Recording> recording);

/// The nearest settings whose window fits into so many frames (at least two).
Settings fit_window(Settings settings, int frame_count);

/// The window from `frame` on to its old end, or of its old length where it would end before.
Settings start_window_at(Settings settings, int frame, int frame_count);

/// The window from its old start up to `frame`, or of its old length where it would start after.
Settings end_window_at(Settings settings, int frame, int frame_count);

}  // namespace gpo
