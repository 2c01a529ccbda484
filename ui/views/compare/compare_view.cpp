// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/compare/compare_view.h"

#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/views/compare/compare_caption.h"
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

/// Of a picture that nobody gave a size.
Grid default_grid(int wanted) {
  const int count = std::max(1, wanted);
  const int rows = (count + kMostColumns - 1) / kMostColumns;
  return {(count + rows - 1) / rows, rows};
}

ColumnPlace column_at(
    const ScreenRect& rect, const Grid& grid, int index, double top, double scale) {
  const Vector2d free = rect.size - Vector2d(scale * kGap, top);
  const double width = std::floor(free.x() / grid.columns),
               height = std::floor(free.y() / grid.rows);
  const int x = index % grid.columns, y = index / grid.columns;
  const Vector2d at =
      rect.min + Vector2d(std::round(scale * kGap) + width * x, std::round(top) + height * y);
  const double inner = std::max(1.0, width - std::round(scale * kGap));
  const double heading = std::round(scale * kHeading), caption = std::round(scale * kCaption);
  const double texture = std::max(1.0, height - heading - caption);
  return {{at, {inner, heading}},
          {at + Vector2d(0, heading), {inner, texture}},
          {at + Vector2d(0, heading + texture), {inner, caption}}};
}

/// The one whose pictures are largest; of equal ones the one with fewest rows.
Grid best_grid(const ScreenRect& rect, int count, double aspect, double top, double scale) {
  Grid best{std::max(1, count), 1};
  double widest = 0;
  for (int rows = 1; rows <= count; ++rows) {
    const Grid one{(count + rows - 1) / rows, rows};
    const Vector2d size = column_at(rect, one, 0, top, scale).image.size;
    const double width = std::min(size.x(), size.y() * aspect);
    if (width <= widest) continue;
    widest = width;
    best = one;
  }
  return best;
}

using Columns = std::span<const CompareColumn>;

/// One size for all, so that they compare: as many squares of the board, or distances of the plane,
/// as the first one's [unit of the estimate].
double common_cube_side(Columns columns, const Inspection& inspection, double chosen) {
  const auto first = std::ranges::find_if(
      columns, [](const auto& one) { return one.inspection && one.inspection->cube; });
  if (!inspection.cube || first == columns.end()) return 0;
  const CubeAnchor& model = *first->inspection->cube;
  if (model.on_board != inspection.cube->on_board) return cube_side(inspection, chosen);
  return cube_side(*first->inspection, chosen) / model.unit * inspection.cube->unit;
}

/// What both kinds of cubes cover [raw px].
Eigen::AlignedBox2d cubes_box(Columns columns, int frame, const ViewOptions& options) {
  Eigen::AlignedBox2d box;
  for (const CompareColumn& column : columns) {
    if (!column.inspection) continue;
    const Inspection& inspection = *column.inspection;
    const int in_window = frame - inspection.window->start;
    if (in_window < 0 || in_window >= inspection.window->frame_count()) continue;
    const double side = common_cube_side(columns, inspection, options.cube_side);
    for (const auto& cube : {estimated_cube(inspection, in_window, side, options.cube_height_sides),
                             true_cube(inspection, in_window, side, options.cube_height_sides)})
      for (const CubeEdge& edge : cube.value_or(CubeImage{}).edges)
        for (const Vector2d& pixel : edge.raw_px) box.extend(pixel);
  }
  return box;
}

/// The part of the picture around the cubes that all columns show; all of it where there are none.
ImageZoom zoom_on(const Eigen::AlignedBox2d& cubes, const Camera& camera, const Vector2d& rect) {
  constexpr double kSurroundings = 2.2;  // of the cubes' size
  constexpr double kMostZoom = 3;
  const Vector2d size(camera.width, camera.height);
  const Eigen::AlignedBox2d box = cubes.intersection({Vector2d::Zero(), size});
  if (box.isEmpty()) return {};
  const double fit = rect.cwiseQuotient(size).minCoeff();
  const Vector2d wanted = (kSurroundings * fit * box.sizes()).cwiseMax(1e-6);
  ImageZoom zoom;
  zoom.factor = std::clamp(rect.cwiseQuotient(wanted).minCoeff(), 1.0, kMostZoom);
  // As much of the picture as fits, none of what is beyond its border.
  const Vector2d shown = rect.cwiseQuotient(fit * zoom.factor * size);
  for (int axis = 0; axis < 2; ++axis) {
    const double half = std::min(0.5, shown[axis] / 2);
    zoom.center[axis] = std::clamp(box.center()[axis] / size[axis], half, 1 - half);
  }
  return zoom;
}

