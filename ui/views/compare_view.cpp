// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/compare_view.h"

#include "engine/experiment/configuration.h"
#include "ui/context/gui.h"
#include "ui/views/image_view.h"
#include "ui/views/numbers.h"
#include "ui/views/overlay.h"
#include "ui/views/palette.h"
#include "ui/views/verdict_look.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

constexpr int kMostColumns = 4;
// Sizes at text scale 1 [px].
constexpr double kColumn = 480, kGap = 12, kTop = 38, kHeading = 54, kCaption = 58;

struct Grid {
  int columns, rows;
};

Grid grid(Comparison inspections) {
  const int count = std::max(1, static_cast<int>(inspections.size()));
  const int rows = (count + kMostColumns - 1) / kMostColumns;
  return {(count + rows - 1) / rows, rows};
}

/// Heading, picture and caption of one column.
struct Column {
  ScreenRect heading, picture, caption;
};

Column column_at(const ScreenRect& rect, const Grid& grid, int index, double scale) {
  const Vector2d free = rect.size - scale * Vector2d(kGap, kTop);
  const double width = std::floor(free.x() / grid.columns),
               height = std::floor(free.y() / grid.rows);
  const int x = index % grid.columns, y = index / grid.columns;
  const Vector2d at = rect.min + Vector2d(std::round(scale * kGap) + width * x,
                                          std::round(scale * kTop) + height * y);
  const double inner = width - std::round(scale * kGap);
  const double heading = std::round(scale * kHeading), caption = std::round(scale * kCaption);
  const double picture = std::max(1.0, height - heading - caption);
  return {{at, {inner, heading}},
          {at + Vector2d(0, heading), {inner, picture}},
          {at + Vector2d(0, heading + picture), {inner, caption}}};
}

/// One size for all, so that they compare: as many squares of the board, or distances of the plane,
/// as the first one's [unit of the estimate].
double common_cube_side(Comparison inspections, const Inspection& inspection) {
  const auto first =
      std::ranges::find_if(inspections, [](const auto& one) { return one->cube.has_value(); });
  if (!inspection.cube || first == inspections.end()) return 0;
  const CubeAnchor& model = *(*first)->cube;
  if (model.on_board != inspection.cube->on_board) return cube_side(inspection, 0);
  return cube_side(**first, 0) / model.unit * inspection.cube->unit;
}

/// What both kinds of cubes cover [raw px].
Eigen::AlignedBox2d cubes_box(Comparison inspections, int frame) {
  Eigen::AlignedBox2d box;
  for (const auto& inspection : inspections) {
    const int in_window = frame - inspection->window->start;
    if (in_window < 0 || in_window >= inspection->window->frame_count()) continue;
    const double side = common_cube_side(inspections, *inspection);
    for (const auto& cube :
         {estimated_cube(*inspection, in_window, side), true_cube(*inspection, in_window, side)})
      for (const CubeEdge& edge : cube.value_or(CubePicture{}).edges)
        for (const Vector2d& pixel : edge.raw_px) box.extend(pixel);
  }
  return box;
}

/// The part of the picture around the cubes that all columns show; all of it where there are none.
PictureZoom zoom_on(const Eigen::AlignedBox2d& cubes, const Camera& camera, const Vector2d& rect) {
  constexpr double kSurroundings = 2.2;  // of the cubes' size
  constexpr double kMostZoom = 3;
  const Vector2d size(camera.width, camera.height);
  const Eigen::AlignedBox2d box = cubes.intersection({Vector2d::Zero(), size});
  if (box.isEmpty()) return {};
  const double fit = rect.cwiseQuotient(size).minCoeff();
  const Vector2d wanted = (kSurroundings * fit * box.sizes()).cwiseMax(1e-6);
  PictureZoom zoom;
  zoom.factor = std::clamp(rect.cwiseQuotient(wanted).minCoeff(), 1.0, kMostZoom);
  // As much of the picture as fits, none of what is beyond its border.
  const Vector2d shown = rect.cwiseQuotient(fit * zoom.factor * size);
  for (int axis = 0; axis < 2; ++axis) {
    const double half = std::min(0.5, shown[axis] / 2);
    zoom.center[axis] = std::clamp(box.center()[axis] / size[axis], half, 1 - half);
  }
  return zoom;
}

