// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/normals/normals_view.h"

#include "engine/geometry/pose.h"
#include "engine/inspection/plane_names.h"
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/context/window_image.h"
#include "ui/look/numbers.h"
#include "ui/views/charts/axis_ticks.h"
#include "ui/views/normals/normals_disc.h"
#include "ui/views/overlay/overlay.h"
#include "ui/views/overlay/plane_style.h"
#include "ui/views/scene/plane_grid.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Above and below the disc, at scale 1 [px].
constexpr double kAboveDisc = 44, kBelowDisc = 66;

/// What the parts of the drawing share.
struct Stage {
  ImDrawList& list;
  const DiscMapping& to;
  const NormalsContent& content;
  float s;  ///< pixels of 96 dpi

  ImVec2 at(const Vector3d& normal) const { return at(disc_from_normal(normal)); }
  ImVec2 at(const Vector2d& disc) const { return to_imgui(to.to_screen(disc)); }
  /// Lighter the later.
  std::uint32_t color_of_frame(int frame_in_window) const {
    const double share = frame_in_window / std::max(1.0, content.frames() - 1.0);
    return mixed_rgb(color_of(Role::active), color_of(Role::text), 0.2 + 0.8 * share);
  }
};

/// What the current answer says of the planes that do not lead.
std::vector<PlaneEstimate> other_estimates(const NormalsContent& content) {
  std::vector<PlaneEstimate> others;
  if (content.answers.empty() || !content.answers.front().current) return others;
  const Inspection& inspection = *content.answers.front().inspection;
  for (const PlaneEstimate& plane : inspection.initialization->planes)
    if (plane.number != inspection.window->leader) others.push_back(plane);
  return others;
}

void line_on(const Stage& stage,
             const std::vector<Vector2d>& disc,
             std::uint32_t rgb,
             float width,
             bool closed,
             double alpha = 1) {
  std::vector<ImVec2> points;
  points.reserve(disc.size());
  for (const Vector2d& point : disc) points.push_back(stage.at(point));
  const auto draw = [&](ImU32 color, float thickness) {
    stage.list.AddPolyline(points.data(),
                           static_cast<int>(points.size()),
                           color,
                           closed ? ImDrawFlags_Closed : 0,
                           thickness);
  };
  draw(imgui_color(Role::background, 0.5 * alpha), width + 2 * stage.s);
  draw(imgui_color(rgb, alpha), width);
}

void small_text(const Stage& stage, const ImVec2& middle, const std::string& text) {
  const ImFont* f = font(Font::small);
  const ImVec2 size = f->CalcTextSizeA(f->FontSize, INFINITY, 0, text.c_str());
  const ImVec2 at(std::round(middle.x - size.x / 2), std::round(middle.y - size.y / 2));
  stage.list.AddText(
      f, f->FontSize, {at.x + 1, at.y + 1}, imgui_color(Role::background, 0.7), text.c_str());
  stage.list.AddText(f, f->FontSize, at, imgui_color(Role::text), text.c_str());
}

void draw_map(const Stage& stage, const NormalsMap& map) {
  mark_content(stage.list, map.texture().revision());
  stage.list.AddImage(map.texture().id(), stage.at(Vector2d(-1, -1)), stage.at(Vector2d(1, 1)));
  const ImVec2 low = stage.list.GetClipRectMin(), high = stage.list.GetClipRectMax();
  for (const auto& [from, to] : map.contours()) {
    const ImVec2 a = stage.at(from), b = stage.at(to);
    const bool outside = std::max(a.x, b.x) < low.x || std::min(a.x, b.x) > high.x ||
                         std::max(a.y, b.y) < low.y || std::min(a.y, b.y) > high.y;
    if (!outside) stage.list.AddLine(a, b, imgui_color(Role::background, 0.55), stage.s);
  }
}

