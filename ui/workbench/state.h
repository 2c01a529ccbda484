// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/configuration.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/settings/settings.h"
#include "engine/inspection/studies/normal_study.h"
#include "engine/inspection/studies/scan.h"
#include "engine/recording/recording.h"
#include "ui/look/normals_zoom.h"
#include "ui/look/orbit_camera.h"
#include "ui/look/palette.h"
#include "ui/look/image_zoom.h"
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
struct MovieRequest {
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
struct SavedSpan {
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

/// The recording, the problem that is posed for it and how its results are compared and exported.
struct Document {
  std::shared_ptr<const Recording> recording;  ///< null: nothing is open
  Settings settings;
  std::vector<UndoStep> undo, redo;  ///< before earlier changes, and undone ones; the last one last
  bool dragging_settings = false;    ///< the last change was one of many small ones
  std::vector<SavedSpan> spans;       ///< of recordings that were open before
  std::vector<Bookmark> bookmarks;   ///< by frame
  std::vector<Configuration> compared = {{"gpo"}, {"pnp_ba"}, {"ba"}, {"pba"}};
  bool metric = false;                      ///< poses and points are exported in meters
  double cube_side = 0;                     ///< in plane distances; 0: automatic
  std::optional<Eigen::Vector3d> cube_ray;  ///< of the reference camera: where the cube stands on
                                            ///< the plane; nothing: where the inspection puts it
  std::string model;                        ///< in the cube's place: "robot", a file; empty: none
};

/// What the window shows, and how.
struct ViewState {
  int frame = 0;  ///< counts in the recording
  bool playing = false;
  double play_seconds = 0;  ///< since `frame` is shown, while playing
  double speed = 1;         ///< of playing, in the recording's own
  bool loop = false;        ///< playing repeats the window
  TimeSpan time_span;       ///< of the time line

  Theme theme = Theme::dark;
  ViewToggles toggles;
  Panes panes;
  Division division;
  double text_zoom = 1;                      ///< of everything, times the screen's own scale
  bool fullscreen = false;                   ///< wanted
  std::optional<ImageZoom> compare_zoom;   ///< of all columns; nothing: around the cubes
  bool flip = false;                         ///< the picture shows `flipped_result`
  std::vector<std::string> hidden_curves;    ///< keys of Configurations
  ImageZoom image_zoom;                  ///< of the picture
  NormalsZoom normals_zoom;                  ///< of the disc of normals
  Viewpoint viewpoint = Viewpoint::oblique;  ///< of the scene
  Coloring coloring = Coloring::plane;       ///< of tracks and map points
  std::optional<OrbitCamera> orbit;  ///< of the scene where it was dragged; nothing: `viewpoint`

  bool show_help = false;
  std::optional<std::string> palette;  ///< open, with this typed already; nothing: shut
  std::optional<Browse> browse;        ///< open; nothing: shut
};

/// What was computed for the document, or read.
struct ComputedResults {
  std::shared_ptr<const Inspection> inspection;  ///< the last one; null: none yet
  std::shared_ptr<const SurveyResults> surveyed = std::make_shared<const SurveyResults>();
  std::shared_ptr<const NormalStudy> study;  ///< the last one, maybe of another window; null: none
  std::shared_ptr<const StartScan> scan;     ///< null: nobody asked for one
  /// Of a results.csv, whose curves take the place of the survey's; null: none is open.
  std::shared_ptr<const std::vector<Row>> experiment;
  std::string experiment_name;  ///< of that file, for people
};

/// What actions request of the program around the workbench, which reads and clears it.
struct Requests {
  bool quit = false;
  bool cancel = false;   ///< what the worker does
  bool compute = false;  ///< inspect again with the same settings
  bool open_example = false;
  bool calibrate = false;                     ///< the camera, from a plane in the pictures
  bool find_start = false;                    ///< from which frame to initialize
  std::optional<std::filesystem::path> open;  ///< a recording or a session
  std::vector<Screenshot> screenshots;
  std::optional<MovieRequest> movie;
};

/// The last message, and all of them.
struct MessageLog {
  std::string text;  ///< the last one, one line
  Severity severity = Severity::note;
  double seconds = 0;  ///< since it was said
  std::vector<LogLine> lines;
};

/// Sessions and recordings on the disk.
struct SessionFiles {
  bool asks = false;                            ///< a user is there who can be asked for a file
  std::filesystem::path session_file;           ///< where it was saved last; empty: not yet
  std::optional<SavedSession> waiting_session;  ///< goes on when its recording is open
  std::vector<std::filesystem::path> recent;    ///< opened before, the last one first
  bool has_last_session = false;                ///< `continue` has something to open
};

/// What the user has open, chosen and selected. A plain value; it changes in `apply`, `advance` and
/// `apply_recording` alone. A field that sessions keep has its row in session_fields.cpp.
struct WorkbenchState {
  MethodTable methods;  ///< to choose from
  Document document;
  ViewState view;
  Selection selection;
  Hover hover;
  ComputedResults results;
  Requests requests;
  MessageLog messages;
  SessionFiles files;

  int frame_count() const { return document.recording ? document.recording->frame_count() : 0; }
};

/// Says so in the message line and in the log.
void say(WorkbenchState& state, const std::string& text, Severity severity = Severity::note);

}  // namespace gpo
