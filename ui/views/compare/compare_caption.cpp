// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/method_defaults.h"
#include "ui/look/numbers.h"
#include "ui/views/compare/compare_view.h"
#include "ui/views/overlay/overlay.h"
#include "ui/views/overlay/plane_style.h"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

std::string conditions(const Inspection& inspection, double width) {
  const Window& window = *inspection.window;
  const std::string rotations = to_string(inspection.rotations_used);
  const int inliers = window.inlier_count(0), all = window.track_count();
  std::string tracks = fmt::format("RANSAC off · all {} tracks", all);
  std::string few = fmt::format("all {} tracks", all);
  if (uses_ransac(inspection.settings.options)) {
    tracks = fmt::format("RANSAC on · {} of {} tracks", inliers, all);
    few = fmt::format("{}/{} tracks", inliers, all);
  }
  return fitting_text(Font::small,
                      {fmt::format("rotations: {} · {}", rotations, tracks),
                       fmt::format("{} · {}", rotations, tracks),
                       fmt::format("{} · {}", rotations, few)},
                      width);
}

/// Draws sign and word of the verdict at the rectangle's right edge. Returns its width [px].
double draw_verdict(ImDrawList& list, const ScreenRect& rect, const Inspection& inspection) {
  const auto& verdict = inspection.initialization->verdict;
  if (!verdict) return 0;
  const double s = overlay_scale();
  const ReadinessStyle look = style_of(verdict->readiness);
  const std::string word = to_string(verdict->readiness);
  const double width = 16 * s + text_width(Font::small, word);
  const Vector2d at = rect.min + Vector2d(rect.size.x() - width, 12 * s);
  draw_sign(list, look.sign, to_imgui(at + s * Vector2d(6, 8)), look.rgb);
  write_text(list, Font::small, at + Vector2d(16 * s, 0), word, look.rgb);
  return width + 10 * s;
}

std::string why_no_metrics(const Inspection& inspection) {
  if (!inspection.truth) return "no truth";
  if (inspection.evaluation->alignment == Alignment::point)
    return "no scale: the true path is a point";
  return "the ground truth does not cover the reference frame or the plane";
}

std::string remarks(const Inspection& inspection, const Evaluation& e, double width) {
  const std::string least =
      fmt::format("RMS {} px", number_text(inspection.initialization->rms_px, 2));
  std::string more = least;
  if (const auto& uncertainty = inspection.initialization->uncertainty)
    more += " · normal ±" + angle_text(uncertainty->normal_sigma_deg);
  std::string most = more;
  if (!e.pne_deg || !e.ate_m) most += " · " + why_no_metrics(inspection);
  if (e.pne_bound_deg) most += " · PNE bound " + angle_text(*e.pne_bound_deg);
  return fitting_text(Font::small, {most, more, least}, width);
}

struct ComparedError {
  const char* name;
  std::optional<double> value, first;
  std::string (*text)(double);

  std::string value_text() const { return value ? text(*value) : "–"; }
  double name_width() const { return text_width(Font::small, name) + 6 * overlay_scale(); }
  /// Whether the value fits to the right of this.
  bool fits(double left, double width) const {
    return left + text_width(Font::bold, value_text()) <= width - 4 * overlay_scale();
  }
};

/// Draws an error in a third of the caption: value and name, side by side or `stacked`, above the
/// difference.
void draw_error(ImDrawList& list,
                const ScreenRect& third,
                bool stacked,
                const ComparedError& error) {
  const double s = overlay_scale();
  const auto write = [&](Font which, double x, double y, const std::string& text, Role role) {
    write_text(list, which, third.min + Vector2d(x, y * s), text, color_of(role));
  };
  const double right = stacked ? 0 : error.name_width();
  write(Font::small, 0, stacked ? 0 : 8, error.name, Role::text_dim);
  const bool tight = !error.fits(right, third.size.x());
  const std::string value = error.value_text();
  write(tight ? Font::small : Font::bold, right, stacked ? 14 : 6, value, Role::text);
  if (!error.value || !error.first) return;
  std::string difference = difference_text(*error.value, *error.first, error.text);
  const auto unit = value.find(' '), same = difference.find(' ');
  const bool repeats = unit != std::string::npos && same != std::string::npos &&
                       value.substr(unit) == difference.substr(same);
  if (tight && repeats) difference.resize(same);
  const Role role = difference == "\u00b10"       ? Role::text_dim
                    : *error.value < *error.first ? Role::good
                                                  : Role::bad;
  write(Font::small, right, stacked ? 34 : 28, difference, role);
}

}  // namespace

void draw_compare_heading(ImDrawList& list, const ScreenRect& rect, const CompareColumn& column) {
  const double s = overlay_scale();
  const Vector2d bar = rect.min + Vector2d(0, 8 * s);
  const std::uint32_t rgb = color_of(column.configuration);
  list.AddRectFilled(to_imgui(bar),
                     to_imgui(bar + s * Vector2d(6, 40)),
                     imgui_color(rgb),
                     static_cast<float>(2 * s));
  const double wide = rect.size.x() - 16 * s;
  const std::string title = title_of(column.configuration);
  const double room = wide - (column.inspection ? draw_verdict(list, rect, *column.inspection) : 0);
  const bool large = text_width(Font::heading, title) <= room;
  const Font which = large ? Font::heading : Font::bold;
  const std::string text = fitting_text(which, {title, key_of(column.configuration)}, room);
  write_text(list, which, bar + s * Vector2d(16, large ? 0 : 2), text);
  if (!column.inspection) return;
  const std::string below = conditions(*column.inspection, wide);
  write_text(list, Font::small, bar + s * Vector2d(16, 24), below, color_of(Role::text_dim));
}

void draw_compare_caption(ImDrawList& list,
                          const ScreenRect& rect,
                          const Inspection& inspection,
                          const Inspection* first) {
  const double s = overlay_scale();
  const Vector2d at = rect.min + Vector2d(0, 8 * s), below = rect.min + Vector2d(0, 50 * s);
  if (!inspection.initialization->ok)
    return write_text(list, Font::bold, at, "not initialized", color_of(Role::warning));
  const Evaluation e = inspection.evaluation.value_or(Evaluation{});
  const Evaluation f = first ? first->evaluation.value_or(Evaluation{}) : Evaluation{};
  const double third = std::min(rect.size.x() / 3, 150 * s);
  const ComparedError errors[] = {
      {.name = "PNE", .value = e.pne_deg, .first = f.pne_deg, .text = angle_text},
      {.name = "ATE", .value = e.ate_m, .first = f.ate_m, .text = length_text},
      {.name = "PDE", .value = e.pde_m, .first = f.pde_m, .text = length_text}};
  const bool stacked = !std::ranges::all_of(
      errors, [&](const ComparedError& error) { return error.fits(error.name_width(), third); });
  for (int i = 0; i < 3; ++i) {
    const ScreenRect place{rect.min + Vector2d(i * third, 0), {third, 0}};
    draw_error(list, place, stacked, errors[i]);
  }
  const std::string text = remarks(inspection, e, rect.size.x());
  write_text(list, Font::small, below, text, color_of(Role::text_dim));
}

}  // namespace gpo
