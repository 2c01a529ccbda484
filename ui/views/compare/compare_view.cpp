// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/compare/compare_view.h"

#include "ui/context/theme.h"
#include "ui/views/overlay/overlay.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/image/image_view.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <imgui.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

constexpr int kMostColumns = 4;
// Sizes at text scale 1 [px].
constexpr double kColumn = 480, kGap = 12, kTopLine = 38, kHeading = 54, kCaption = 70;

struct Grid {
  int columns, rows;
};

Grid default_grid(int wanted) {
  const int count = std::max(1, wanted);
  const int rows = (count + kMostColumns - 1) / kMostColumns;
  return {(count + rows - 1) / rows, rows};
}

/// The area for columns: a rectangle below a top line.
struct Area {
  const ScreenRect& rect;
  double top;
  double scale;  ///< of text
};

ColumnPlace column_at(const Area& area, const Grid& grid, int index) {
  const auto rounded = [&](double size) { return std::round(area.scale * size); };
  const Vector2d free = area.rect.size - Vector2d(area.scale * kGap, area.top);
  const double width = std::floor(free.x() / grid.columns);
  const double height = std::floor(free.y() / grid.rows);
  const int x = index % grid.columns, y = index / grid.columns;
  const Vector2d at =
      area.rect.min + Vector2d(rounded(kGap) + width * x, std::round(area.top) + height * y);
  const double inner = std::max(1.0, width - rounded(kGap));
  const double heading = rounded(kHeading), caption = rounded(kCaption);
  const double texture = std::max(1.0, height - heading - caption);
  return {{at, {inner, heading}},
          {at + Vector2d(0, heading), {inner, texture}},
          {at + Vector2d(0, heading + texture), {inner, caption}}};
}

/// Returns the grid with the largest images; of equal ones that with the fewest rows.
Grid best_grid(const Area& area, int count, double aspect) {
  Grid best{std::max(1, count), 1};
  double widest = 0;
  for (int rows = 1; rows <= count; ++rows) {
    const Grid one{(count + rows - 1) / rows, rows};
    const Vector2d size = column_at(area, one, 0).image.size;
    const double width = std::min(size.x(), size.y() * aspect);
    if (width <= widest) continue;
    widest = width;
    best = one;
  }
  return best;
}

/// Returns the cube's side in an inspection [unit of the estimate]: the same number of chessboard
/// squares, or of plane distances, as in the first one, so that cubes compare.
double common_cube_side(CompareColumns columns, const Inspection& inspection, double chosen) {
  const auto first = std::ranges::find_if(
      columns, [](const auto& one) { return one.inspection && one.inspection->cube; });
  if (!inspection.cube || first == columns.end()) return 0;
  const CubeAnchor& model = *first->inspection->cube;
  if (model.on_board != inspection.cube->on_board) return cube_side(inspection, chosen);
  return cube_side(*first->inspection, chosen) / model.unit * inspection.cube->unit;
}

Eigen::AlignedBox2d cubes_box(CompareColumns columns, int frame, const ViewOptions& options) {
  Eigen::AlignedBox2d box;
  for (const CompareColumn& column : columns) {
    if (!column.inspection) continue;
    const Inspection& inspection = *column.inspection;
    const FrameView view{inspection, frame, options};
    if (!view.inside()) continue;
    const CubeSize size{common_cube_side(columns, inspection, options.cube_side),
                        options.cube_height_sides};
    for (const auto& cube : {estimated_cube(inspection, view.in_window(), size),
                             true_cube(inspection, view.in_window(), size)})
      for (const CubeEdge& edge : cube.value_or(CubeImage{}).edges)
        for (const Vector2d& pixel : edge.raw_px) box.extend(pixel);
  }
  return box;
}

/// Returns the part of the image around the cubes; the whole image if there are none.
ImageZoom zoom_on(const Eigen::AlignedBox2d& cubes, const Camera& camera, const Vector2d& rect) {
  constexpr double kSurroundings = 2.2;  // size of the part [sizes of the box]
  constexpr double kMostZoom = 3;
  const Vector2d size(camera.width, camera.height);
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

void draw_top(ImDrawList& list,
              const ScreenRect& rect,
              const CompareFrame& shown,
              const Inspection* first) {
  const double s = overlay_scale();
  std::string text = fmt::format("{} · frame {}", shown.recording.name, shown.frame);
  bool inside = false;
  if (first != nullptr) {
    const int start = first->window->start, last = start + first->window->frame_count() - 1;
    inside = FrameView{*first, shown.frame, shown.options}.inside();
    text += fmt::format("{} the window {}–{}", inside ? " of" : ", outside of", start, last);
  }
  const Vector2d at = rect.min + s * Vector2d(kGap, 11);
  write_text(list, Font::regular, at, text);
  const Vector2d beside(text_width(Font::regular, text) + 30 * s, 0);
  if (inside) draw_cube_legend(list, at + beside, first->truth != nullptr);
}

void draw_column_image(ImDrawList& list,
                       const ScreenRect& rect,
                       const CompareColumn& column,
                       const CompareFrame& shown,
                       const ImageZoom& zoom) {
  if (!column.inspection) {
    ViewOptions plain;
    plain.show.legend = false;
    const Inspection nothing =
        nothing_to_show({std::shared_ptr<const Recording>(), &shown.recording});
    draw_image_view(list, rect, {nothing, shown.frame, plain}, shown.texture, zoom);
    const bool computing = column.missing == "computing";
    draw_badge(list,
               rect,
               color_of(computing ? Role::accent : Role::warning),
               computing ? "computing" : "not computed",
               computing ? "" : column.missing);
    return;
  }
  const FrameView view{*column.inspection, shown.frame, shown.options};
  draw_image_view(list, rect, view, shown.texture, zoom);
  if (shown.options.show.exaggeration <= 1 || !view.inside()) return;
  const bool truth = true_cube(view.inspection, view.in_window(), {1}).has_value();
  const std::string text = fmt::format("distance from the {} cube \u00d7 {}",
                                       truth ? "true" : "first",
                                       shown.options.show.exaggeration);
  draw_legend(list, rect, Corner::bottom_left, "", {{Sign::none, 0, text}});
}

}  // namespace