/// Tilts, and what it means for a plane to lie there.
void draw_rings(const Stage& stage) {
  const ImU32 color = imgui_color(Role::text, 0.28);
  const auto radius = static_cast<float>(stage.to.radius);
  const ImVec2 middle = stage.at(Vector2d(0, 0));
  for (const int tilt : {30, 60, 90}) {
    const float r = radius * static_cast<float>(tilt) / 90;
    stage.list.AddCircle(middle, r, color, 128, stage.s);
    const float along = r * 0.7071F;
    small_text(stage, {middle.x + along, middle.y - along}, fmt::format("{}\u00b0", tilt));
  }
  const float arm = 4 * stage.s;
  stage.list.AddLine({middle.x - arm, middle.y}, {middle.x + arm, middle.y}, color, stage.s);
  stage.list.AddLine({middle.x, middle.y - arm}, {middle.x, middle.y + arm}, color, stage.s);
  const double inwards = 20 * stage.s / stage.to.radius;  // of the rim
  const double below = 10 * stage.s / stage.to.radius;
  small_text(stage, stage.at(Vector2d(0, below - 1)), "up: floor");
  small_text(stage, stage.at(Vector2d(0, 1 - below)), "down: ceiling");
  small_text(stage, stage.at(Vector2d(-1 + inwards, 0)), "left");
  small_text(stage, stage.at(Vector2d(1 - inwards, 0)), "right");
}

void draw_candidates(const Stage& stage) {
  const auto& candidates = stage.content.study->candidates;
  const int last = std::min<int>(stage.content.frames(), static_cast<int>(candidates.size())) - 1;
  for (int i = 1; i <= last; ++i) {
    const bool now = i == last;
    const std::uint32_t rgb = now ? color_of(Role::selected) : stage.color_of_frame(i);
    for (const HomographyCandidate& candidate : candidates[i]) {
      const Vector2d disc = disc_from_normal(candidate.motion.normal);
      if (disc.norm() > 1) continue;
      const ImVec2 at = stage.at(disc);
      const float r = (now ? 4.2F : 2.2F) * stage.s;
      if (candidate.taken()) {
        stage.list.AddCircleFilled(at, r + stage.s, imgui_color(Role::background, 0.6), 16);
        stage.list.AddCircleFilled(at, r, imgui_color(rgb), 16);
      } else {
        stage.list.AddCircle(
            at, r, imgui_color(rgb, now ? 1 : 0.55), 16, (now ? 1.6F : 1) * stage.s);
      }
    }
  }
}

/// Of what iterates over a plane: where the normal was, step by step.
void draw_path(const Stage& stage, const NormalAnswer& answer) {
  std::vector<Vector2d> path;
  for (const SolverStep& step : answer.inspection->initialization->solver.trace)
    if (step.normal) path.push_back(disc_from_normal(*step.normal));
  if (path.size() < 2) return;
  line_on(stage, path, answer.rgb, 1.6F * stage.s, false);
  for (const Vector2d& place : path)
    stage.list.AddCircleFilled(stage.at(place), 2.2F * stage.s, imgui_color(answer.rgb), 12);
}

void draw_answer(const Stage& stage, const NormalAnswer& answer) {
  const auto& uncertainty = answer.inspection->initialization->uncertainty;
  if (answer.current && uncertainty)
    line_on(stage,
            confidence_on_disc(answer.normal(), uncertainty->normal_covariance),
            color_of(Role::uncertain),
            1.6F * stage.s,
            true);
  const ImVec2 at = stage.at(answer.normal());
  const float r = 5 * stage.s;
  const ImU32 rim = imgui_color(Role::background), color = imgui_color(answer.rgb);
  if (answer.current) {
    stage.list.AddCircleFilled(at, r + 2.4F * stage.s, rim, 24);
    stage.list.AddCircleFilled(at, r, color, 24);
    stage.list.AddCircle(at, r + 1.2F * stage.s, imgui_color(Role::selected), 24, 1.4F * stage.s);
  } else {
    stage.list.AddRect({at.x - r, at.y - r}, {at.x + r, at.y + r}, rim, 0, 0, 4 * stage.s);
    draw_sign(stage.list, Sign::square, at, answer.rgb);
  }
}

/// Of the current answer: the normals of the window's further planes.
void draw_other_planes(const Stage& stage) {
  for (const PlaneEstimate& plane : other_estimates(stage.content)) {
    const Vector3d& normal = plane.plane.normal;
    const std::uint32_t rgb = plane_color(*stage.content.study->window, plane.number);
    if (plane.normal_covariance)
      line_on(stage, confidence_on_disc(normal, *plane.normal_covariance), rgb, stage.s, true);
    stage.list.AddCircleFilled(stage.at(normal), 5 * stage.s, imgui_color(Role::background), 24);
    stage.list.AddCircleFilled(stage.at(normal), 3.6F * stage.s, imgui_color(rgb), 24);
  }
}

