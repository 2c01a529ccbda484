// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/context/window_image.h"
#include "ui/look/numbers.h"
#include "ui/panels/drawers/chart_item.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/overlay/overlay.h"
#include "ui/workbench/state.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr int kPatch_px = 31;
constexpr int kMagnification = 4;

constexpr ColumnText kLifeColumns[] = {
    {"frame", "Counts in the recording; click: go there"},
    {"x", "Where it is seen, in the picture as it was recorded"},
    {"y", "Where it is seen, in the picture as it was recorded"},
    {"transfer", "Transfer error of the frame's own homography: what RANSAC decides by"},
    {"residual", "From there to where the result's plane and poses put it"},
    {"fwd-bwd", "How far the way from the frame before and back ends from where it began"},
    {"", "Inlier: a green circle; outlier: a red cross"}};

void header() {
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const ColumnText& column : kLifeColumns) ImGui::TableSetupColumn(column.title);
  table_header(kLifeColumns);
}

void draw_row(const TrackFrame& frame, bool current, Commands& commands) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const std::string label = std::to_string(frame.frame);
  if (ImGui::Selectable(label.c_str(), current, ImGuiSelectableFlags_SpanAllColumns))
    push(commands, GoToFrame{frame.frame});
  for (const std::string& text : {fmt::format("{:.2f}", frame.raw_px.x()),
                                  fmt::format("{:.2f}", frame.raw_px.y()),
                                  two_decimals(frame.transfer_px),
                                  two_decimals(frame.residual_px),
                                  two_decimals(frame.forward_backward_px)}) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(text.c_str());
  }
  ImGui::TableNextColumn();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float half = ImGui::GetTextLineHeight() / 2;
  draw_sign(*ImGui::GetWindowDrawList(),
            frame.inlier ? Sign::circle : Sign::cross,
            {at.x + half, at.y + half},
            frame.inlier ? color_of(Role::inlier) : color_of(Role::outlier));
}

void draw_table(const TrackLife& life, int frame, float width, float height, Commands& commands) {
  const auto flags =
      ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg;
  if (!ImGui::BeginTable("life", static_cast<int>(std::size(kLifeColumns)), flags, {width, height}))
    return;
  ImGui::PushFont(font(Font::small));
  header();
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(life.frames.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      draw_row(life.frames[i], life.frames[i].frame == frame, commands);
  ImGui::PopFont();
  ImGui::EndTable();
}

/// Its errors frame by frame.
Chart life_chart(const TrackLife& life) {
  Chart chart{"", "frame", "error [px]", false, {}};
  const auto add = [&](const char* name, std::uint32_t rgb, auto TrackFrame::*value) {
    Curve curve{name, rgb, false, {}, {}, {}, {}};
    for (const TrackFrame& frame : life.frames) {
      curve.x.push_back(frame.frame);
      curve.y.push_back((frame.*value).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    chart.curves.push_back(std::move(curve));
  };
  add("transfer", color_of(Role::inlier), &TrackFrame::transfer_px);
  add("residual", color_of(Role::residual), &TrackFrame::residual_px);
  add("fwd-bwd", color_of(Role::rotation), &TrackFrame::forward_backward_px);
  return chart;
}

void draw_plot(const PanelInput& input,
               const Rectangle& place,
               const TrackLife& life,
               Views& views,
               Commands& commands) {
  const ChartItem item = chart_item("track life", place, views, life_chart(life));
  drag_frame(item, input.state, 0, color_of(Role::accent), commands);
}

/// The surroundings of a place of a picture, enlarged; its middle is the place, to a part of a
/// pixel.
cv::Mat patch_at(const cv::Mat& image, const Eigen::Vector2d& raw_px) {
  cv::Mat patch;
  cv::getRectSubPix(image,
                    {kPatch_px, kPatch_px},
                    cv::Point2f(static_cast<float>(raw_px.x()), static_cast<float>(raw_px.y())),
                    patch);
  cv::resize(patch, patch, {}, kMagnification, kMagnification, cv::INTER_NEAREST);
  return patch;
}

/// Brings the place into the texture, where it is not there yet. Until its picture is there the
/// last one stays. Where there is none, the picture's own panel says why.
void update(TrackPatch& patch, const PanelInput& input, const TrackFrame& frame) {
  const auto& recording = input.state.document.recording;
  const bool another = patch.recording != recording;
  if (!another && patch.frame == frame.frame && patch.middle_px == frame.raw_px) return;
  const FetchedImage image =
      recording->images ? image_of(input, frame.frame) : FetchedImage{};
  if (image.waiting && !another) return;
  patch.recording = image.waiting ? nullptr : recording;
  patch.frame = frame.frame;
  patch.middle_px = frame.raw_px;
  patch.empty = image.bgr.empty();
  if (!patch.empty) patch.texture.upload(patch_at(image.bgr, frame.raw_px));
}

void draw_patch(const TrackPatch& patch, const char* what, float scale) {
  ImGui::BeginGroup();
  ImGui::TextUnformatted(fmt::format("{}, frame {}", what, patch.frame).c_str());
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

/// In its first frame and in the current one, or the nearest before that sees it.
void draw_patches(const PanelInput& input, const TrackLife& life, Views& views) {
  const TrackFrame* now = &life.frames.front();
  for (const TrackFrame& frame : life.frames)
    if (frame.frame <= input.state.view.frame) now = &frame;
  update(views.patches[0], input, life.frames.front());
  update(views.patches[1], input, *now);
  draw_patch(views.patches[0], "First", input.scale);
  ImGui::SameLine();
  draw_patch(views.patches[1], "Now", input.scale);
}

}  // namespace

void track_drawer(const PanelInput& input,
                  const Rectangle& place,
                  Views& views,
                  Commands& commands) {
  const Inspection* inspection = input.inspection();
  const auto& focus = input.state.selection.focus;
  const auto column = inspection && focus ? column_of(*inspection->tracks, *focus) : std::nullopt;
  if (!column)
    return draw_empty(place,
                      "Click a track in the picture or a point in the scene: its whole life "
                      "appears here. Ctrl+click picks several, Shift+drag all in a rectangle");
  const TrackLife& life = views.lives.of(*inspection, *column);
  if (life.frames.empty()) return draw_empty(place, "The track is not seen in this window");
  const float s = input.scale;
  ImGui::SetCursorPos({12 * s, 6 * s});
  ImGui::BeginGroup();
  ImGui::PushFont(font(Font::bold));
  ImGui::TextUnformatted(fmt::format("Track {}", life.id).c_str());
  ImGui::PopFont();
  ImGui::SameLine();
  clipped_text(life.verdict + " \u00b7 places and errors in px",
               place.width - 120 * s,
               color_of(Role::text_dim));
  const float top = ImGui::GetCursorPosY();
  const float patches = (2 * kPatch_px * kMagnification + 20) * s;
  const float rest = place.width - patches - 24 * s;
  const float table = std::round(std::max(0.55F * rest, std::min(rest, 420 * s)));
  draw_table(life, input.state.view.frame, table, place.height - top, commands);
  ImGui::EndGroup();
  if (rest - table > 160 * s)
    draw_plot(input,
              {place.x + 12 * s + table, place.y + top, rest - table, place.height - top},
              life,
              views,
              commands);
  ImGui::SetCursorPos({place.width - patches, top});
  draw_patches(input, life, views);
}

}  // namespace gpo
