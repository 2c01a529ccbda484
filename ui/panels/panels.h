// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/facts/facts.h"
#include "ui/views/charts/charts.h"
#include "ui/views/compare/compare_view.h"
#include "ui/views/normals/normals_view.h"
#include "ui/views/scene/scene_view.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/work/disk_readers.h"
#include "ui/workbench/work/worker.h"

namespace gpo {

enum class PanelKind {
  fixed,
  scrolling,  ///< has a scroll bar if its content is higher
  over        ///< transparent and in front of other panels
};

/// A rectangular part of the window. Widgets drawn during its lifetime go there.
class PanelScope {
 public:
  PanelScope(const char* name, const Rectangle& place, ImVec2 padding, PanelKind kind = {});
  ~PanelScope();
  PanelScope(const PanelScope&) = delete;
  PanelScope& operator=(const PanelScope&) = delete;
};

/// Adds an invisible item for the mouse, by default its left button, and returns whether it was
/// clicked. It measures at least 1 px: Dear ImGui aborts on a width or height of 0.
bool hit_area(const char* name, ImVec2 size, ImGuiButtonFlags buttons = 0);

bool hit_area_at(const char* name, const Rectangle& place);

Vector2d mouse_px();
/// Returns whether the mouse is where its button went down, so that releasing it is a click.
bool is_click(float scale, int button = ImGuiMouseButton_Left);
/// Returns the zoom factor that the wheel requests over the last item; 1 if none.
double wheel_zoom();
/// Returns how far the mouse drags the last item in this frame [px].
Vector2d drag_px();
bool is_item_double_clicked();
/// Returns when the left button went down, which identifies a drag; 0 if it is up.
double current_drag();

/// Fills `place` with a text that says why there is no content, and what to do.
void draw_empty(const Rectangle& place, const std::string& text);

struct ColumnText {
  const char *title, *meaning;
};
/// Draws the first row of a table whose columns are set up: dim titles, meanings as tooltips.
void table_header(std::span<const ColumnText> columns);
/// Sets up the columns with a header row that does not scroll.
void frozen_header(std::span<const ColumnText> columns);

/// Draws a sign and a name beside it into the current table cell.
void marked_name(Sign sign, std::uint32_t rgb, const std::string& name, float scale);
/// Draws a sign as high as a line of text at the cursor.
void sign_at_cursor(Sign sign, std::uint32_t rgb);

void colored_text(std::uint32_t rgb, const std::string& text);
void colored_text(Role role, const std::string& text);
/// Continues the line at `x` [px from the panel's edge]; SameLine(x) counts from the group's.
void continue_line_at(float x);
/// Draws text, small if it would not end before `right` [px from the panel's edge].
void fitted_text(const std::string& text, float right);
void text_in(Font which, std::uint32_t rgb, const std::string& text);
/// Breaks lines at `right` [px from the panel's left edge].
void wrapped_text(const std::string& text, float right);

/// Returns the color of a message; `note` is for those of the lowest severity.
Role role_of(Severity severity, Role note);

void heading(const char* text);

/// Shows `text` while the mouse hovers over the last item.
void tooltip(const std::string& text);
void show_tooltip(const std::string& text);

/// Draws one line of text; if it is wider than `width`, it ends with "..." and has a tooltip.
void clipped_text(const std::string& text, float width, std::uint32_t rgb);

struct LoadedModel {
  std::shared_ptr<const SolidModel> model;  ///< null if none, or if it could not be read
  std::string error;
};

/// Reads 3-D models in the background.
class ModelReader {
 public:
  /// `changed` is called on the reader's thread when a model has been read.
  explicit ModelReader(std::function<void()> changed = {}) : queue_(std::move(changed)) {}

  /// Returns the model of this name (see `read_solid_model`), or requests it instead of the last
  /// one; nullopt while it is being read.
  std::optional<LoadedModel> get(const std::string& name);
  JobStatus status() const { return queue_.status(); }

 private:
  std::string wanted_;  ///< or read; empty: none
  std::optional<LoadedModel> model_ = LoadedModel{};
  TaskQueue<LoadedModel> queue_;
};

/// The input of the panels; what is referenced must outlive it.
struct PanelInput {
  const WorkbenchState& state;
  JobStatus worker = {}, survey = {}, scan = {};
  JobStatus writing = {};  ///< progress of a movie, report, export or saved recording
  bool timings = true;     ///< false: dashes instead of times, to make screenshots comparable
  bool hurries = false;    ///< images arrive: the scene is rendered without antialiasing
  ImageFetcher* fetcher = nullptr;  ///< null: drawing decodes images itself
  ModelReader* models = nullptr;    ///< null: drawing reads 3-D models itself
  FolderLister* lister = nullptr;   ///< null: folders look empty
  fs::path example = {};            ///< the recording that comes with the program
  bool opening = false;  ///< the results are of the old recording: another one is being opened
  float scale = 1;       ///< text scale: sizes are for 96 dpi times this; set by `draw_workbench`

