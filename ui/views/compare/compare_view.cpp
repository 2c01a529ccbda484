// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/compare/compare_view.h"

#include "engine/base/error.h"
#include "engine/pipeline/method_defaults.h"
#include "ui/views/image/image_geometry.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace gpo {
namespace {

// Sizes at text scale 1 [px].
constexpr double kColumn = 480, kGap = 12, kTopLine = 38, kHeading = 54, kCaption = 70;

struct Grid {
  int columns, rows;
};

struct Page {
  const ScreenRect& rect;
  double scale;  ///< text scale
  double top;
};

ColumnPlace column_at(const Page& page, const Grid& grid, int index) {
  const auto rounded = [&](double size) { return std::round(page.scale * size); };
  const Vector2d free = page.rect.size - Vector2d(page.scale * kGap, page.top);
  const double width = std::floor(free.x() / grid.columns);
  const double height = std::floor(free.y() / grid.rows);
  const int x = index % grid.columns, y = index / grid.columns;
  const Vector2d at =
      page.rect.min + Vector2d(rounded(kGap) + width * x, std::round(page.top) + height * y);
  const double inner = std::max(1.0, width - rounded(kGap));
  const double heading = rounded(kHeading), caption = rounded(kCaption);
  const double image_height = std::max(1.0, height - heading - caption);
  return {{at, {inner, heading}},
          {at + Vector2d(0, heading), {inner, image_height}},
          {at + Vector2d(0, heading + image_height), {inner, caption}}};
}

/// Returns the grid with the largest images; of equal ones that with the fewest rows.
Grid best_grid(const Page& page, int count, double aspect) {
  Grid best{std::max(1, count), 1};
  double widest = 0;
  for (int rows = 1; rows <= count; ++rows) {
    const Grid one{(count + rows - 1) / rows, rows};
    const Vector2d size = column_at(page, one, 0).image.size;
    const double width = std::min(size.x(), size.y() * aspect);
    if (width <= widest) continue;
    widest = width;
    best = one;
  }
  return best;
}

/// Returns the cube's side: as many squares, or plane distances, as in the first inspection.
double common_cube_side(CompareColumns columns, const Inspection& inspection, double chosen) {
  const auto first = std::ranges::find_if(
      columns, [](const auto& one) { return one.inspection && one.inspection->cube; });
  if (!inspection.cube || first == columns.end()) return 0;
  const CubeAnchor& model = *first->inspection->cube;
  if (model.on_board != inspection.cube->on_board) return cube_side(inspection, chosen);
  return cube_side(*first->inspection, chosen) / model.unit * inspection.cube->unit;
}

/// Returns a box around all cubes in the shown image [px].
Eigen::AlignedBox2d cubes_box(CompareColumns columns, int frame, const ViewOptions& options) {
  Eigen::AlignedBox2d box;
  for (const Compared& column : columns) {
    if (!column.inspection) continue;
    const Inspection& inspection = *column.inspection;
    const FrameView view{inspection, frame, options};
    if (!view.inside()) continue;
    const ShownImage image = as_shown(*inspection.recording);
    const ImageMapping whole = map_image(image, {.size = image.size()}, {});
    const CubeSize size{common_cube_side(columns, inspection, options.cube_side),
                        options.cube_height_sides};
    for (const auto& cube : {estimated_cube(inspection, view.in_window(), size),
                             true_cube(inspection, view.in_window(), size)})
      for (const CubeEdge& edge : cube.value_or(CubeImage{}).edges)
        for (const Vector2d& pixel : edge.raw_px)
          box.extend(to_screen(whole, pixel) - Vector2d::Constant(0.5));
  }
  return box;
}

/// Returns the part of the image around the cubes; the whole image if there are none.
ImageZoom zoom_on(const Eigen::AlignedBox2d& cubes,
                  const Recording& recording,
                  const Vector2d& rect) {
  constexpr double kSurroundings = 2.2;  // size of the part [sizes of the box]
  constexpr double kMostZoom = 3;
  const Vector2d size = as_shown(recording).size();
  const Eigen::AlignedBox2d box = cubes.intersection({Vector2d::Zero(), size});
  if (box.isEmpty()) return {};
  const double fit = rect.cwiseQuotient(size).minCoeff();
  const Vector2d wanted = (kSurroundings * fit * box.sizes()).cwiseMax(1e-6);
  ImageZoom zoom;
  zoom.factor = std::clamp(rect.cwiseQuotient(wanted).minCoeff(), 1.0, kMostZoom);
  // Stays within the image where possible.
  const Vector2d shown = rect.cwiseQuotient(fit * zoom.factor * size);
  for (int axis = 0; axis < 2; ++axis) {
    const double half = std::min(0.5, shown[axis] / 2);
    zoom.center[axis] = std::clamp(box.center()[axis] / size[axis], half, 1 - half);
  }
  return zoom;
}

std::string conditions(const Inspection& inspection, double width) {
  const std::string rotations = to_string(inspection.rotations_used);
  const int inliers = inspection.window->inlier_count(0), all = inspection.window->track_count();
  std::string tracks = fmt::format("RANSAC off · all {}", counted(all, "track"));
  std::string few = "all " + counted(all, "track");
  if (uses_ransac(inspection.settings.options)) {
    tracks = fmt::format("RANSAC on · {} of {}", inliers, counted(all, "track"));
    few = fmt::format("{}/{}", inliers, counted(all, "track"));
  }
  const std::string all_known = rotations + " · " + tracks, short_one = rotations + " · " + few;
  return fitting_text(Font::small, {"rotations: " + all_known, all_known, short_one}, width);
}

/// Draws sign and word of the verdict at the rectangle's right edge. Returns its width [px].
double draw_verdict(const Area& area, const Inspection& inspection) {
  const auto& [list, rect] = area;
  const auto& verdict = inspection.initialization->verdict;
  if (!verdict) return 0;
  const double s = overlay_scale();
  const SignStyle look = style_of(verdict->readiness);
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
      "transfer RMS " + number_text(inspection.initialization->transfer_rms_px.value_or(NAN), 2) +
      " px";
  std::string more = least;
  if (const auto& uncertainty = inspection.initialization->uncertainty)
    more += " · normal " + sigma_text(*normal_sigma_deg(inspection)) +
            (uncertainty->own ? "" : " (window)");
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
  bool fits(double left, double width) const {
    return left + text_width(Font::bold, value_text()) <= width - 4 * overlay_scale();
  }
  /// Draws value and name, side by side or `stacked`, above the difference.
  void draw(const Area& area, bool stacked) const {
    const auto& [list, third] = area;
    const double s = overlay_scale();
    const auto write = [&, &list = list, &third = third](
                           Font which, double x, double y, const std::string& line, Role role) {
      write_text(list, which, third.min + Vector2d(x, y * s), line, color_of(role));
    };
    const double right = stacked ? 0 : name_width();
    write(Font::small, 0, stacked ? 0 : 8, name, Role::text_dim);
    const bool tight = !fits(right, third.size.x());
    const std::string shown = value_text();
    write(tight ? Font::small : Font::bold, right, stacked ? 14 : 6, shown, Role::text);
    if (!value || !first) return;
    std::string difference = difference_text(*value, *first, text);
    const auto unit = shown.find(' '), same = difference.find(' ');
    const bool repeats = unit != std::string::npos && same != std::string::npos &&
                         shown.substr(unit) == difference.substr(same);
    if (tight && repeats) difference.resize(same);
    const Role sign = *value < *first ? Role::good : Role::bad;
    const Role role = difference == "\u00b10" ? Role::text_dim : sign;
    write(Font::small, right, stacked ? 34 : 28, difference, role);
  }
};

void draw_heading(const Area& area, const Compared& column) {
  const auto& [list, rect] = area;
  const double s = overlay_scale();
  const Vector2d bar = rect.min + Vector2d(0, 8 * s);
  const std::uint32_t rgb = color_of(column.configuration);
  const ImVec2 from = to_imgui(bar), to = to_imgui(bar + s * Vector2d(6, 40));
  list.AddRectFilled(from, to, imgui_color(rgb), static_cast<float>(2 * s));
  const double wide = rect.size.x() - 16 * s;
  const std::string title = title_of(column.configuration);
  const double room = wide - (column.inspection ? draw_verdict(area, *column.inspection) : 0);
  const bool large = text_width(Font::heading, title) <= room;
  const Font which = large ? Font::heading : Font::bold;
  const std::string text = fitting_text(which, {title, key_of(column.configuration)}, room);
  write_text(list, which, bar + s * Vector2d(16, large ? 0 : 2), text);
  if (!column.inspection) return;
  const std::string below = conditions(*column.inspection, wide);
  write_text(list, Font::small, bar + s * Vector2d(16, 24), below, color_of(Role::text_dim));
}

void draw_caption(const Area& area, const Inspection& inspection, const Inspection* first) {
  const auto& [list, rect] = area;
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
  for (int i = 0; i < 3; ++i)
    errors[i].draw({list, {rect.min + Vector2d(i * third, 0), {third, 0}}}, stacked);
  const std::string text = remarks(inspection, e, rect.size.x());
  write_text(list, Font::small, below, text, color_of(Role::text_dim));
}

void draw_top(const Area& area, const CompareFrame& shown, const Inspection* first) {
  const double s = overlay_scale();
  std::string text = fmt::format("{} · frame {}", shown.recording.name, shown.frame);
  bool inside = false;
  if (first != nullptr) {
    const int start = first->window->start, last = start + first->window->frame_count() - 1;
    inside = FrameView{*first, shown.frame, shown.options}.inside();
    text += fmt::format("{} the window {}–{}", inside ? " of" : ", outside of", start, last);
  }
  const Vector2d at = area.rect.min + s * Vector2d(kGap, 11);
  write_text(area.list, Font::regular, at, text);
  const Vector2d beside(text_width(Font::regular, text) + 30 * s, 0);
  if (inside) draw_cube_legend(area.list, at + beside, first->truth != nullptr);
}

void draw_column_image(const Area& area, const Compared& column, const CompareFrame& shown) {
  if (!column.inspection) {
    ViewOptions plain;
    plain.show.legend = false;
    plain.image_zoom = shown.options.image_zoom;
    const Inspection nothing =
        nothing_to_show({std::shared_ptr<const Recording>(), &shown.recording});
    draw_image_view(area, {nothing, shown.frame, plain}, shown.image);
    if (column.error.empty()) return draw_badge(area, color_of(Role::accent), "computing", "");
    return draw_badge(area, color_of(Role::warning), "not computed", column.error);
  }
  const FrameView view{*column.inspection, shown.frame, shown.options};
  draw_image_view(area, view, shown.image);
  if (shown.options.show.exaggeration <= 1 || !view.inside()) return;
  const bool truth = true_cube(view.inspection, view.in_window(), {1}).has_value();
  const std::string text = fmt::format("distance from the {} cube \u00d7 {}",
                                       truth ? "true" : "first",
                                       shown.options.show.exaggeration);
  draw_legend(area, Corner::bottom_left, "", {{Sign::none, 0, text}});
}

}  // namespace