void draw_truth(const Stage& stage) {
  if (const auto normal = true_normal(stage.content.inspection)) {
    const ImVec2 c = stage.at(*normal);
    const float r = 8 * stage.s;
    for (const auto& [rgb, width] :
         {std::pair{color_of(Role::background), 4.0F}, std::pair{color_of(Role::truth), 2.0F}}) {
      stage.list.AddLine({c.x - r, c.y - r}, {c.x + r, c.y + r}, imgui_color(rgb), width * stage.s);
      stage.list.AddLine({c.x - r, c.y + r}, {c.x + r, c.y - r}, imgui_color(rgb), width * stage.s);
    }
  }
}

/// How long an angle is, where the disc is enlarged.
void draw_scale_bar(const Stage& stage, const ScreenRect& rect) {
  const double px_a_degree = stage.to.radius / 90;
  const double angle = nice_length(90 * stage.s / px_a_degree);
  const auto length = static_cast<float>(angle * px_a_degree);
  const auto x = static_cast<float>(rect.min.x() + 12 * stage.s);
  const auto y = static_cast<float>(rect.min.y() + rect.size.y() - 10 * stage.s);
  const ImU32 color = imgui_color(Role::text);
  stage.list.AddLine({x, y}, {x + length, y}, color, 2 * stage.s);
  for (const float end : {x, x + length})
    stage.list.AddLine({end, y - 4 * stage.s}, {end, y + 4 * stage.s}, color, stage.s);
  small_text(stage, {x + length / 2, y - 11 * stage.s}, fmt::format("{:g}\u00b0", angle));
}

void draw_color_bar(const Stage& stage, const ScreenRect& rect, const NormalsMap& map) {
  constexpr int kCells = 64;
  static_assert(256 % kCells == 0);
  const float s = stage.s;
  const ImFont* f = font(Font::small);
  const std::string title =
      fmt::format("RMS over the first {} frames [px]", stage.content.frames());
  const auto x = static_cast<float>(rect.min.x() + 12 * s),
             y = static_cast<float>(rect.min.y() + 8 * s);
  stage.list.AddText(f, f->FontSize, {x, y}, imgui_color(Role::text_dim), title.c_str());
  const float title_width = f->CalcTextSizeA(f->FontSize, INFINITY, 0, title.c_str()).x;
  const float left = std::round(x + title_width + 14 * s);
  const auto right = static_cast<float>(rect.min.x() + rect.size.x() - 24 * s);
  if (right - left < 60 * s) return;
  cv::Mat1b levels(1, kCells);
  for (int i = 0; i < kCells; ++i) levels(i) = static_cast<uchar>(255 * i / (kCells - 1));
  cv::Mat3b colors;
  cv::applyColorMap(levels, colors, cv::COLORMAP_VIRIDIS);
  const float width = (right - left) / kCells, height = 10 * s;
  for (int i = 0; i < kCells; ++i) {
    const cv::Vec3b bgr = colors(i);
    const std::uint32_t rgb = bgr[2] << 16 | bgr[1] << 8 | bgr[0];
    const float from = left + width * static_cast<float>(i);
    stage.list.AddRectFilled({std::round(from), y + s},
                             {std::round(from + width), y + s + height},
                             imgui_color(mixed_rgb(0, rgb, 0.8)));
  }
  const double low = std::log(map.low_px()), high = std::log(map.high_px());
  const AxisTicks ticks = logarithmic_ticks(
      map.low_px(), map.high_px(), std::max(3, static_cast<int>((right - left) / (26 * s))));
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    const double share = (std::log(ticks.values[i]) - low) / (high - low);
    if (share < -1e-6 || share > 1 + 1e-6) continue;
    const float at = std::round(left + static_cast<float>(share) * (right - left));
    stage.list.AddLine({at, y + s + height}, {at, y + 4 * s + height}, imgui_color(Role::text), s);
    small_text(stage, {at, y + height + 11 * s}, ticks.labels[i]);
  }
}