  /// Returns the last finished inspection; null if none.
  const Inspection* inspection() const { return state.results.inspection.get(); }
  /// Returns the same input with another state.
  PanelInput with(const WorkbenchState& other) const;
};

/// A text field with a list of what matches it: the command palette, the file browser.
struct ListEntry {
  std::array<char, 1024> text{};
  int chosen = 0;          ///< row of the list; -1: the text itself
  bool open = false;       ///< in the last frame
  bool typed_out = false;  ///< `text` was set by the program: the field must take it over
  FolderList listed;       ///< entries of the browser's folder, in the last frame
};

/// An enlarged part of an image.
struct TrackPatch {
  ImageTexture texture;
  std::shared_ptr<const Recording> recording;
  int frame = -1;
  Vector2d middle_px = Vector2d::Zero();
  bool empty = true;  ///< there is no image
};

/// The cube that the mouse pressed and may drag.
struct PressedCube {
  std::optional<int> plane = {};  ///< number; nullopt: none
  Eigen::Vector2f center_px =
      Eigen::Vector2f::Zero();  ///< center of its base, relative to the mouse
  bool dragged = false;
};

/// Caches of the views, most of them in graphics memory. Needs its OpenGL context.
struct Views {
  ImageTexture image;
  cv::Mat pixels;                              ///< content of `image`; CV_8UC3, BGR
  std::shared_ptr<const Recording> recording;  ///< source of `image`
  int frame = -1;                              ///< frame in `image`; -1: none yet
  int requested = -1;                          ///< frame that is being fetched; -1: none
  std::string image_error;                     ///< why there is no image
  LegendHits legend_hits;                      ///< rows of the image's legend in the last frame
  SceneView scene;
  ListEntry palette, browser, sources;
  std::array<TrackPatch, 2> patches;        ///< a track in its first and in the current frame
  std::map<std::string, ChartView> charts;  ///< by name, see `chart_item`
  Cached<CurveInputs, CurveFacts> curves;
  Cached<std::shared_ptr<const Inspection>, WindowResiduals> residuals;
  TrackLives lives;
  Cached<std::pair<std::shared_ptr<const Inspection>, Coloring>, std::shared_ptr<const TrackColors>>
      colors;                              ///< null: colored by plane
  Cached<std::string, LoadedModel> model;  ///< by name
  Cached<std::shared_ptr<const Inspection>, std::vector<TrackRow>>
      tracks;  ///< in the order of the list
  Cached<std::shared_ptr<const Recording>, std::vector<ResultGroup>> recording_groups;
  NormalsMap normals;
  PressedCube pressed;
  TableOrder order;  ///< order of the compared results
  WindowImage window;
  float verdict_height = 0, settings_height = 0;  ///< content heights [px]; 0: unknown
  Rectangle settings;                             ///< place of the settings in the last frame
  std::vector<ContextSubject> context;            ///< subjects of the open context menu
  bool opens_context = false;                     ///< its menu opens in this frame
};

struct PanelContext : PanelInput {
  Views& views;
  Commands& commands;
  bool banner = false;  ///< a banner above the views says why the window failed
};

/// Returns the texts that may contain names of files, which need not be Latin.
std::vector<std::string_view> shown_names(const PanelInput& input, const Views& views);

/// Returns the image of a frame of a recording with images; without a fetcher, decodes it now.
FetchedImage image_of(const PanelInput& input, int frame);

/// Loads the current image. Returns the frame to draw: until it has come that of the last image.
int update_image(const PanelContext& ui);

/// Returns the image that `update_image` loaded; null if there is none.
ImageTexture* shown_image(Views& views);

/// Draws a part of the window through Dear ImGui; changes only the views and the commands.
using DrawPanel = void(const PanelContext& ui, const Rectangle& place);

DrawPanel settings_panel, results_panel, image_panel, timeline_panel, status_line, empty_panel;
/// The verdict with its reason, and ways out of a failure.
DrawPanel verdict_panel, failure_banner;
/// The findings below the verdict, between two places [px from the panel's left edge]; nothing if
/// there are none.
void findings_group(const PanelContext& ui, float left, float right);
/// State of a live source: what its window lacks to be ready, and how many images were dropped.
DrawPanel live_banner;
/// Both answers of an ambiguous window side by side, or one above the other.
/// One column for each compared configuration, in place of image and side pane.
DrawPanel compare_panel;
/// In front of the whole window.
DrawPanel help_overlay, palette_overlay, browser_overlay, sources_overlay;
/// One step of the tour, in a corner of the window.
DrawPanel tour_card;
/// Names of the side panes and of the drawers, which open them.
DrawPanel side_tabs, drawer_tabs;
/// Draws a pane, if any, into a panel unless that is hidden.
void draw_pane(const PanelContext& ui, const Rectangle& place, const char* panel, const Pane* pane);
void menu_bar(const PanelContext& ui);
/// Opens the context menu of the subjects at the mouse, the first one on top, and changes nothing
/// else.
void open_context_menu(const PanelContext& ui, std::vector<ContextSubject> subjects);
/// The open context menu.
void context_menu(const PanelContext& ui);
/// Returns whether the right button was clicked on the last item.
bool right_clicked(float scale);
/// Lines between the parts that can be dragged; a double click resets one.
void splitters(const PanelContext& ui, const WindowLayout& layout);

/// Returns whether the window was computed without a result.
bool has_failed(const PanelInput& input);

/// Returns the function that draws a pane's content into a panel; null for the whole window.
DrawPanel* draw_function(const Pane& pane);

/// Returns the options for the views. Updates the cached colors and model.
ViewOptions view_options(const PanelInput& input, Views& views);

/// Returns the selected and the hovered tracks as columns of the inspection's tracks.
Highlight highlight_of(const WorkbenchState& state);

ScreenRect screen_rect(const Rectangle& place);

/// Lets the mouse drag a cube in the image, the last item, along the cube's plane. `frame` counts
/// in the recording. Returns whether the mouse pressed a cube, which must not pan the image then.
bool drag_cube(const PanelContext& ui, int frame, const ImageMapping& mapping);

/// Lets the mouse orbit, move and zoom the scene, the last item, or drag a cube along its plane.
void orbit_and_zoom(const PanelContext& ui, const ScreenRect& rect, const OrbitCamera& camera);

/// Draws the picked points and those that set the scale, in the frame that shows them.
void draw_picked_points(const WorkbenchState& state,
                        const Area& area,
                        const FrameView& view,
                        const ImageMapping& mapping);

/// Returns whether the mouse draws a mask in the frame, the reference frame.
bool takes_mask(const WorkbenchState& state, int frame);
/// Adds a corner where the last item is clicked, or finishes the mask: after a drag a rectangle,
/// after a click at the first corner a polygon.
void draw_mask_by_mouse(const PanelContext& ui, const ImageMapping& mapping);
/// Draws the mask as far as it is drawn, and what to do.
void draw_unfinished_mask(const PanelContext& ui, const Area& area, const ImageMapping& mapping);

struct ChartItem {
  ChartMapping to;                     ///< values to screen pixels
  std::optional<double> hovered = {};  ///< value of the x axis under the mouse
  bool held = false;                   ///< the left button was pressed there and is down
};

/// Draws a chart with cursor and tooltip; a right click copies its data. `name`: of item and cache.
ChartItem chart_item(const std::string& name,
                     const Rectangle& place,
                     Views& views,
                     const Chart& chart,
                     bool legend = true);

/// Draws a draggable cursor at the current frame. `zero`: the frame (of the recording) at x = 0.
void drag_frame(const ChartItem& item, const PanelContext& ui, int zero, Role role);

/// Returns one sentence on the decompositions of a frame's homography; there must be at least one.
std::string candidates_sentence(std::span<const HomographyCandidate> candidates);

/// Returns why a frame (counts in the window, may be outside) has no decompositions, or "".
std::string why_no_candidates(const NormalStudy& study, int frame_in_window);

/// Returns normal, tilt, rotation, baseline, score and points behind a camera.
std::vector<std::string> candidate_cells(const HomographyCandidate& candidate);

/// Returns why there is no study of the shown window's normals, or ""; `doing` while it runs.
std::string why_no_study(const WorkbenchState& state, const std::string& doing);

struct GlossaryTerm {
  std::string term, meaning;
};

struct ManualLine {
  std::string text;  ///< empty: between paragraphs
  bool heading = false;
};

/// Returns the paragraphs of ui/README.md for users, without marks; it is embedded, too.
const std::vector<ManualLine>& manual();

/// Returns the rows of ui/GLOSSARY.md, which is embedded into the program.
const std::vector<GlossaryTerm>& glossary();

}  // namespace gpo
