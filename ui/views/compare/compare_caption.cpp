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
  const bool ransac = uses_ransac(inspection.settings.options);
  const std::string rotations = to_string(inspection.rotations_used);
  const int inliers = window.inlier_count(0), all = window.track_count();
  const std::string tracks = ransac ? fmt::format("RANSAC on · {} of {} tracks", inliers, all)
                                    : fmt::format("RANSAC off · all {} tracks", all);
  const std::string few =
      ransac ? fmt::format("{}/{} tracks", inliers, all) : fmt::format("all {} tracks", all);
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
  const Alignment alignment = inspection.evaluation->alignment;
  if (alignment == Alignment::point) return "no scale: the true path is a point";
  return "the ground truth does not cover the reference frame or the plane";
}

/// Returns the line below the errors.
std::string remarks(const Inspection& inspection, const Evaluation& e, double width) {
  const std::string least =
      fmt::format("RMS {} px", number_text(inspection.initialization->rms_px, 2));
  std::string more = least;
  if (const auto& uncertainty = inspection.initialization->uncertainty)
    more += " · normal ±" + angle_text(uncertainty->normal_sigma_deg);
  std::string most = more;
  if (!e.pne_deg || !e.ate_m) most += " · " + why_no_metrics(inspection);
  if (e.pne_bound_deg) most += fmt::format(" · PNE bound {}", angle_text(*e.pne_bound_deg));
  return fitting_text(Font::small, {most, more, least}, width);
}

/// An error, and the first column's.
struct ComparedError {
  const char* name;
  std::optional<double> value, first;
  std::string (*text)(double);
};

/// Whether the value is too wide for a place beside its name.
bool too_wide(const ComparedError& error, double width) {
  const std::string value = error.value ? error.text(*error.value) : "–";
  const double beside = text_width(Font::small, error.name) + 6 * overlay_scale();
  return beside + text_width(Font::bold, value) > width - 4 * overlay_scale();
}

/// Draws an error in a third of the caption: value and name, side by side or `stacked`, above the
/// difference.
void draw_error(
    ImDrawList& list, const Vector2d& at, double width, bool stacked, const ComparedError& error) {
  const double s = overlay_scale();
  const std::string value = error.value ? error.text(*error.value) : "–";
  const double right = stacked ? 0 : text_width(Font::small, error.name) + 6 * s;
  write_text(list,
             Font::small,
             at + Vector2d(0, stacked ? 0 : 8 * s),
             error.name,
             color_of(Role::text_dim));
  const bool tight = right + text_width(Font::bold, value) > width - 4 * s;
  write_text(
      list, tight ? Font::small : Font::bold, at + Vector2d(right, (stacked ? 14 : 6) * s), value);
  if (!error.value || !error.first) return;
  std::string difference = difference_text(*error.value, *error.first, error.text);
  const auto unit = value.find(' '), same = difference.find(' ');
  const bool repeats = unit != std::string::npos && same != std::string::npos &&
                       value.substr(unit) == difference.substr(same);
  if (tight && repeats) difference.resize(same);
  const std::uint32_t rgb =
      *error.value < *error.first ? color_of(Role::good) : color_of(Role::bad);
  write_text(list,
             Font::small,
             at + Vector2d(right, (stacked ? 34 : 28) * s),
             difference,
             difference == "\u00b10" ? color_of(Role::text_dim) : rgb);
}

}  // namespace

void draw_compare_heading(ImDrawList& list, const ScreenRect& rect, const CompareColumn& column) {
  const double s = overlay_scale();
  const Vector2d bar = rect.min + Vector2d(0, 8 * s);
  list.AddRectFilled(to_imgui(bar),
                     to_imgui(bar + s * Vector2d(6, 40)),
                     imgui_color(color_of(column.configuration)),
                     static_cast<float>(2 * s));
  const double wide = rect.size.x() - 16 * s;
  const std::string title = title_of(column.configuration);
  const double room = wide - (column.inspection ? draw_verdict(list, rect, *column.inspection) : 0);
  const Font large = text_width(Font::heading, title) <= room ? Font::heading : Font::bold;
  write_text(list,
             large,
             bar + s * Vector2d(16, large == Font::heading ? 0 : 2),
             fitting_text(large, {title, key_of(column.configuration)}, room));
  if (column.inspection)
    write_text(list,
               Font::small,
               bar + s * Vector2d(16, 24),
               conditions(*column.inspection, wide),
               color_of(Role::text_dim));
}

void draw_compare_caption(ImDrawList& list,
                          const ScreenRect& rect,
                          const Inspection& inspection,
                          const Inspection* first) {
  const double s = overlay_scale();
  if (!inspection.initialization->ok) {
    write_text(list,
               Font::bold,
               rect.min + Vector2d(0, 8 * s),
               "not initialized",
               color_of(Role::warning));
    return;
  }
  const Evaluation e = inspection.evaluation.value_or(Evaluation{});
  const Evaluation f = first ? first->evaluation.value_or(Evaluation{}) : Evaluation{};
  const double third = std::min(rect.size.x() / 3, 150 * s);
  const ComparedError errors[] = {{"PNE", e.pne_deg, f.pne_deg, angle_text},
                                  {"ATE", e.ate_m, f.ate_m, length_text},
                                  {"PDE", e.pde_m, f.pde_m, length_text}};
  const bool stacked =
      std::ranges::any_of(errors, [&](const auto& one) { return too_wide(one, third); });
  for (int i = 0; i < 3; ++i)
    draw_error(list, rect.min + Vector2d(i * third, 0), third, stacked, errors[i]);
  write_text(list,
             Font::small,
             rect.min + Vector2d(0, 50 * s),
             remarks(inspection, e, rect.size.x()),
             color_of(Role::text_dim));
}

}  // namespace gpo
