// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/normals/normals_view.h"

#include "engine/geometry/pose.h"
#include "engine/inspection/studies/studies.h"
#include "ui/views/charts/charts.h"
#include "ui/views/scene/scene_view.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

// Above and below the disc, at scale 1 [px].
constexpr double kAboveDisc = 44, kBelowDisc = 66;

const Vector3d& normal_of(const ShownResult& answer) {
  return answer.inspection->initialization->plane.normal;
}

struct DiscCanvas : Area {
  DiscMapping to;
  const NormalsContent& content;
  float s = overlay_scale();

  ImVec2 at(const Vector3d& normal) const { return at(disc_from_normal(normal)); }
  ImVec2 at(const Vector2d& disc) const { return to_imgui(to.to_screen(disc)); }
  /// Later frames are lighter.
  std::uint32_t color_of_frame(int frame_in_window) const {
    const double share = frame_in_window / std::max(1.0, content.frames() - 1.0);
    return mixed_rgb(color_of(Role::active), color_of(Role::text), 0.2 + 0.8 * share);
  }
  void line(const ImVec2& a, const ImVec2& b, ImU32 color, float width) const {
    list.AddLine(a, b, color, width * s);
  }
  void filled_circle(const ImVec2& center, float radius, ImU32 color) const {
    list.AddCircleFilled(center, radius * s, color, 24);
  }
  void polyline(const std::vector<Vector2d>& disc,
                std::uint32_t rgb,
                float width,
                bool closed) const {
    std::vector<ImVec2> points;
    for (const Vector2d& point : disc) points.push_back(at(point));
    const auto count = static_cast<int>(points.size());
    const ImDrawFlags flags = closed ? ImDrawFlags_Closed : 0;
    for (const auto& [color, thickness] :
         {std::pair{imgui_color(Role::background, 0.5), width + 2}, {imgui_color(rgb), width}})
      list.AddPolyline(points.data(), count, color, flags, thickness * s);
  }
  void label(const Vector2d& disc, const std::string& text) const {
    write_label(list, Font::small, to.to_screen(disc), text);
  }
};

void draw_map(const DiscCanvas& canvas, const NormalsMap& map) {
  mark_content(canvas.list, map.texture().revision());
  canvas.list.AddImage(map.texture().id(), canvas.at(Vector2d(-1, -1)), canvas.at(Vector2d(1, 1)));
  const ImVec2 low = canvas.list.GetClipRectMin(), high = canvas.list.GetClipRectMax();
  for (const auto& [from, to] : map.contours()) {
    const ImVec2 a = canvas.at(from), b = canvas.at(to);
    const bool outside = std::max(a.x, b.x) < low.x || std::min(a.x, b.x) > high.x ||
                         std::max(a.y, b.y) < low.y || std::min(a.y, b.y) > high.y;
    if (!outside) canvas.line(a, b, imgui_color(Role::background, 0.55), 1);
  }
}

void draw_rings(const DiscCanvas& canvas) {
  const ImU32 color = imgui_color(Role::text, 0.28);
  const float s = canvas.s;
  const ImVec2 middle = canvas.at(Vector2d(0, 0));
  for (const int tilt : {30, 60, 90}) {
    const double share = tilt / 90.0;
    canvas.list.AddCircle(middle, static_cast<float>(share * canvas.to.radius), color, 128, s);
    canvas.label(share * Vector2d(1, -1).normalized(), fmt::format("{}\u00b0", tilt));
  }
  canvas.line({middle.x - 4 * s, middle.y}, {middle.x + 4 * s, middle.y}, color, 1);
  canvas.line({middle.x, middle.y - 4 * s}, {middle.x, middle.y + 4 * s}, color, 1);
  const double inwards = 1 - 20 * s / canvas.to.radius, below = 1 - 10 * s / canvas.to.radius;
  canvas.label({0, -below}, "up: floor");
  canvas.label({0, below}, "down: ceiling");
  canvas.label({-inwards, 0}, "left");
  canvas.label({inwards, 0}, "right");
}

void draw_candidates(const DiscCanvas& canvas) {
  const auto& candidates = canvas.content.study->candidates;
  const int last = std::min<int>(canvas.content.frames(), static_cast<int>(candidates.size())) - 1;
  for (int i = 1; i <= last; ++i) {
    const bool now = i == last;
    const std::uint32_t rgb = now ? color_of(Role::selected) : canvas.color_of_frame(i);
    const float r = now ? 4.2F : 2.2F;
    for (const HomographyCandidate& candidate : candidates[i]) {
      const Vector2d disc = disc_from_normal(candidate.motion.normal);
      if (disc.norm() > 1) continue;
      const ImVec2 at = canvas.at(disc);
      if (candidate.taken()) {
        canvas.filled_circle(at, r + 1, imgui_color(Role::background, 0.6));
        canvas.filled_circle(at, r, imgui_color(rgb));
      } else {
        const ImU32 color = imgui_color(rgb, now ? 1 : 0.55);
        canvas.list.AddCircle(at, r * canvas.s, color, 16, (now ? 1.6F : 1) * canvas.s);
      }
    }
  }
}

