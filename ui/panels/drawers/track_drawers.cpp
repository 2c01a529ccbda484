// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The life of the selected track, and the list of all tracks.
#include "engine/base/error.h"
#include "engine/inspection/studies/studies.h"
#include "ui/panels/panels.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr int kPatch_px = 31;
constexpr int kMagnification = 4;

constexpr ColumnText kLifeColumns[] = {
    {"frame", "Frame of the recording. Click to go there"},
    {"x", "Position in the image as recorded"},
    {"y", "Position in the image as recorded"},
    {"transfer", "Transfer error by the frame's homography: decides whether it is an inlier"},
    {"at most", "Limit of the transfer error in this frame; a dash if the window decides"},
    {"residual", "Residual of the solution: distance to where plane and poses predict it"},
    {"fwd-bwd", "Forward-backward error: distance after tracking to the next frame and back"},
    {"", "Inlier: a circle in the color of its plane; outlier: a red cross"}};

constexpr std::array<ColumnText, 7> kTrackColumns{
    {{"track", "Id. Click to select, Ctrl+click to add or remove, Shift+click for a range"},
     {"seen", "Frames that see it, without the reference frame"},
     {"inlier", "Number of these in which it is an inlier of its plane"},
     {"plane", "Its plane of the window; 1 has the most tracks"},
     {"residual [px]", "RMS residual of the solution in the frames where it is an inlier"},
     {"depth [d]", "Depth in the reference camera, in plane distances d"},
     {"verdict", "Inlier, or the reason for rejection"}}};
constexpr ColumnText kDepthInMeters{"depth [m]", "Depth in the reference camera, in meters"};

void text_cells(std::initializer_list<std::string> texts) {
  for (const std::string& text : texts) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(text.c_str());
  }
}

void draw_frame(const PanelContext& ui, const TrackLife& life, const TrackFrame& frame) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const std::string label = std::to_string(frame.frame);
  const bool current = frame.frame == ui.state.view.frame;
  if (ImGui::Selectable(label.c_str(), current, ImGuiSelectableFlags_SpanAllColumns))
    push(ui.commands, GoToFrame{frame.frame});
  text_cells({two_decimals(frame.raw_px.x()), two_decimals(frame.raw_px.y())});
  text_cells({two_decimals(frame.transfer_px), two_decimals(frame.limit_px)});
  text_cells({two_decimals(frame.residual_px), two_decimals(frame.forward_backward_px)});
  ImGui::TableNextColumn();
  const Inspection& inspection = *ui.inspection();
  const SignStyle look =
      track_style(inspection, frame.frame - inspection.window->start, life.column);
  sign_at_cursor(look.sign, look.rgb);
  ImGui::Dummy({ImGui::GetTextLineHeight(), 0});  // the column is as wide as the sign
}