void draw_top(ImDrawList& list,
              const ScreenRect& rect,
              const Recording& recording,
              const Inspection* one,
              int frame) {
  const double s = overlay_scale();
  std::string text = fmt::format("{} · frame {}", recording.name, frame);
  bool inside = false;
  if (one) {
    const int first = one->window->start, last = first + one->window->frame_count() - 1;
    inside = frame >= first && frame <= last;
    text += fmt::format("{} the window {}–{}", inside ? " of" : ", outside of", first, last);
  }
  const Vector2d at = rect.min + s * Vector2d(kGap, 11);
  write_text(list, Font::regular, at, text);
  if (!inside) return;
  draw_cube_legend(
      list, at + Vector2d(text_width(Font::regular, text) + 30 * s, 0), one->truth != nullptr);
}

void draw_column(ImDrawList& list,
                 const ColumnPlace& place,
                 const CompareColumn& column,
                 const Inspection* first,
                 int frame,
                 ImageTexture* texture,
                 const ImageZoom& zoom,
                 const ViewOptions& options) {
  const Inspection& inspection = *column.inspection;
  draw_compare_heading(list, place.heading, column);
  draw_image_view(list, place.image, inspection, frame, texture, zoom, options);
  const int in_window = frame - inspection.window->start;
  if (options.show.exaggeration > 1 && in_window >= 0 &&
      in_window < inspection.window->frame_count())
    draw_legend(
        list,
        place.image,
        Corner::bottom_left,
        "",
        {{Sign::none,
          0,
          fmt::format("cube's distance from {} \u00d7 {}",
                      true_cube(inspection, in_window, 1) ? "the true one" : "the first one",
                      options.show.exaggeration)}});
  draw_compare_caption(list, place.caption, inspection, first);
}

/// What is still computed, or could not be: the picture alone, and why.
void draw_missing(ImDrawList& list,
                  const ColumnPlace& place,
                  const CompareColumn& column,
                  const Inspection& nothing,
                  int frame,
                  ImageTexture* texture,
                  const ImageZoom& zoom) {
  draw_compare_heading(list, place.heading, column);
  ViewOptions plain;
  plain.show.legend = false;
  draw_image_view(list, place.image, nothing, frame, texture, zoom, plain);
  const bool computing = column.missing == "computing";
  draw_badge(list,
             place.image,
             computing ? color_of(Role::accent) : color_of(Role::warning),
             computing ? "computing" : "not computed",
             computing ? "" : column.missing);
}

std::vector<CompareColumn> columns_of(Comparison inspections) {
  std::vector<CompareColumn> columns;
  for (const auto& inspection : inspections)
    columns.push_back({configuration_of(inspection->settings), inspection, ""});
  return columns;
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
  const double top = scale * (top_line ? kTopLine : 0);
  const Grid grid = best_grid(rect, count, aspect, top, scale);
  std::vector<ColumnPlace> places;
  places.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) places.push_back(column_at(rect, grid, i, top, scale));
  return places;
}

ImageZoom compare_zoom(std::span<const CompareColumn> columns,
                         const Recording& recording,
                         int frame,
                         const Eigen::Vector2d& image_size,
                         const ViewOptions& options) {
  if (options.compare_zoom) return *options.compare_zoom;
  return zoom_on(cubes_box(columns, frame, options), recording.camera, image_size);
}

void draw_compare_view(ImDrawList& list,
                       const ScreenRect& rect,
                       std::span<const CompareColumn> columns,
                       const Recording& recording,
                       int frame,
                       ImageTexture* texture,
                       const ViewOptions& options) {
  list.AddRectFilled(to_imgui(rect.min), to_imgui(rect.min + rect.size), imgui_color(Role::panel));
  if (columns.empty()) return;
  const Inspection* first = columns.front().inspection.get();
  if (options.top_line) draw_top(list, rect, recording, first, frame);
  // Where there is no picture the tracks say what the cube stands on.
  ViewOptions image = options;
  image.show.tracks = !recording.images;
  image.show.tails = image.show.gravity = image.show.legend = false;
  image.colors = nullptr;
  image.reference = first;
  if (first != nullptr) image.reference_side = common_cube_side(columns, *first, options.cube_side);
  const auto places = compare_places(
      rect, static_cast<int>(columns.size()), aspect_of(recording.camera), options.top_line);
  const ImageZoom zoom =
      compare_zoom(columns, recording, frame, places.front().image.size, options);
  const Inspection nothing = nothing_to_show({std::shared_ptr<const Recording>(), &recording});
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!columns[i].inspection) {
      draw_missing(list, places[i], columns[i], nothing, frame, texture, zoom);
      continue;
    }
    image.cube_side = common_cube_side(columns, *columns[i].inspection, options.cube_side);
    draw_column(list, places[i], columns[i], i > 0 ? first : nullptr, frame, texture, zoom, image);
  }
}

void draw_compare_view(ImDrawList& list,
                       const ScreenRect& rect,
                       Comparison inspections,
                       int frame,
                       ImageTexture* texture) {
  if (inspections.empty()) {
    list.AddRectFilled(
        to_imgui(rect.min), to_imgui(rect.min + rect.size), imgui_color(Role::panel));
    return;
  }
  draw_compare_view(
      list, rect, columns_of(inspections), *inspections.front()->recording, frame, texture, {});
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
                    0,
                    static_cast<float>(text),
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
