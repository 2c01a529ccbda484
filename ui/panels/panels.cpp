// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panels.h"

#include "engine/base/error.h"
#include "ui/context/imgui_versions.h"
#include "ui/views/model/solid_model.h"

#include <algorithm>

namespace gpo {

// A pane's function is declared and named by the key of its row in `panes()`.
DrawPanel image_alone, compare_alone, scene_pane, normals_pane, solver_pane, candidates_pane;
DrawPanel curves_drawer, table_drawer, residuals_drawer, timing_drawer, track_drawer, tracks_drawer,
    camera_drawer, log_drawer;
namespace {

using PaneDrawing = std::pair<std::string_view, DrawPanel*>;
constexpr auto kDrawings = std::to_array<PaneDrawing>({{"image", image_alone},
                                                       {"scene", scene_pane},
                                                       {"normals", normals_pane},
                                                       {"solver", solver_pane},
                                                       {"candidates", candidates_pane},
                                                       {"compare", compare_alone},
                                                       {"curves", curves_drawer},
                                                       {"table", table_drawer},
                                                       {"residuals", residuals_drawer},
                                                       {"timing", timing_drawer},
                                                       {"track", track_drawer},
                                                       {"tracks", tracks_drawer},
                                                       {"camera", camera_drawer},
                                                       {"log", log_drawer}});

/// Returns whether the image, or the reason why there is none, has come into the views.
bool load_image(const PanelContext& ui, int frame) {
  const FetchedImage image = image_of(ui, frame);
  if (image.waiting) return false;
  ui.views.frame = frame;
  ui.views.image_error = image.error;
  ui.views.pixels = image.bgr;
  if (!image.bgr.empty()) ui.views.image.upload(image.bgr);
  return true;
}

LoadedModel load_model(const std::string& name) {
  if (name.empty()) return {};
  try {
    return {std::make_shared<const SolidModel>(read_solid_model(name)), ""};
  } catch (const InputError& error) {
    return {nullptr, error.what()};
  }
}

/// Returns the last model until the current one is read.
const LoadedModel& model_of(const PanelInput& input, Views& views) {
  const std::string& name = input.state.document.model;
  Cached<std::string, LoadedModel>& cached = views.model;
  if (input.models == nullptr) {
    cached.update(name, [&] { return load_model(name); });
  } else if (cached.of != name) {
    if (auto read = input.models->get(name)) cached = {name, *read};
  }
  return cached.value;
}

}  // namespace

PanelInput PanelInput::with(const WorkbenchState& other) const {
  // The compiler refuses a list that lacks a member.
  const auto& [own, w, sv, sc, wr, t, h, f, m, l, e, o, s] = *this;
  return {other, w, sv, sc, wr, t, h, f, m, l, e, o, s};
}

std::vector<std::string_view> shown_names(const PanelInput& input, const Views& views) {
  const auto& [document, files] = std::tie(input.state.document, input.state.files);
  const MessageLog& messages = input.state.messages;
  std::vector<std::string_view> names{messages.text,
                                      input.worker.error,
                                      input.worker.stage,
                                      input.example.native(),
                                      files.session_file.native(),
                                      document.model,
                                      input.state.results.experiment_name,
                                      views.browser.text.data(),
                                      views.palette.text.data()};
  for (const LogLine& line : messages.lines) names.push_back(line.text);
  for (const fs::path& recent : files.recent) names.push_back(recent.native());
  for (const Bookmark& bookmark : document.bookmarks) names.push_back(bookmark.note);
  for (const FolderEntry& entry : views.browser.listed.entries) names.push_back(entry.name);
  if (input.state.view.sources)
    for (const CameraDevice& camera : *input.state.view.sources) names.push_back(camera.name);
  if (!document.recording) return names;
  names.push_back(document.recording->name);
  names.push_back(document.recording->path.native());
  for (const std::string& note : document.recording->notes) names.push_back(note);
  return names;
}

FetchedImage image_of(const PanelInput& input, int frame) {
  const auto& images = input.state.document.recording->images;
  return input.fetcher != nullptr ? input.fetcher->get(images, frame) : fetch_image(*images, frame);
}

int update_image(const PanelContext& ui) {
  const WorkbenchState& state = ui.state;
  Views& views = ui.views;
  if (views.recording != state.document.recording) {
    views.recording = state.document.recording;
    views.frame = views.requested = -1;
    views.image_error.clear();
  }
  if (!state.document.recording->images) return state.view.frame;
  // Shown late, too: if decoding is slower than playback, no image would ever be in time.
  if (views.requested >= 0 && load_image(ui, views.requested)) views.requested = -1;
  if (views.requested < 0 && views.frame != state.view.frame) {
    const int next = state.view.frame + 1;  // prefetched for playback
    if (state.view.playing && ui.fetcher != nullptr && next < state.frame_count())
      image_of(ui, next);
    if (!load_image(ui, state.view.frame)) views.requested = state.view.frame;
  }
  return views.frame >= 0 ? views.frame : state.view.frame;
}

ImageTexture* shown_image(Views& views) {
  const bool loaded =
      views.recording && views.recording->images && views.frame >= 0 && views.image_error.empty();
  return loaded ? &views.image : nullptr;
}

std::optional<LoadedModel> ModelReader::get(const std::string& name) {
  if (name != wanted_) {
    wanted_ = name;
    queue_.cancel();
    queue_.take();  // a model that is no longer wanted
    model_.reset();
    if (name.empty())
      model_.emplace();
    else
      queue_.add([name](const Progress& progress) {
        progress("reading " + fs::path(name).filename().string(), 0, 0);
        return load_model(name);
      });
  } else if (std::vector<LoadedModel> read = queue_.take(); !read.empty()) {
    model_ = std::move(read.front());
  }
  return model_;
}

ViewOptions view_options(const PanelInput& input, Views& views) {
  const WorkbenchState& state = input.state;
  constexpr double kTowerSides = 5;
  const auto& inspection = state.results.inspection;
  views.colors.update({inspection, state.view.coloring}, [&] {
    return inspection ? track_colors(*inspection, state.view.coloring) : nullptr;
  });
  const auto& [model, error] = model_of(input, views);
  ViewOptions options{.show = state.view.toggles,
                      .cube_side = state.document.cube_side,
                      .cube_height_sides = model                      ? model->height_sides
                                           : state.view.toggles.tower ? kTowerSides
                                                                      : 1,
                      .model = model,
                      .model_error = error,
                      .colors = views.colors.value,
                      .after = state.results.after};
  options.show.legend &= inspection != nullptr;
  return options;
}

Highlight highlight_of(const WorkbenchState& state) {
  Highlight highlight;
  if (!state.results.inspection) return highlight;
  const Tracks& tracks = *state.results.inspection->tracks;
  for (const std::int64_t id : state.selection.tracks)
    if (const auto column = column_of(tracks, id)) highlight.picked.push_back(*column);
  for (const Finding& finding : state.results.inspection->findings)
    if (finding.key == state.hover.finding)
      for (const std::int64_t id : tracks_of({&finding, 1}, tracks))
        highlight.picked.push_back(*column_of(tracks, id));
  if (state.selection.focus) highlight.focus = column_of(tracks, *state.selection.focus);
  if (state.hover.track) highlight.hovered = column_of(tracks, *state.hover.track);
  if (state.hover.camera) highlight.camera = *state.hover.camera - tracks.start;
  return highlight;
}

ScreenRect screen_rect(const Rectangle& place) {
  return {{place.x, place.y}, {place.width, place.height}};
}

DrawPanel* draw_function(const Pane& pane) {
  const auto found = std::ranges::find(kDrawings, pane.key, &PaneDrawing::first);
  return found == kDrawings.end() ? nullptr : found->second;
}

void draw_pane(const PanelContext& ui,
               const Rectangle& place,
               const char* panel,
               const Pane* pane) {
  if (pane == nullptr || place.empty()) return;
  if (pane->covers) ImGui::SetNextWindowBgAlpha(0);
  const PanelScope scope(panel, place, {0, 0});
  draw_function (*pane)(ui, place);
}

PanelScope::PanelScope(const char* name, const Rectangle& place, ImVec2 padding, PanelKind kind) {
  ImGui::SetNextWindowPos({place.x, place.y});
  ImGui::SetNextWindowSize({place.width, place.height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
  // The default minimum size would make small parts overlap.
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  const bool over = kind == PanelKind::over;
  ImGui::Begin(name,
               nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                   (over ? ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoFocusOnAppearing
                         : ImGuiWindowFlags_NoBringToFrontOnFocus) |
                   (kind == PanelKind::scrolling ? 0 : ImGuiWindowFlags_NoScrollbar));
  ImGui::PopStyleVar(3);  // tooltips and popups inside have their own
}

PanelScope::~PanelScope() { ImGui::End(); }

bool hit_area(const char* name, ImVec2 size, ImGuiButtonFlags buttons) {
  return ImGui::InvisibleButton(name, {std::max(1.0F, size.x), std::max(1.0F, size.y)}, buttons);
}

bool hit_area_at(const char* name, const Rectangle& place) {
  ImGui::SetCursorScreenPos({place.x, place.y});
  return hit_area(name, {place.width, place.height});
}

Vector2d mouse_px() { return {ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y}; }

bool is_click(float scale, int button) {
  const ImVec2& pressed = ImGui::GetIO().MouseClickedPos[button];
  return (mouse_px() - Vector2d(pressed.x, pressed.y)).norm() < 4 * scale;
}

double wheel_zoom() {
  return ImGui::IsItemHovered() ? std::pow(1.25, ImGui::GetIO().MouseWheel) : 1;
}

Vector2d drag_px() {
  if (!ImGui::IsItemActive()) return Vector2d::Zero();
  return {ImGui::GetIO().MouseDelta.x, ImGui::GetIO().MouseDelta.y};
}

double current_drag() {
  const ImGuiIO& io = ImGui::GetIO();
  return io.MouseDown[ImGuiMouseButton_Left] ? io.MouseClickedTime[ImGuiMouseButton_Left] : 0;
}

bool is_item_double_clicked() {
  return ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
}

void draw_empty(const Rectangle& place, const std::string& text) {
  const float wrap = place.width * 0.8F;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(
      {place.x, place.y}, {place.right(), place.bottom()}, imgui_color(Role::scene_bottom));
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  const ImVec2 at(std::round(place.x + (place.width - size.x) / 2),
                  std::round(place.y + (place.height - size.y) / 2));
  const ImU32 color = imgui_color(Role::text_dim);
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, color, text.c_str(), nullptr, wrap);
}

void marked_name(Sign sign, std::uint32_t rgb, const std::string& name, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  sign_at_cursor(sign, rgb);
  ImGui::SetCursorScreenPos({at.x + 18 * scale, at.y});
  ImGui::TextUnformatted(name.c_str());
}

void sign_at_cursor(Sign sign, std::uint32_t rgb) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float half = ImGui::GetTextLineHeight() / 2;
  draw_sign(*ImGui::GetWindowDrawList(), sign, {at.x + half, at.y + half}, rgb);
}

void colored_text(std::uint32_t rgb, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(rgb));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}

