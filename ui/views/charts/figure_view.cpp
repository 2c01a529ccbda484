// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/figure_view.h"

#include "ui/context/framebuffer.h"
#include "ui/context/memory_file.h"
#include "ui/context/offscreen_context.h"
#include "ui/context/vtk_window.h"
#include "ui/look/palette.h"
#include "ui/views/charts/figure_plots.h"
#include "ui/views/charts/vtk_text.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <regex>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#include <vtkChartXY.h>
#include <vtkContext2D.h>
#include <vtkContextActor.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkRenderer.h>
#include <vtkSVGExporter.h>
#include <vtkTextProperty.h>

namespace gpo {
namespace {

// Of one chart with its titles [px], at which text has its nominal size.
constexpr int kChartWidth = 500, kChartHeight = 440;
constexpr double kTitle_px = 19, kChartTitle_px = 16, kAxisTitle_px = 15, kLegend_px = 15;

class PaintedItem : public vtkContextItem {
 public:
  static PaintedItem* New();
  bool Paint(vtkContext2D* painter) override {
    paint(*painter);
    return true;
  }
  std::function<void(vtkContext2D&)> paint;
  vtkTypeMacro(PaintedItem, vtkContextItem)
};
vtkStandardNewMacro(PaintedItem);

/// Where things are; VTK's y is up [px].
struct FigureLayout {
  double scale;
  cv::Size size;
  std::vector<vtkRectf> axes;                                ///< one a chart
  std::vector<std::pair<vtkRectf, const CurveStyle*>> keys;  ///< samples in the legend
};

/// Rows of samples with their names, centered, from the lower edge up. Returns their height.
double place_legend(FigureLayout& layout, const std::vector<CurveStyle>& styles) {
  const double s = layout.scale, sample = 40 * s, gap = 8 * s, between = 26 * s, row = 26 * s;
  std::vector<std::vector<double>> rows;  // widths
  double free = 0;
  for (const CurveStyle& style : styles) {
    const double width =
        sample + gap + text_width(style.name, Weight::regular, kLegend_px * s) + between;
    if (rows.empty() || width > free) {
      rows.emplace_back();
      free = layout.size.width - 20 * s + between;
    }
    rows.back().push_back(width);
    free -= width;
  }
  auto style = styles.begin();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    double total = -between;
    for (const double width : rows[r]) total += width;
    double x = std::round((layout.size.width - total) / 2);
    const double y = std::round(10 * s + row * static_cast<double>(rows.size() - 1 - r));
    for (const double width : rows[r]) {
      layout.keys.emplace_back(vtkRectf(static_cast<float>(x),
                                        static_cast<float>(y),
                                        static_cast<float>(sample),
                                        static_cast<float>(row)),
                               &*style++);
      x += width;
    }
  }
  return row * static_cast<double>(rows.size());
}

FigureLayout place(const Figure& figure, const std::vector<CurveStyle>& styles, cv::Size size) {
  const double columns = std::max<double>(1, static_cast<double>(figure.charts.size()));
  const double s = std::clamp(
      std::min(size.width / (columns * kChartWidth), 1.0 * size.height / kChartHeight), 0.5, 8.0);
  FigureLayout layout{s, size, {}, {}};
  const double bottom = place_legend(layout, styles) + 70 * s;
  const double top = (figure.title.empty() ? 10 : 42) * s + 34 * s;
  const double column = size.width / columns, left = 90 * s, right = 18 * s;
  for (std::size_t i = 0; i < figure.charts.size(); ++i)
    layout.axes.emplace_back(
        static_cast<float>(std::round(column * static_cast<double>(i) + left)),
        static_cast<float>(std::round(bottom)),
        static_cast<float>(std::max(20.0, std::round(column - left - right))),
        static_cast<float>(std::max(20.0, std::round(size.height - bottom - top))));
  return layout;
}

struct TextStyle {
  Weight weight;
  double size_px;
  bool centered = true;  ///< on x; else it begins there
  bool upwards = false;
  std::uint32_t rgb = palette::kInk;
};

/// Vertically centered on y.
void write(
    vtkContext2D& painter, const std::string& text, double x, double y, const TextStyle& style) {
  vtkNew<vtkTextProperty> property;
  set_font(*property, style.weight, style.size_px, style.rgb);
  property->SetJustification(style.centered ? VTK_TEXT_CENTERED : VTK_TEXT_LEFT);
  property->SetVerticalJustificationToCentered();
  property->SetOrientation(style.upwards ? 90 : 0);
  painter.ApplyTextProp(property);
  painter.DrawString(
      static_cast<float>(std::round(x)), static_cast<float>(std::round(y)), text.c_str());
}

void paint_titles(vtkContext2D& painter, const Chart& chart, const vtkRectf& axes, double s) {
  const double x = axes.GetX() + axes.GetWidth() / 2, y = axes.GetY() + axes.GetHeight() / 2;
  const TextStyle along{Weight::regular, kAxisTitle_px * s};
  TextStyle upwards = along;
  upwards.upwards = true;
  const double top = axes.GetY() + axes.GetHeight();
  write(painter, chart.title, x, top + 20 * s, {Weight::bold, kChartTitle_px * s});
  write(painter, chart.x_label, x, axes.GetY() - 43 * s, along);
  write(painter, chart.y_label, axes.GetX() - 66 * s, y, upwards);
  TextStyle dim = along;
  dim.rgb = palette::kPaperAxis;
  if (!has_values(chart)) write(painter, "no values", x, y, dim);
}

/// Titles, legend, and what is missing.
void paint_text(vtkContext2D& painter, const Figure& figure, const FigureLayout& layout) {
  const double s = layout.scale;
  const double middle = layout.size.width / 2.0;
  const double title_px = kTitle_px * s;
  const double room = (layout.size.width - 20 * s) /
                      std::max(1.0, text_width(figure.title, Weight::bold, title_px));
  write(painter,
        figure.title,
        middle,
        layout.size.height - 26 * s,
        {Weight::bold, title_px * std::min(1.0, room)});
  if (figure.charts.empty())
    write(painter, "no charts", middle, layout.size.height / 2.0, {Weight::regular, kTitle_px * s});
  for (std::size_t i = 0; i < figure.charts.size(); ++i)
    paint_titles(painter, figure.charts[i], layout.axes[i], s);
  for (const auto& [rect, style] : layout.keys) {
    paint_sample(painter, *style, rect, s);
    write(painter,
          style->name,
          rect.GetX() + rect.GetWidth() + 8 * s,
          rect.GetY() + rect.GetHeight() / 2,
          {Weight::regular, kLegend_px * s, false});
  }
}

/// The figure as a scene of VTK's. Needs the context to be current, and to outlive it.
class FigureScene {
 public:
  FigureScene(const Figure& figure, cv::Size size)
      : styles_(curve_styles(figure)), layout_(place(figure, styles_, size)) {
    renderer_->SetBackground(1, 1, 1);
    renderer_->SetBackgroundAlpha(1);
    window_->AddRenderer(renderer_);
    renderer_->AddActor(actor_);
    vtkContextScene& scene = *actor_->GetScene();
    scene.SetRenderer(renderer_);
    for (std::size_t i = 0; i < figure.charts.size(); ++i) {
      vtkNew<vtkChartXY> chart;
      fill_chart(*chart, figure.charts[i], styles_, layout_.axes[i], layout_.scale);
      scene.AddItem(chart);
    }
    vtkNew<PaintedItem> text;
    text->paint = [&](vtkContext2D& painter) { paint_text(painter, figure, layout_); };
    scene.AddItem(text);
  }
  ~FigureScene() { window_->Finalize(); }
  FigureScene(const FigureScene&) = delete;
  FigureScene& operator=(const FigureScene&) = delete;