std::vector<LegendRow> legend_of(const NormalsContent& content) {
  std::vector<LegendRow> rows;
  const auto add = [&rows](Sign sign, std::uint32_t rgb, const std::string& text) {
    rows.push_back({sign, rgb, text});
  };
  for (const NormalAnswer& answer : content.answers)
    add(answer.current ? Sign::disc : Sign::square, answer.rgb, answer.name);
  if (true_normal(content.inspection)) add(Sign::cross, color_of(Role::truth), "truth");
  const bool uncertain =
      !content.answers.empty() && content.answers.front().current &&
      content.answers.front().inspection->initialization->uncertainty.has_value();
  if (uncertain) add(Sign::line, color_of(Role::uncertain), "95 %");
  for (const PlaneEstimate& plane : other_estimates(content))
    add(Sign::disc,
        plane_color(*content.study->window, plane.number),
        plane_title(*content.answers.front().inspection, plane.number));
  add(Sign::dot, color_of(Role::selected), "readings, this frame's larger");
  add(Sign::circle, color_of(Role::text), "rejected");
  if (!content.study->clusters.empty())
    add(Sign::line, color_of(Role::residual), "DBSCAN's clusters");
  return rows;
}

}  // namespace

int NormalsContent::frames() const {
  const int last = study->window->frame_count();
  return std::clamp(frame - study->window->start + 1, std::min(2, last), last);
}

ScreenRect disc_rect(const ScreenRect& rect) {
  const double s = overlay_scale();
  return {rect.min + Vector2d(0, kAboveDisc * s),
          rect.size - Vector2d(0, (kAboveDisc + kBelowDisc) * s)};
}

void draw_normals_view(ImDrawList& list,
                       const ScreenRect& rect,
                       NormalsMap& map,
                       const NormalsContent& content,
                       const NormalsZoom& zoom) {
  map.update(content.study, content.frames());
  const ScreenRect inner = disc_rect(rect);
  if (inner.size.minCoeff() < 16) return;
  const DiscMapping to = map_disc(inner, zoom);
  const Stage stage{list, to, content, overlay_scale()};
  list.AddRectFilled(
      to_imgui(rect.min), to_imgui(rect.min + rect.size), imgui_color(Role::scene_bottom));
  list.PushClipRect(to_imgui(inner.min), to_imgui(inner.min + inner.size), true);
  draw_map(stage, map);
  draw_rings(stage);
  draw_candidates(stage);
  for (const NormalCluster& cluster : content.study->clusters)
    line_on(stage,
            circle_on_disc(cluster.normal, std::max(0.2, cluster.radius_deg)),
            color_of(Role::residual),
            1.4F * stage.s,
            true,
            0.8);
  for (auto answer = content.answers.rbegin(); answer != content.answers.rend(); ++answer)
    draw_path(stage, *answer);
  draw_other_planes(stage);
  draw_truth(stage);
  for (auto answer = content.answers.rbegin(); answer != content.answers.rend(); ++answer)
    draw_answer(stage, *answer);
  draw_scale_bar(stage, inner);
  list.PopClipRect();
  draw_color_bar(stage, rect, map);
  draw_legend_strip(list, rect, legend_of(content));
}

std::string normal_text(const NormalsMap& map,
                        const NormalsContent& content,
                        const Vector2d& disc) {
  if (disc.norm() > 1) return "";
  const Vector3d n = normal_from_disc(disc);
  std::string text = fmt::format(
      "normal ({:.3f}, {:.3f}, {:.3f})\ntilt {:.1f}\u00b0", n.x(), n.y(), n.z(), 90 * disc.norm());
  const float rms = map.rms_at(disc);
  text += std::isnan(rms)   ? "\nits horizon runs through the tracks"
          : std::isinf(rms) ? "\nputs tracks behind a camera"
                            : fmt::format("\nRMS {} px", number_text(rms, 2));
  for (const NormalAnswer& answer : content.answers)
    text += fmt::format("\n{} from {}", angle_text(angle_deg(n, answer.normal())), answer.name);
  if (const auto truth = true_normal(content.inspection))
    text += fmt::format("\n{} from the truth", angle_text(angle_deg(n, *truth)));
  return text;
}

}  // namespace gpo