void colored_text(Role role, const std::string& text) { colored_text(color_of(role), text); }

void continue_line_at(float x) {
  ImGui::SameLine();
  ImGui::SetCursorPosX(std::round(x));
}

void fitted_text(const std::string& text, float right) {
  const bool fits = ImGui::GetCursorPosX() + ImGui::CalcTextSize(text.c_str()).x <= right;
  ImGui::PushFont(fits ? ImGui::GetFont() : font(Font::small));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopFont();
}

Role role_of(Severity severity, Role note) {
  if (severity == Severity::error) return Role::bad;
  return severity == Severity::warning ? Role::warning : note;
}

void text_in(Font which, std::uint32_t rgb, const std::string& text) {
  ImGui::PushFont(font(which));
  colored_text(rgb, text);
  ImGui::PopFont();
}

void wrapped_text(const std::string& text, float right) {
  ImGui::PushTextWrapPos(right);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
}

void heading(const char* text) { text_in(Font::small, color_of(Role::text_dim), text); }

void tooltip(const std::string& text) {
  if (!text.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
    show_tooltip(text);
}

void show_tooltip(const std::string& text) {
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1.0F);  // opaque for a disabled item, too
  ImGui::BeginTooltip();
  wrapped_text(text, ImGui::GetFontSize() * 22);
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

void clipped_text(const std::string& text, float width, std::uint32_t rgb) {
  std::string shown = text;
  const auto too_wide = [&] { return ImGui::CalcTextSize(shown.c_str()).x > width; };
  for (std::size_t end = text.size(); end > 1 && too_wide();) {
    do --end;
    while (end > 1 && (text[end] & 0xC0) == 0x80);  // within a code point of UTF-8
    shown = text.substr(0, end) + "...";
  }
  colored_text(rgb, shown);
  if (shown != text) tooltip(text);
}

}  // namespace gpo
