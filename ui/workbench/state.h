// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings.h"
#include "engine/inspection/studies/normal_study.h"
#include "engine/inspection/studies/scan.h"
#include "engine/inspection/studies/surveyed.h"
#include "engine/recording/recording.h"
#include "ui/look/normals_zoom.h"
#include "ui/look/orbit_camera.h"
#include "ui/look/palette.h"
#include "ui/look/picture_zoom.h"
#include "ui/look/view_choices.h"
#include "ui/look/view_toggles.h"
#include "ui/workbench/division.h"
#include "ui/workbench/panes.h"
#include "ui/workbench/selection.h"
#include "ui/workbench/time_span.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

namespace gpo {

struct Row;

enum class Severity { note, warning, error };

struct LogLine {
  Severity severity = Severity::note;
  std::string text;  ///< one line
};

/// A picture of the window, or of one view alone, on its way to the disk.
struct Screenshot {
  std::filesystem::path file;         ///< .png; empty: a free name in the current folder
  std::string view = "window";        ///< a name of `panes()`
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

/// Choosing a file or a folder for an action.
struct Browse {
  std::string action = "open";  ///< run with what is chosen
  std::string text = {};        ///< in the field at the start
};

/// What `undo` takes back: how the problem is put, and where the cube stands.
struct UndoStep {
  Settings settings;
  double cube_side = 0;
  std::optional<Eigen::Vector3d> cube_ray;
};

/// What is a recording's own: where one looks at it, and how; it comes back with the recording.
struct KeptSpan {
  std::filesystem::path recording;
  int start = 0;
  int frames = 0;
  MethodChoice method = "";
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
  bool calibrate = false;                     ///< the camera, from a plane in the pictures
  bool find_start = false;                    ///< from which frame to initialize
  std::optional<std::filesystem::path> open;  ///< a recording or a session
  std::vector<Screenshot> screenshots;
  std::optional<MovieWish> movie;
};

/// What the user has open, chosen and selected. A plain value; it changes in `apply`, `advance` and
/// `adopt` alone. A field that sessions keep has its row in session_fields.cpp.
struct WorkbenchState {
  std::shared_ptr<const Recording> recording;    ///< null: nothing is open
  std::shared_ptr<const Inspection> inspection;  ///< the last one of it; null: none yet
  std::shared_ptr<const SurveyResults> surveyed = std::make_shared<const SurveyResults>();
  std::shared_ptr<const NormalStudy> study;  ///< the last one, maybe of another window; null: none
  std::shared_ptr<const StartScan> scan;     ///< null: nobody asked for one

  Settings settings;
  MethodTable methods;               ///< to choose from
  std::vector<KeptSpan> spans;       ///< of recordings that were open before
  std::vector<UndoStep> undo, redo;  ///< before earlier changes, and undone ones; the last one last
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
  Division division;
  double text_zoom = 1;     ///< of everything, times the screen's own scale
  bool fullscreen = false;  ///< wanted
  std::vector<std::string> compared = {"gpo", "pnp_ba", "ba", "pba"};  ///< keys of Configurations
  std::optional<PictureZoom> compare_zoom;  ///< of all columns; nothing: around the cubes
  bool flip = false;  ///< the picture shows the first compared other result; see `flipped`
  std::vector<std::string> hidden_curves;  ///< keys of Configurations
  /// Of a results.csv, whose curves take the place of the survey's; null: none is open.
  std::shared_ptr<const std::vector<Row>> experiment;
  std::string experiment_name;               ///< of that file, for people
  bool metric = false;                       ///< poses and points are exported in meters
  double cube_side = 0;                      ///< in plane distances; 0: automatic
  std::string model;                         ///< in the cube's place: "robot", a file; empty: none
  std::optional<Eigen::Vector3d> cube_ray;   ///< of the reference camera: where the cube stands on
                                             ///< the plane; nothing: where the inspection puts it
  PictureZoom picture_zoom;                  ///< of the picture
  NormalsZoom normals_zoom;                  ///< of the disc of normals
  Viewpoint viewpoint = Viewpoint::oblique;  ///< of the scene
  Coloring coloring = Coloring::plane;       ///< of tracks and map points
  std::optional<OrbitCamera> orbit;  ///< of the scene where it was dragged; nothing: `viewpoint`
  Selection selection;
  Hover hover;
  bool show_help = false;
  std::optional<std::string> palette;  ///< open, with this typed already; nothing: shut
  std::optional<Browse> browse;        ///< open; nothing: shut

  bool asks = false;                   ///< somebody is there who can be asked for a file
  std::filesystem::path session_file;  ///< where it was saved last; empty: not yet

  std::vector<std::filesystem::path> recent;  ///< opened before, the last one first
  bool has_last_session = false;              ///< `continue` has something to open

  std::string message;  ///< the last one, one line
  Severity message_severity = Severity::note;
  double message_seconds = 0;  ///< since it was said
  std::vector<LogLine> log;
  Wishes wishes;
  std::optional<SavedSession> waiting_session;  ///< goes on when its recording is open

  int frame_count() const { return recording ? recording->frame_count() : 0; }
};

/// Says so in the message line and in the log.
void say(WorkbenchState& state, const std::string& text, Severity severity = Severity::note);

}  // namespace gpo