/// Draws the normals of the solver's iterations.
void draw_path(const DiscCanvas& canvas, const ShownResult& answer) {
  std::vector<Vector2d> path;
  for (const SolverStep& step : answer.inspection->initialization->solver.trace)
    if (step.normal) path.push_back(disc_from_normal(*step.normal));
  if (path.size() < 2) return;
  canvas.polyline(path, answer.rgb, 1.6F, false);
  for (const Vector2d& place : path)
    canvas.filled_circle(canvas.at(place), 2.2F, imgui_color(answer.rgb));
}

void draw_answer(const DiscCanvas& canvas, const ShownResult& answer) {
  const auto& uncertainty = answer.inspection->initialization->uncertainty;
  if (answer.current && uncertainty) {
    const PlaneEstimate main = found_planes(*answer.inspection).front();
    const auto border = confidence_on_disc(
        normal_of(answer), main.normal_covariance.value_or(uncertainty->normal_covariance));
    canvas.polyline(border, color_of(Role::uncertain), 1.6F, true);
  }
  const ImVec2 at = canvas.at(normal_of(answer));
  const float s = canvas.s, r = 5 * s;
  if (answer.current) {
    canvas.filled_circle(at, 7.4F, imgui_color(Role::background));
    canvas.filled_circle(at, 5, imgui_color(answer.rgb));
    canvas.list.AddCircle(at, r + 1.2F * s, imgui_color(Role::selected), 24, 1.4F * s);
  } else {
    const ImU32 rim = imgui_color(Role::background);
    canvas.list.AddRect({at.x - r, at.y - r}, {at.x + r, at.y + r}, rim, 0, 0, 4 * s);
    draw_sign(canvas.list, Sign::square, at, answer.rgb);
  }
}

void draw_further_planes(const DiscCanvas& canvas) {
  for (const PlaneEstimate& plane : canvas.content.further_planes()) {
    const Vector3d& normal = plane.plane.normal;
    const std::uint32_t rgb = plane_color(plane.number);
    if (plane.normal_covariance)
      canvas.polyline(confidence_on_disc(normal, *plane.normal_covariance), rgb, 1, true);
    canvas.filled_circle(canvas.at(normal), 5, imgui_color(Role::background));
    canvas.filled_circle(canvas.at(normal), 3.6F, imgui_color(rgb));
  }
}

void draw_truth(const DiscCanvas& canvas) {
  const auto normal = true_normal(canvas.content.inspection);
  if (!normal) return;
  const ImVec2 c = canvas.at(*normal);
  const float r = 8 * canvas.s;
  for (const auto& [role, width] :
       {std::pair{Role::background, 4.0F}, std::pair{Role::truth, 2.0F}}) {
    canvas.line({c.x - r, c.y - r}, {c.x + r, c.y + r}, imgui_color(role), width);
    canvas.line({c.x - r, c.y + r}, {c.x + r, c.y - r}, imgui_color(role), width);
  }
}

void draw_scale_bar(const DiscCanvas& canvas) {
  const float s = canvas.s;
  const ScreenRect& rect = canvas.rect;
  const double px_per_degree = canvas.to.radius / 90;
  const double angle = nice_length(90 * s / px_per_degree);
  const auto length = static_cast<float>(angle * px_per_degree);
  const auto x = static_cast<float>(rect.min.x() + 12 * s);
  const auto y = static_cast<float>(rect.min.y() + rect.size.y() - 10 * s);
  const ImU32 color = imgui_color(Role::text);
  canvas.line({x, y}, {x + length, y}, color, 2);
  for (const float end : {x, x + length}) canvas.line({end, y - 4 * s}, {end, y + 4 * s}, color, 1);
  write_label(
      canvas.list, Font::small, {x + length / 2, y - 11 * s}, fmt::format("{:g}\u00b0", angle));
}

void draw_color_bar(const DiscCanvas& canvas, const ScreenRect& rect, const NormalsMap& map) {
  constexpr int kCells = 64;
  const float s = canvas.s;
  const auto title = fmt::format("RMS over the first {} frames [px]", canvas.content.frames());
  const Vector2d corner = rect.min + s * Vector2d(12, 8);
  write_text(canvas.list, Font::small, corner, title, color_of(Role::text_dim));
  const auto y = static_cast<float>(corner.y());
  const auto left =
      static_cast<float>(std::round(corner.x() + text_width(Font::small, title) + 14 * s));
  const auto right = static_cast<float>(rect.min.x() + rect.size.x() - 24 * s);
  if (right - left < 60 * s) return;
  const float width = (right - left) / kCells, bottom = y + 11 * s;
  for (int i = 0; i < kCells; ++i) {
    const float from = left + width * static_cast<float>(i);
    const ImU32 color = imgui_color(mixed_rgb(0, viridis(i / (kCells - 1.0)), 0.8));
    const ImVec2 low(std::round(from), y + s), high(std::round(from + width), bottom);
    canvas.list.AddRectFilled(low, high, color);
  }
  const double low = std::log(map.low_px()), high = std::log(map.high_px());
  const AxisTicks ticks = logarithmic_ticks(
      map.low_px(), map.high_px(), std::max(3, static_cast<int>((right - left) / (26 * s))));
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    const double share = (std::log(ticks.values[i]) - low) / (high - low);
    if (share < -1e-6 || share > 1 + 1e-6) continue;
    const float at = std::round(left + static_cast<float>(share) * (right - left));
    canvas.line({at, bottom}, {at, bottom + 3 * s}, imgui_color(Role::text), 1);
    write_label(canvas.list, Font::small, {at, bottom + 10 * s}, ticks.labels[i]);
  }
}