double aspect_of(const Camera& camera) {
  if (camera.width <= 0) return 4.0 / 3;
  return std::clamp(static_cast<double>(camera.width) / camera.height, 1 / 1.5, 1 / 0.4);
}

std::vector<ColumnPlace> compare_places(const ScreenRect& rect,
                                        int count,
                                        double aspect,
                                        bool top_line) {
  const double scale = overlay_scale();
  const Area area{rect, scale * (top_line ? kTopLine : 0), scale};
  const Grid grid = best_grid(area, count, aspect);
  std::vector<ColumnPlace> places;
  for (int i = 0; i < count; ++i) places.push_back(column_at(area, grid, i));
  return places;
}

ImageZoom compare_zoom(CompareColumns columns,
                         const CompareFrame& shown,
                         const Vector2d& image_size) {
  if (shown.options.compare_zoom) return *shown.options.compare_zoom;
  const auto box = cubes_box(columns, shown.frame, shown.options);
  return zoom_on(box, shown.recording.camera, image_size);
}

void draw_compare_view(ImDrawList& list,
                       const ScreenRect& rect,
                       CompareColumns columns,
                       const CompareFrame& shown) {
  list.AddRectFilled(to_imgui(rect.min), to_imgui(rect.min + rect.size), imgui_color(Role::panel));
  if (columns.empty()) return;
  const ViewOptions& options = shown.options;
  const Inspection* first = columns.front().inspection.get();
  if (options.top_line) draw_top(list, rect, shown, first);
  ViewOptions image = options;
  // Without an image the tracks show what the cube stands on.
  image.show.tracks = !shown.recording.images;
  image.show.tails = image.show.gravity = image.show.legend = false;
  image.colors = nullptr;
  image.reference = first;
  if (first != nullptr) image.reference_side = common_cube_side(columns, *first, options.cube_side);
  const auto places = compare_places(
      rect, static_cast<int>(columns.size()), aspect_of(shown.recording.camera), options.top_line);
  const ImageZoom zoom = compare_zoom(columns, shown, places.front().image.size);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto& [heading, texture, caption] = places[i];
    const CompareColumn& column = columns[i];
    if (column.inspection)
      image.cube_side = common_cube_side(columns, *column.inspection, options.cube_side);
    draw_compare_heading(list, heading, column);
    draw_column_image(
        list, texture, column, {shown.recording, shown.frame, shown.texture, image}, zoom);
    if (column.inspection)
      draw_compare_caption(list, caption, *column.inspection, i > 0 ? first : nullptr);
  }
}

void draw_compare_view(ImDrawList& list,
                       const ScreenRect& rect,
                       Comparison inspections,
                       int frame,
                       ImageTexture* texture) {
  const Recording unknown;
  const Recording& recording = inspections.empty() ? unknown : *inspections.front()->recording;
  std::vector<CompareColumn> columns;
  for (const auto& inspection : inspections)
    columns.push_back({configuration_of(inspection->settings), inspection, ""});
  draw_compare_view(list, rect, columns, CompareFrame{recording, frame, texture, {}});
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
    draw_legend_row(list,
                    to_imgui({x, at.y() + s}),
                    row,
                    {0, static_cast<float>(text)},
                    color_of(Role::text_dim));
    x += 38 * s + text_width(Font::small, row.text);
    if (!truth) break;
  }
  return x - at.x();
}

cv::Size default_compare_size(Comparison inspections) {
  const Recording unknown;
  return default_compare_size(static_cast<int>(inspections.size()),
                              inspections.empty() ? unknown : *inspections.front()->recording);
}

cv::Size default_compare_size(int columns, const Recording& recording) {
  const Grid cells = default_grid(columns);
  return {
      static_cast<int>(cells.columns * (kColumn + kGap) + kGap),
      static_cast<int>(
          cells.rows * (kHeading + std::round(kColumn / aspect_of(recording.camera)) + kCaption) +
          kTopLine)};
}

double compare_text_scale(Comparison inspections, cv::Size size) {
  const double natural = default_compare_size(inspections).width;
  return std::clamp(size.width / natural, 0.75, 3.0);
}

}  // namespace gpo