void write(ImDrawList& list,
           Font which,
           const Vector2d& at,
           const std::string& text,
           std::uint32_t rgb = palette::kText) {
  const ImFont* f = font(which);
  const ImVec2 place(std::round(static_cast<float>(at.x())),
                     std::round(static_cast<float>(at.y())));
  list.AddText(f, f->FontSize, place, imgui_color(rgb), text.c_str());
}

double width_of(Font which, const std::string& text) {
  const ImFont* f = font(which);
  return f->CalcTextSizeA(f->FontSize, 1e6F, 0, text.c_str()).x;
}

Configuration configuration_of(const Settings& settings) {
  return {settings.method, settings.ransac, settings.rotations};
}

std::string conditions(const Inspection& inspection) {
  const Window& window = *inspection.window;
  const std::string tracks =
      uses_ransac(inspection.settings)
          ? fmt::format("RANSAC on · {} of {} tracks", window.inlier_count(0), window.track_count())
          : fmt::format("RANSAC off · all {} tracks", window.track_count());
  return fmt::format("rotations: {} · {}", to_string(inspection.rotations_used), tracks);
}

/// Sign and word of the verdict, ending at the rectangle's right edge. Returns its width [px].
double draw_verdict(ImDrawList& list, const ScreenRect& rect, const Inspection& inspection) {
  const auto& verdict = inspection.initialization->verdict;
  if (!verdict) return 0;
  const double s = overlay_scale();
  const ReadinessLook look = look_of(verdict->readiness);
  const std::string word = to_string(verdict->readiness);
  const double width = 16 * s + width_of(Font::small, word);
  const Vector2d at = rect.min + Vector2d(rect.size.x() - width, 12 * s);
  draw_sign(list, look.sign, to_imgui(at + s * Vector2d(6, 8)), look.rgb);
  write(list, Font::small, at + Vector2d(16 * s, 0), word, look.rgb);
  return width + 10 * s;
}

void draw_heading(ImDrawList& list, const ScreenRect& rect, const Inspection& inspection) {
  const double s = overlay_scale();
  const Configuration configuration = configuration_of(inspection.settings);
  const Vector2d bar = rect.min + Vector2d(0, 8 * s);
  list.AddRectFilled(to_imgui(bar),
                     to_imgui(bar + s * Vector2d(6, 40)),
                     imgui_color(color_of(configuration)),
                     static_cast<float>(2 * s));
  const std::string title = title_of(configuration);
  const double room = rect.size.x() - 16 * s - draw_verdict(list, rect, inspection);
  const Font large = width_of(Font::heading, title) <= room ? Font::heading : Font::bold;
  write(list, large, bar + s * Vector2d(16, large == Font::heading ? 0 : 2), title);
  write(list, Font::small, bar + s * Vector2d(16, 24), conditions(inspection), palette::kTextDim);
}

std::string known(const std::optional<double>& value, std::string (*text)(double)) {
  return value ? text(*value) : "–";
}

std::string why_no_metrics(const Inspection& inspection) {
  if (!inspection.truth) return "no ground truth";
  const Alignment alignment = inspection.evaluation->alignment;
  if (alignment == Alignment::point) return "the true path is a point: no scale";
  return "the ground truth does not cover the reference frame or the plane";
}

/// What stands below the errors.
std::string remarks(const Inspection& inspection, const Evaluation& e) {
  std::string text = fmt::format("RMS {} px", number_text(inspection.initialization->rms_px, 2));
  if (const auto& uncertainty = inspection.initialization->uncertainty)
    text += " · normal ±" + angle_text(uncertainty->normal_sigma_deg);
  if (e.pne_bound_deg) text += fmt::format(" · PNE bound {}", angle_text(*e.pne_bound_deg));
  if (!e.pne_deg || !e.ate_m) text += " · " + why_no_metrics(inspection);
  return text;
}