double aspect_of(const Recording& recording) {
  const Vector2d size = as_shown(recording).size();
  if (size.x() <= 0) return 4.0 / 3;
  return std::clamp(size.x() / size.y(), 1 / 1.5, 1 / 0.4);
}

std::vector<ColumnPlace> compare_places(const ScreenRect& rect,
                                        int count,
                                        double aspect,
                                        bool top_line) {
  const double scale = overlay_scale();
  const Page page{rect, scale, scale * (top_line ? kTopLine : 0)};
  const Grid grid = best_grid(page, count, aspect);
  std::vector<ColumnPlace> places;
  for (int i = 0; i < count; ++i) places.push_back(column_at(page, grid, i));
  return places;
}

ImageZoom compare_zoom(CompareColumns columns,
                       const CompareFrame& shown,
                       const Vector2d& image_size) {
  if (shown.options.compare_zoom) return *shown.options.compare_zoom;
  const auto box = cubes_box(columns, shown.frame, shown.options);
  return zoom_on(box, shown.recording, image_size);
}

void draw_compare_view(const Area& area, CompareColumns columns, const CompareFrame& shown) {
  area.fill(imgui_color(Role::panel));
  if (columns.empty()) return;
  const ViewOptions& options = shown.options;
  const Inspection* first = columns.front().inspection.get();
  if (options.top_line) draw_top(area, shown, first);
  ViewOptions column_options = options;
  // Without an image the tracks show what the cube stands on.
  column_options.show.tracks = !shown.recording.images;
  column_options.show.tails = column_options.show.gravity = column_options.show.legend = false;
  column_options.colors = nullptr;
  column_options.reference = first;
  if (first != nullptr)
    column_options.reference_side = common_cube_side(columns, *first, options.cube_side);
  const double aspect = aspect_of(shown.recording);
  const auto count = static_cast<int>(columns.size());
  const auto places = compare_places(area.rect, count, aspect, options.top_line);
  column_options.image_zoom = compare_zoom(columns, shown, places.front().image.size);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto& [heading, image_rect, caption] = places[i];
    const Compared& column = columns[i];
    if (column.inspection)
      column_options.cube_side = common_cube_side(columns, *column.inspection, options.cube_side);
    draw_heading({area.list, heading}, column);
    draw_column_image({area.list, image_rect},
                      column,
                      {shown.recording, shown.frame, shown.image, column_options});
    if (column.inspection)
      draw_caption({area.list, caption}, *column.inspection, i > 0 ? first : nullptr);
  }
}

double draw_cube_legend(ImDrawList& list, const Vector2d& at, bool truth) {
  const double s = overlay_scale();
  const LegendRow rows[] = {
      {Sign::square, color_of(Role::cube_base), "cube on the estimated plane"},
      {Sign::square, color_of(Role::truth), "true cube"}};
  double x = at.x();
  for (const LegendRow& row : rows) {
    // Texts begin on whole pixels.
    const double text = std::round(x + 13 * s) - x;
    const RowIndent indent{0, static_cast<float>(text)};
    draw_legend_row(list, to_imgui({x, at.y() + s}), row, indent, color_of(Role::text_dim));
    x += 38 * s + text_width(Font::small, row.text);
    if (!truth) break;
  }
  return x - at.x();
}

cv::Size default_compare_size(int columns, const Recording& recording) {
  constexpr int kMostColumns = 4;
  const int count = std::max(1, columns), rows = (count + kMostColumns - 1) / kMostColumns;
  const double image_height = std::round(kColumn / aspect_of(recording));
  return {static_cast<int>((count + rows - 1) / rows * (kColumn + kGap) + kGap),
          static_cast<int>(rows * (kHeading + image_height + kCaption) + kTopLine)};
}

}  // namespace gpo