void draw_life(const PanelContext& ui, const TrackLife& life, const ImVec2& size) {
  const auto flags =
      ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg;
  if (!ImGui::BeginTable("life", static_cast<int>(std::size(kLifeColumns)), flags, size)) return;
  ImGui::PushFont(font(Font::small));
  frozen_header(kLifeColumns);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(life.frames.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      draw_frame(ui, life, life.frames[i]);
  ImGui::PopFont();
  ImGui::EndTable();
}

Chart life_chart(const TrackLife& life) {
  Chart chart{"", "frame", "error [px]", false, {}};
  const auto add = [&](const char* name, Role role, auto TrackFrame::*value, bool dotted = false) {
    Curve curve{name, color_of(role), dotted, {}, {}, {}, {}};
    for (const TrackFrame& frame : life.frames) {
      curve.x.push_back(frame.frame);
      curve.y.push_back((frame.*value).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    chart.curves.push_back(std::move(curve));
  };
  add("transfer", Role::inlier, &TrackFrame::transfer_px);
  add("at most", Role::inlier, &TrackFrame::limit_px, true);
  add("residual", Role::residual, &TrackFrame::residual_px);
  add("fwd-bwd", Role::rotation, &TrackFrame::forward_backward_px);
  return chart;
}

/// Returns the enlarged surroundings of a subpixel position, which is in the middle, turned as the
/// image is shown.
cv::Mat patch_at(const cv::Mat& image, const Vector2d& raw_px, int quarter_turns) {
  cv::Mat patch;
  const Eigen::Vector2f at = raw_px.cast<float>();
  cv::getRectSubPix(image, {kPatch_px, kPatch_px}, {at.x(), at.y()}, patch);
  cv::resize(patch, patch, {}, kMagnification, kMagnification, cv::INTER_NEAREST);
  if (quarter_turns > 0) cv::rotate(patch, patch, quarter_turns - 1);  // 0: a quarter clockwise
  return patch;
}

/// Uploads the patch if it is another one. The last one stays until its image has come.
void update(TrackPatch& patch, const PanelInput& input, const TrackFrame& frame) {
  const auto& recording = input.state.document.recording;
  const bool another = patch.recording != recording;
  if (!another && patch.frame == frame.frame && patch.middle_px == frame.raw_px) return;
  const FetchedImage image = recording->images ? image_of(input, frame.frame) : FetchedImage{};
  if (image.waiting && !another) return;
  patch.recording = image.waiting ? nullptr : recording;
  patch.frame = frame.frame;
  patch.middle_px = frame.raw_px;
  patch.empty = image.bgr.empty();
  if (!patch.empty)
    patch.texture.upload(patch_at(image.bgr, frame.raw_px, recording->quarter_turns));
}

void draw_patch(const TrackPatch& patch, const char* title, float scale) {
  ImGui::BeginGroup();
  ImGui::TextUnformatted(fmt::format("{}, frame {}", title, patch.frame).c_str());
  const float side = kPatch_px * kMagnification * scale;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 end(at.x + side, at.y + side);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, end, imgui_color(Role::raised));
  if (!patch.empty) {
    mark_content(list, patch.texture.revision());
    list.AddImage(patch.texture.id(), at, end);
    const ImU32 color = imgui_color(Role::selected, 0.7);
    const float middle = side / 2, arm = 8 * scale;
    list.AddLine({at.x + middle - arm, at.y + middle}, {at.x + middle + arm, at.y + middle}, color);
    list.AddLine({at.x + middle, at.y + middle - arm}, {at.x + middle, at.y + middle + arm}, color);
  }
  ImGui::Dummy({side, side});
  ImGui::EndGroup();
}

/// Draws the patches in the first frame and in the last one up to the current that sees the track.
void draw_patches(const PanelContext& ui, const TrackLife& life) {
  const TrackFrame* now = &life.frames.front();
  for (const TrackFrame& frame : life.frames)
    if (frame.frame <= ui.state.view.frame) now = &frame;
  update(ui.views.patches[0], ui, life.frames.front());
  update(ui.views.patches[1], ui, *now);
  draw_patch(ui.views.patches[0], "First", ui.scale);
  ImGui::SameLine();
  draw_patch(ui.views.patches[1], "Now", ui.scale);
}

void sorting_header(bool in_meters, float scale) {
  auto columns = kTrackColumns;
  if (in_meters) columns[static_cast<std::size_t>(TrackColumn::depth)] = kDepthInMeters;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const ColumnText& column : columns) {
    const bool last = &column == &columns.back();
    ImGui::TableSetupColumn(column.title,
                            last ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_None,
                            last ? 0 : 92 * scale);
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const ColumnText& column : columns) {
    ImGui::TableNextColumn();
    ImGui::TableHeader(column.title);
    tooltip(column.meaning);
  }
}

const std::vector<TrackRow>& sorted_rows(const PanelContext& ui) {
  auto& cached = ui.views.tracks;
  ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  const bool another =
      cached.update(ui.state.results.inspection, [&] { return track_rows(*ui.inspection()); });
  if (specs != nullptr && specs->SpecsCount > 0 && (another || specs->SpecsDirty)) {
    const ImGuiTableColumnSortSpecs& by = specs->Specs[0];
    sort_tracks(cached.value,
                static_cast<TrackColumn>(by.ColumnIndex),
                by.SortDirection == ImGuiSortDirection_Descending);
    specs->SpecsDirty = false;
  }
  return cached.value;
}

/// Returns the ids between the focus and a row, in the order of the list.
std::vector<std::int64_t> range_to(const std::vector<TrackRow>& rows,
                                   const Selection& selection,
                                   std::size_t to) {
  const auto from = std::ranges::find(rows, selection.focus.value_or(rows[to].id), &TrackRow::id);
  const auto focus = from == rows.end() ? to : static_cast<std::size_t>(from - rows.begin());
  const auto [first, last] = std::minmax({to, focus});
  std::vector<std::int64_t> ids;
  for (std::size_t i = first; i <= last; ++i) ids.push_back(rows[i].id);
  return ids;
}

void draw_track(const PanelContext& ui, const std::vector<TrackRow>& rows, std::size_t i) {
  const Selection& selection = ui.state.selection;
  const TrackRow& row = rows[i];
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  if (ImGui::Selectable(std::to_string(row.id).c_str(),
                        selection.contains(row.id),
                        ImGuiSelectableFlags_SpanAllColumns)) {
    const ImGuiIO& io = ImGui::GetIO();
    push(ui.commands,
         SelectTracks{io.KeyShift  ? selected(range_to(rows, selection, i))
                      : io.KeyCtrl ? toggled(selection, row.id)
                                   : selected({&row.id, 1})});
  }
  if (ImGui::IsItemHovered()) push(ui.commands, HoverOver{{row.id}});
  if (right_clicked(ui.scale)) open_context_menu(ui, {track_subject(*ui.inspection(), row.id)});
  const std::string plane = row.plane ? std::to_string(*row.plane) : "\u2013";
  text_cells({std::to_string(row.seen), std::to_string(row.inlier), plane});
  const double unit = known_scale(*ui.inspection()).value_or(1);
  const auto depth = row.depth ? std::optional(unit * *row.depth) : std::nullopt;
  text_cells({two_decimals(row.rms_px), two_decimals(depth), row.verdict});
  if (ImGui::GetItemRectSize().x > ImGui::GetContentRegionAvail().x) tooltip(row.verdict);
}

/// Buttons that copy the list, or its selected rows.
void copy_buttons(const PanelContext& ui) {
  std::vector<TrackRow> rows = ui.views.tracks.value;
  ImGui::SameLine();
  if (ImGui::SmallButton("Copy all as CSV")) ImGui::SetClipboardText(to_csv(rows).c_str());
  const Selection& selection = ui.state.selection;
  if (selection.tracks.empty()) return;
  ImGui::SameLine();
  if (!ImGui::SmallButton("Copy the selection as CSV")) return;
  std::erase_if(rows, [&](const TrackRow& row) { return !selection.contains(row.id); });
  ImGui::SetClipboardText(to_csv(rows).c_str());
}

void draw_tracks_list(const PanelContext& ui, const ImVec2& size) {
  const auto flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingFixedFit |
                     ImGuiTableFlags_RowBg | ImGuiTableFlags_Sortable;
  if (!ImGui::BeginTable("tracks", static_cast<int>(std::size(kTrackColumns)), flags, size)) return;
  sorting_header(known_scale(*ui.inspection()).has_value(), ui.scale);
  const std::vector<TrackRow>& rows = sorted_rows(ui);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(rows.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      draw_track(ui, rows, static_cast<std::size_t>(i));
  ImGui::EndTable();
}

}  // namespace

void track_drawer(const PanelContext& ui, const Rectangle& place) {
  const Inspection* inspection = ui.inspection();
  const auto& focus = ui.state.selection.focus;
  const auto column = inspection && focus ? column_of(*inspection->tracks, *focus) : std::nullopt;
  if (!column)
    return draw_empty(place,
                      "Click a track in the image or a point in the scene to see its life here. "
                      "Ctrl+click adds one to the selection, Shift+drag selects a rectangle");
  const TrackLife& life = ui.views.lives.of(*inspection, *column);
  if (life.frames.empty()) return draw_empty(place, "The track is not seen in this window");
  const float s = ui.scale;
  ImGui::SetCursorPos({12 * s, 6 * s});
  ImGui::BeginGroup();
  text_in(Font::bold, color_of(Role::text), fmt::format("Track {}", life.id));
  ImGui::SameLine();
  clipped_text(life.verdict + " \u00b7 positions and errors in px",
               place.width - 120 * s,
               color_of(Role::text_dim));
  if (const auto plane = to_main_plane(*inspection, life.id)) {
    const Action& action = action_named("main-plane");
    const std::string title = fmt::format("Make plane {} the main one", *plane);
    if (ImGui::SmallButton(title.c_str())) push(ui.commands, RunAction{action.name});
    tooltip(action.tooltip);
  }
  const float top = ImGui::GetCursorPosY();
  const float height = place.height - top;
  const float patches = (2 * kPatch_px * kMagnification + 20) * s;
  const float rest = place.width - patches - 24 * s;
  const float table = std::round(std::max(0.55F * rest, std::min(rest, 420 * s)));
  draw_life(ui, life, {table, height});
  ImGui::EndGroup();
  if (rest - table > 160 * s) {
    const Rectangle plot{place.x + 12 * s + table, place.y + top, rest - table, height};
    drag_frame(chart_item("track life", plot, ui.views, life_chart(life)), ui, 0, Role::accent);
  }
  ImGui::SetCursorPos({place.width - patches, top});
  draw_patches(ui, life);
}

void tracks_drawer(const PanelContext& ui, const Rectangle& place) {
  if (!ui.inspection()) return draw_empty(place, "Tracks appear once the window is computed");
  const float s = ui.scale;
  ImGui::SetCursorPos({12 * s, 6 * s});
  ImGui::BeginGroup();
  ImGui::PushFont(font(Font::small));
  const Window& window = *ui.inspection()->window;
  colored_text(Role::text_dim,
               fmt::format("{}, {} lost, {} selected \u00b7 click a column title to sort",
                           counted(ui.inspection()->tracks->track_count(), "track"),
                           lost_count(window, window.frame_count() - 1),
                           ui.state.selection.tracks.size()));
  copy_buttons(ui);
  const float top = ImGui::GetCursorPosY();
  draw_tracks_list(ui, {place.width - 24 * s, place.height - top});
  ImGui::PopFont();
  ImGui::EndGroup();
}

}  // namespace gpo