void draw_caption(ImDrawList& list, const ScreenRect& rect, const Inspection& inspection) {
  const double s = overlay_scale();
  const Vector2d first = rect.min + Vector2d(0, 8 * s), second = rect.min + Vector2d(0, 31 * s);
  if (!inspection.initialization->ok) {
    write(list, Font::bold, first, "not initialized", palette::kWarning);
    return;
  }
  const Evaluation e = inspection.evaluation.value_or(Evaluation{});
  Vector2d at = first;
  for (const auto& [name, value] : {std::pair("PNE", known(e.pne_deg, angle_text)),
                                    std::pair("ATE", known(e.ate_m, length_text)),
                                    std::pair("PDE", known(e.pde_m, length_text))}) {
    write(list, Font::regular, at, name, palette::kTextDim);
    at.x() += width_of(Font::regular, name) + 6 * s;
    write(list, Font::bold, at, value);
    at.x() += width_of(Font::bold, value) + 22 * s;
  }
  write(list, Font::small, second, remarks(inspection, e), palette::kTextDim);
}

void draw_top(ImDrawList& list, const ScreenRect& rect, const Inspection& one, int frame) {
  const double s = overlay_scale();
  const int first = one.window->start, last = first + one.window->frame_count() - 1;
  std::string text =
      fmt::format("{} · frame {} of the window {}–{}", one.recording->name, frame, first, last);
  const bool inside = frame >= first && frame <= last;
  if (!inside)
    text = fmt::format(
        "{} · frame {}, outside of the window {}–{}", one.recording->name, frame, first, last);
  const Vector2d at = rect.min + s * Vector2d(kGap, 11);
  write(list, Font::regular, at, text);
  if (!inside) return;
  const std::pair<std::uint32_t, const char*> signs[] = {
      {palette::kCubeBase, "cube on the estimated plane"}, {palette::kTruth, "true cube"}};
  double x = at.x() + width_of(Font::regular, text) + 30 * s;
  for (const auto& [rgb, meaning] : signs) {
    draw_sign(list, Sign::square, to_imgui({x, at.y() + 8 * s}), rgb);
    write(list, Font::small, {x + 13 * s, at.y() + s}, meaning, palette::kTextDim);
    x += 38 * s + width_of(Font::small, meaning);
    if (!one.truth) break;
  }
}

}  // namespace

void draw_compare_view(ImDrawList& list,
                       const ScreenRect& rect,
                       Comparison inspections,
                       int frame,
                       PictureTexture* picture) {
  list.AddRectFilled(
      to_imgui(rect.min), to_imgui(rect.min + rect.size), imgui_color(palette::kPanel));
  if (inspections.empty()) return;
  draw_top(list, rect, *inspections.front(), frame);
  const Grid cells = grid(inspections);
  const Eigen::AlignedBox2d cubes = cubes_box(inspections, frame);
  // Where there is no picture the tracks say what the cube stands on.
  const bool no_pictures = !inspections.front()->recording->pictures;
  ImageViewOptions options{.tracks = no_pictures, .tail_frames = 0, .legend = false};
  for (std::size_t i = 0; i < inspections.size(); ++i) {
    const Inspection& inspection = *inspections[i];
    const Column column = column_at(rect, cells, static_cast<int>(i), overlay_scale());
    const PictureZoom zoom = zoom_on(cubes, inspection.recording->camera, column.picture.size);
    options.cube_side = common_cube_side(inspections, inspection);
    draw_heading(list, column.heading, inspection);
    draw_image_view(list, column.picture, inspection, frame, picture, zoom, options);
    draw_caption(list, column.caption, inspection);
  }
}

cv::Size default_compare_size(Comparison inspections) {
  const Grid cells = grid(inspections);
  double aspect = 0.75;
  if (!inspections.empty()) {
    const Camera& camera = inspections.front()->recording->camera;
    aspect = std::clamp(static_cast<double>(camera.height) / camera.width, 0.4, 1.5);
  }
  return {
      static_cast<int>(cells.columns * (kColumn + kGap) + kGap),
      static_cast<int>(cells.rows * (kHeading + std::round(kColumn * aspect) + kCaption) + kTop)};
}

double compare_text_scale(Comparison inspections, cv::Size size) {
  const double natural = default_compare_size(inspections).width;
  return std::clamp(size.width / natural, 0.75, 3.0);
}

}  // namespace gpo
