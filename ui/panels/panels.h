// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/context/window_image.h"
#include "ui/panels/facts/curve_facts.h"
#include "ui/panels/facts/track_rows.h"
#include "ui/views/charts/chart_view.h"
#include "ui/views/charts/study_charts.h"
#include "ui/views/normals/normals_view.h"
#include "ui/views/overlay/plane_style.h"
#include "ui/views/image/image_texture.h"
#include "ui/views/scene/scene_view.h"
#include "ui/workbench/commands.h"
#include "ui/workbench/layout.h"
#include "ui/workbench/state.h"
#include "ui/workbench/work/folder_lister.h"
#include "ui/workbench/work/image_fetcher.h"
#include "ui/workbench/work/survey.h"

#include <array>
#include <map>
#include <memory>
#include <string>

namespace gpo {

/// What a panel may look at.
struct PanelInput {
  const WorkbenchState& state;
  const JobStatus& worker;
  const SurveyStatus& survey;
  bool timings = true;                 ///< false: milliseconds are dashes, so that pictures compare
  float scale = 1;                     ///< of the text: sizes for 96 dpi times this
  const JobStatus* writing = nullptr;  ///< how far a movie is; null: none is written
  const SurveyStatus* scan = nullptr;  ///< how far a scan is; null: none is made
  ImageFetcher* fetcher = nullptr;   ///< null: drawing waits for pictures itself
  FolderLister* lister = nullptr;      ///< null: folders are shown as empty
  std::filesystem::path example = {};  ///< the recording that comes with the program

  /// The last one that was finished; null: none.
  const Inspection* inspection() const { return state.results.inspection.get(); }
};

/// What was typed into the list of all commands.
struct PaletteEntry {
  std::array<char, 256> text{};
  int chosen = 0;          ///< of the actions that it finds
  bool open = false;       ///< in the last frame
  bool typed_out = false;  ///< by us: the cursor is to go to its end
};

/// What was typed to choose a file.
struct BrowserEntry {
  std::array<char, 1024> text{};
  int chosen = 0;          ///< of the entries that it finds; -1: what is typed
  bool open = false;       ///< in the last frame
  bool typed_out = false;  ///< by us: the field is to take it over
  FolderList listed;       ///< in the last frame
};

/// An enlarged part of a picture, and what it shows.
struct TrackPatch {
  ImageTexture texture;
  std::shared_ptr<const Recording> recording;
  int frame = -1;
  Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
  bool empty = true;  ///< there is no picture
};

/// Residuals of a window, and whose they are.
struct Residuals {
  std::shared_ptr<const Inspection> of;  ///< null: none yet
  WindowResiduals px;
};

/// Colors of tracks, and whose they are.
struct KeptTrackColors {
  std::shared_ptr<const Inspection> of;  ///< null: none yet
  Coloring coloring = Coloring::plane;
  std::shared_ptr<const TrackColors> colors;  ///< null: by plane
};

/// A model, and which one it is.
struct CachedModel {
  std::string name;                         ///< empty: none
  std::shared_ptr<const SolidModel> model;  ///< null: it could not be read
  std::string error;
};

/// Rows of tracks, and whose they are.
struct KeptTrackRows {
  std::shared_ptr<const Inspection> of;  ///< null: none yet
  std::vector<TrackRow> rows;
};

/// What the views keep from frame to frame, most of it in the graphics memory. Needs its context.
struct Views {
  ImageTexture image;
  cv::Mat pixels;                              ///< of `image`; CV_8UC3, BGR
  std::shared_ptr<const Recording> recording;  ///< of the picture that is in `image`
  int frame = -1;                              ///< -1: none of it is there, yet
  int asked = -1;                              ///< frame that is being fetched; -1: none
  std::string image_error;                   ///< why there is none
  SceneView scene;
  PaletteEntry palette;
  BrowserEntry browser;
  std::array<TrackPatch, 2> patches;             ///< of a track: in its first frame, in the current one
  std::map<std::string, ChartView> charts;  ///< by a name that their panel gives them
  KeptCurveFacts curves;                    ///< of the drawer
  Residuals residuals;
  TrackLives lives;
  KeptTrackColors colors;
  CachedModel model;
  KeptTrackRows tracks;  ///< of the drawer, as it has sorted them
  NormalsMap normals;
  WindowImage window;  ///< of which only the parts that change are drawn anew
};

/// A picture of the recording, which has some: as soon as it is fetched, or at once where nobody
/// fetches.
FetchedImage image_of(const PanelInput& input, int frame);

/// Brings the picture of the current frame into `views`, where it is not there yet. Returns the
/// frame to draw: the current one, but while its picture is fetched the one whose picture is there.
int update_image(const PanelInput& input, Views& views);

/// What `update_image` has brought; null where there is nothing.
ImageTexture* shown_image(Views& views);

// Each draws one part of the window through Dear ImGui and changes nothing but `Views`.
void menu_bar(const PanelInput& input, Commands& commands);
void settings_panel(const PanelInput& input, const Rectangle& place, Commands& commands);
void results_panel(const PanelInput& input, const Rectangle& place);
void image_panel(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands);
/// Picture and side pane in one: a column a compared configuration.
void compare_panel(const PanelInput& input,
                   const Rectangle& place,
                   Views& views,
                   Commands& commands);
void timeline_panel(const PanelInput& input, const Rectangle& place, Commands& commands);
void status_line(const PanelInput& input, const Rectangle& place);
void help_overlay(const PanelInput& input, const Rectangle& window, Commands& commands);
void palette_overlay(const PanelInput& input,
                     const Rectangle& window,
                     Views& views,
                     Commands& commands);
/// Lines between the parts, to be dragged; a double click puts one back.
void splitters(const PanelInput& input, const WindowLayout& layout, Commands& commands);
void browser_overlay(const PanelInput& input,
                     const Rectangle& window,
                     Views& views,
                     Commands& commands);
void empty_panel(const PanelInput& input, const Rectangle& place, Commands& commands);

/// Names of the side panes, and of the drawers, to choose one by a click.
void side_tabs(const PanelInput& input, const Rectangle& place, Commands& commands);
void drawer_tabs(const PanelInput& input, const Rectangle& place, Commands& commands);
/// Draws a pane into the part of the window that it fills, which is a panel already. One file each.
using DrawPane = void(const PanelInput&, const Rectangle&, Views&, Commands&);
/// The function that draws a pane; null for the whole window.
DrawPane* draw_function(const Pane& pane);

/// The side pane, or the drawer, that is open; nothing where it is shut.
DrawPane side_pane, drawer;

}  // namespace gpo