  VtkWindow& window() { return *window_; }

 private:
  std::vector<CurveStyle> styles_;
  FigureLayout layout_;
  vtkSmartPointer<VtkWindow> window_ = make_vtk_window();
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkContextActor> actor_;
};

/// Calls `use(scene, texture)` with the rendered figure. VTK's complaints become exceptions.
template <class Use>
auto with_scene(const Figure& figure, cv::Size size, const Use& use) {
  std::string complaint;
  const VtkMessages vtk([&complaint](const std::string& message) { complaint += message; });
  OffscreenContext context(size.width, size.height);
  context.bind();
  FigureScene scene(figure, size);
  const unsigned texture = render_to_texture(scene.window(), size.width, size.height);
  auto result = use(scene, texture);
  if (!complaint.empty()) throw std::runtime_error("VTK: " + complaint);
  return result;
}

std::string description(const Figure& figure) {
  std::string text;
  for (const Chart& chart : figure.charts) {
    text += fmt::format("{} ({} over {}):", chart.title, chart.y_label, chart.x_label);
    for (const Curve& curve : chart.curves) text += fmt::format(" {};", curve.name);
    text += '\n';
  }
  return text;
}

}  // namespace

cv::Size default_figure_size(const Figure& figure) {
  const int columns = std::max(1, static_cast<int>(figure.charts.size()));
  return {columns * kChartWidth, kChartHeight + 40};
}

cv::Mat draw_figure(const Figure& figure, cv::Size size) {
  // VTK's markers have no smooth edges: drawn twice as large, where OpenGL can.
  constexpr int kLargestDrawn = 8192;
  const int factor = 2 * std::max(size.width, size.height) <= kLargestDrawn ? 2 : 1;
  return with_scene(figure, size * factor, [&](FigureScene&, unsigned texture) {
    cv::Mat picture;
    cv::resize(read_texture(texture, size.width * factor, size.height * factor),
               picture,
               size,
               0,
               0,
               cv::INTER_AREA);
    return picture;
  });
}

std::string figure_svg(const Figure& figure, cv::Size size) {
  return with_scene(figure, size, [&](FigureScene& scene, unsigned) {
    const MemoryFile file;
    vtkNew<vtkSVGExporter> exporter;
    exporter->SetRenderWindow(&scene.window());
    exporter->SetTitle(figure.title.c_str());
    exporter->SetDescription(description(figure).c_str());
    exporter->SetFileName(file.path().c_str());
    exporter->Write();
    // VTK 9.1 clips upside down, and nothing here reaches beyond its axes. With a viewBox a page
    // can scale the figure.
    const std::string svg =
        std::regex_replace(file.content(), std::regex(" clip-path=\"[^\"]*\""), "");
    return std::regex_replace(svg,
                              std::regex("<svg "),
                              fmt::format("<svg viewBox=\"0 0 {} {}\" ", size.width, size.height));
  });
}

}  // namespace gpo