LegendRows legend_of(const NormalsContent& content) {
  LegendRows rows;
  const auto add = [&rows](Sign sign, std::uint32_t rgb, const std::string& text) {
    rows.push_back({sign, rgb, text});
  };
  for (const ShownResult& answer : content.answers)
    add(answer.current ? Sign::disc : Sign::square, answer.rgb, answer.name);
  if (true_normal(content.inspection)) add(Sign::cross, color_of(Role::truth), "truth");
  const bool uncertain =
      !content.answers.empty() && content.answers.front().current &&
      content.answers.front().inspection->initialization->uncertainty.has_value();
  if (uncertain) add(Sign::line, color_of(Role::uncertain), "95 %");
  for (const PlaneEstimate& plane : content.further_planes())
    add(Sign::disc,
        plane_color(plane.number),
        plane_title(*content.answers.front().inspection, plane.number));
  add(Sign::dot, color_of(Role::selected), "decompositions, this frame's larger");
  add(Sign::circle, color_of(Role::text), "rejected");
  if (!content.study->clusters.empty())
    add(Sign::line, color_of(Role::residual), "DBSCAN clusters");
  return rows;
}

}  // namespace

int NormalsContent::frames() const {
  const int last = study->window->frame_count();
  return std::clamp(frame - study->window->start + 1, std::min(2, last), last);
}

std::vector<PlaneEstimate> NormalsContent::further_planes() const {
  std::vector<PlaneEstimate> further;
  if (answers.empty() || !answers.front().current) return further;
  const Inspection& current = *answers.front().inspection;
  for (const PlaneEstimate& plane : current.initialization->planes)
    if (plane.number != current.window->leader) further.push_back(plane);
  return further;
}

ScreenRect disc_rect(const ScreenRect& rect) {
  const double s = overlay_scale();
  return {rect.min + Vector2d(0, kAboveDisc * s),
          rect.size - Vector2d(0, (kAboveDisc + kBelowDisc) * s)};
}

void draw_normals_view(const Area& area,
                       NormalsMap& map,
                       const NormalsContent& content,
                       const NormalsZoom& zoom) {
  map.update(content.study, content.frames());
  const Area inner{area.list, disc_rect(area.rect)};
  if (inner.rect.size.minCoeff() < 16) return;
  const DiscCanvas canvas{inner, map_disc(inner.rect, zoom), content};
  area.fill(imgui_color(Role::scene_bottom));
  inner.clip();
  draw_map(canvas, map);
  draw_rings(canvas);
  draw_candidates(canvas);
  for (const NormalCluster& cluster : content.study->clusters) {
    const auto circle = circle_on_disc(cluster.normal, std::max(0.2, cluster.radius_deg));
    canvas.polyline(circle, color_of(Role::residual), 1.4F, true);
  }
  for (auto answer = content.answers.rbegin(); answer != content.answers.rend(); ++answer)
    draw_path(canvas, *answer);
  draw_further_planes(canvas);
  draw_truth(canvas);
  for (auto answer = content.answers.rbegin(); answer != content.answers.rend(); ++answer)
    draw_answer(canvas, *answer);
  draw_scale_bar(canvas);
  area.list.PopClipRect();
  draw_color_bar(canvas, area.rect, map);
  draw_legend_strip(area, legend_of(content));
}

std::string normal_text(const NormalsMap& map,
                        const NormalsContent& content,
                        const Vector2d& disc) {
  if (disc.norm() > 1) return "";
  const Vector3d n = normal_from_disc(disc);
  std::string text = fmt::format(
      "normal ({:.3f}, {:.3f}, {:.3f})\ntilt {:.1f}\u00b0", n.x(), n.y(), n.z(), 90 * disc.norm());
  const float rms = map.rms_at(disc);
  text += std::isnan(rms)   ? "\nthe plane's horizon crosses the tracks"
          : std::isinf(rms) ? "\ntracks would be behind a camera"
                            : fmt::format("\nRMS {} px", number_text(rms, 2));
  for (const ShownResult& answer : content.answers)
    text += fmt::format("\n{} from {}", angle_text(angle_deg(n, normal_of(answer))), answer.name);
  if (const auto truth = true_normal(content.inspection))
    text += fmt::format("\n{} from the truth", angle_text(angle_deg(n, *truth)));
  return text;
}

}  // namespace gpo
