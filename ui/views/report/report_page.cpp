// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/files/image_codec.h"
#include "engine/files/text_file.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"
#include "ui/views/charts/charts.h"
#include "ui/views/report/report.h"
#include "ui/views/snapshot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

// Embedded by assets/assets.S.
extern "C" {
extern const char gpo_report_css[], gpo_report_css_end[];
extern const char gpo_report_js[], gpo_report_js_end[];
}

namespace gpo {
namespace {

/// How strongly the images of a page are compressed.
struct ImageLevel {
  int most_width_px;
  int quality;  ///< JPEG, 0 to 100
};
constexpr std::array<ImageLevel, 5> kLevels = {
    {{1280, 88}, {960, 82}, {720, 75}, {520, 66}, {360, 55}}};

std::string image_element(const cv::Mat& bgr, const std::string& alt, const ImageLevel& level) {
  cv::Mat small = bgr;
  if (bgr.cols > level.most_width_px) {
    const double factor = 1.0 * level.most_width_px / bgr.cols;
    cv::resize(bgr, small, {}, factor, factor, cv::INTER_AREA);
  }
  return fmt::format("<img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"{}\">",
                     bgr.cols,
                     bgr.rows,
                     html_text(alt),
                     data_uri("image/jpeg", encode_jpeg(small, level.quality)));
}

std::string element(const char* name, const std::string& text) {
  return text.empty() ? "" : fmt::format("<{0}>{1}</{0}>\n", name, html_text(text));
}

std::string verdict_element(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  const auto shown = [](const std::string& word, const std::string& style, const auto& reason) {
    return fmt::format("<div class=\"verdict {}\"><b>{}</b><span>{}</span></div>\n",
                       style,
                       html_text(word),
                       html_text(reason));
  };
  if (!result.ok) return shown("failed", "failed", result.reason);
  if (!result.verdict) return shown("no verdict", "weak", "the verdict was not computed");
  const std::string word = to_string(result.verdict->readiness);
  return shown(word, word == "no plane" ? "degenerate" : word, result.verdict->reason);
}

std::string cards_element(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  std::string cards;
  const auto add = [&](const std::string& value, const std::string& name) {
    cards += fmt::format("<div><b>{}</b><span>{}</span></div>", html_text(value), html_text(name));
  };
  const Window& window = *inspection.window;
  if (const auto sigma = normal_sigma_deg(inspection); sigma && result.ok)
    add(*sigma <= 90 ? fmt::format("\u00B1 {:.3g}\u00B0", *sigma) : "undetermined",
        result.uncertainty && !result.uncertainty->own
            ? "normal of the plane, 1 sigma of the window"
            : "normal of the plane, 1 sigma");
  add(fmt::format("{} of {}", window.inlier_count(0), window.track_count()), "tracks on the plane");
  if (result.reprojection_rms_px)
    add(fmt::format("{:.3f} px", *result.reprojection_rms_px), "reprojection error, RMS");
  if (const auto scale = known_scale(inspection); scale && result.ok)
    add(fmt::format("{:.3f} m", *scale * result.plane.distance), "distance of the plane");
  const auto& e = inspection.evaluation;
  if (e && e->pne_deg)
    add(fmt::format("{:.3f}\u00B0", *e->pne_deg), "error of the normal (PNE), by ground truth");
  if (e && e->ate_m)
    add(fmt::format("{:.2f} mm", 1e3 * *e->ate_m), "error of the path (ATE), by ground truth");
  return "<div class=\"cards\">" + cards + "</div>\n";
}

std::string frames_element(const ReportSection& section, const ImageLevel& level) {
  if (section.frames.empty()) return "";
  const Inspection& inspection = *section.inspection;
  std::string figures;
  for (const auto& [frame, bgr] : section.frames) {
    const std::string what = fmt::format("Frame {} of {} with tracks{}",
                                         frame,
                                         inspection.recording->name,
                                         inspection.cube ? " and the virtual cube" : "");
    const int inliers = inspection.window->inlier_count(frame - inspection.window->start);
    figures += fmt::format(
        "<figure data-frame=\"{}\">{}<figcaption>Frame {}{}: {} on the main "
        "plane</figcaption></figure>\n",
        frame,
        image_element(bgr, what, level),
        frame,
        frame == inspection.window->start ? ", the reference" : "",
        counted(static_cast<std::size_t>(inliers), "track"));
  }
  return "<h3>Images</h3>\n<p class=\"hint\">Click an image to enlarge it. Point at it to mark its "
         "camera in the scene.</p>\n<div class=\"frames\">\n" +
         figures + "</div>\n";
}

std::string layer_boxes(const Inspection& inspection, const nlohmann::ordered_json& scene) {
  const auto rgb_of = [](Role role) { return color_of(role, Theme::light); };
  std::string boxes;
  const auto add = [&](const char* key, const char* title, std::uint32_t rgb) {
    const auto is_on_it = [&](const auto& item) { return item["layer"] == key; };
    if (std::ranges::any_of(scene["items"], is_on_it))
      boxes += fmt::format(
          "<label><input type=\"checkbox\" checked data-layer=\"{}\"><i "
          "style=\"background:#{:06x}\"></i>{}</label>",
          key,
          rgb,
          title);
  };
  add("picture", "image on the planes", 0x8A8F96);
  add("grid", "grid", rgb_of(Role::plane));
  add("points", "map points", plane_color(inspection.window->leader));
  add("cameras", "cameras", inspection.settings.options.method.row().rgb);
  add("cube", "cube", rgb_of(Role::cube_base));
  add("truth", "ground truth", rgb_of(Role::truth));
  add("axes", "axes", rgb_of(Role::axis_z));
  return boxes;
}

std::string scene_element(const ReportSection& section, const ImageLevel& level) {
  const Inspection& inspection = *section.inspection;
  const auto scene = report_scene(inspection);
  const std::string alt = fmt::format("The estimate of {} in 3-D: planes, cameras, points and cube",
                                      inspection.recording->name);
  std::string cell;
  if (scene.contains("cell"))
    cell = fmt::format(" One cell of the grid is {}.", scene["cell"].get<std::string>());
  return fmt::format(
      "<h3>Scene</h3>\n<div class=\"scene\">\n{}<canvas tabindex=\"0\" role=\"img\" "
      "aria-label=\"{}\"></canvas><div class=\"tip\"></div>\n"
      "<div class=\"tools\">{}<button type=\"button\">Reset</button>"
      "<button type=\"button\" data-pitch=\"89\" data-yaw=\"0\">From the top</button>"
      "<button type=\"button\" data-pitch=\"2\" data-yaw=\"90\">From the side</button></div>\n"
      "<script type=\"application/json\">{}</script></div>\n"
      "<p class=\"hint\">Drag to turn, shift-drag to move, wheel to zoom, double-click to reset; "
      "arrow keys turn, + and - zoom. Coordinates are those of the reference camera: x right, y "
      "down, z forward.{}</p>\n",
      section.scene.empty() ? "" : image_element(section.scene, alt, level),
      html_text(alt),
      layer_boxes(inspection, scene),
      script_json(scene),
      html_text(cell));
}

std::string curves_element(const std::vector<Figure>& figures) {
  std::string made;
  for (const Figure& figure : figures) {
    if (figure.charts.empty()) continue;
    const cv::Size size = default_figure_size(figure);
    const std::string svg = figure_svg(figure, screen_sheet(figure, size));
    made += fmt::format(
        "<figure class=\"charts-{}\"><img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"{}\">"
        "</figure>\n",
        figure.charts.size(),
        size.width,
        size.height,
        html_text(figure.title.empty() ? figure.name : figure.title),
        data_uri("image/svg+xml", svg));
  }
  return made.empty() ? "" : "<h3>Curves</h3>\n" + made;
}

std::string normals_element(const ReportSection& section, const ImageLevel& level) {
  if (section.normals.empty()) return "";
  return fmt::format(
      "<h3>Normals</h3>\n<figure class=\"normals\">{}<figcaption>The hemisphere of normals: "
      "brighter "
      "cells fit the window worse; rings and marks are the candidates of the "
      "homographies, the estimate and, if known, the truth.</figcaption></figure>\n",
      image_element(section.normals,
                    "Normals that fit the window of " + section.inspection->recording->name,
                    level));
}

/// Returns each result as JSON, as `run --json` writes it.
std::string results_element(const ReportSection& section) {
  std::string made;
  const auto add = [&](const Inspection& inspection) {
    made += fmt::format(
        "<script type=\"application/json\" class=\"result\" data-method=\"{}\">{}</script>\n",
        html_text(key_of(configuration_of(inspection.settings))),
        script_json(to_json(inspection)));
  };
  add(*section.inspection);
  for (const Compared& one : section.methods)
    if (one.inspection && one.inspection != section.inspection) add(*one.inspection);
  return made;
}

std::vector<std::shared_ptr<const Inspection>> compared_in(const ReportSection& section) {
  std::vector<std::shared_ptr<const Inspection>> all;
  for (const Compared& one : section.methods)
    if (one.inspection) all.push_back(one.inspection);
  if (all.empty()) all.push_back(section.inspection);
  return all;
}

std::string section_title(const ReportSection& section) {
  const Inspection& inspection = *section.inspection;
  const Window& window = *inspection.window;
  return fmt::format("{}: frames {} to {}, {}",
                     inspection.recording->name,
                     window.start,
                     window.start + window.frame_count() - 1,
                     title_of(configuration_of(inspection.settings)));
}

std::string section_element(const ReportSection& section,
                            std::size_t number,
                            const ImageLevel& level) {
  const Inspection& inspection = *section.inspection;
  std::string made = fmt::format("<section id=\"recording-{}\">\n<h2{}>{}</h2>\n",
                                 number,
                                 number == 1 ? " class=\"first\"" : "",
                                 html_text(section_title(section)));
  made += verdict_element(inspection) + cards_element(inspection);
  made += findings_table(inspection.findings);
  made += frames_element(section, level) + scene_element(section, level);
  if (inspection.initialization->ok)
    made +=
        "<h3>Numbers</h3>\n<p class=\"hint\">The unit d is the distance of the main plane from the "
        "reference camera. Standard deviations include what the table names, not a wrong "
        "model.</p>\n" +
        numbers_table(inspection);
  if (!section.methods.empty())
    made += "<h3>Methods</h3>\n" + comparison_table(compared_in(section), false);
  made += normals_element(section, level) + curves_element(section.figures);
  made += "<h3>Settings</h3>\n" + settings_table_html(inspection);
  made += "<h3>Result</h3>\n" + element("pre", to_text(inspection));
  if (!section.found.empty()) made += "<h3>Recording</h3>\n" + element("pre", section.found);
  made += "<h3>Reproduce</h3>\n" + element("pre", section.command);
  return made + results_element(section) + "</section>\n";
}

std::string summary_element(const Report& report) {
  if (report.sections.size() < 2) return "";
  std::string links;
  std::vector<std::shared_ptr<const Inspection>> all;
  for (std::size_t i = 0; i < report.sections.size(); ++i) {
    links += fmt::format("<a href=\"#recording-{}\">{}</a>",
                         i + 1,
                         html_text(report.sections[i].inspection->recording->name));
    for (auto& one : compared_in(report.sections[i])) all.push_back(std::move(one));
  }
  return fmt::format("<nav>{}</nav>\n<h3>Comparison</h3>\n{}", links, comparison_table(all, true));
}

std::string report_title(const Report& report) {
  if (report.sections.size() == 1)
    return report.sections.front().inspection->recording->name + ": initialization from a plane";
  return fmt::format("Initialization from a plane: {} recordings", report.sections.size());
}

std::string page_at(const Report& report, const ImageLevel& level) {
  std::string sections;
  for (std::size_t i = 0; i < report.sections.size(); ++i)
    sections += section_element(report.sections[i], i + 1, level);
  const std::string program = html_text("gpo-inspector " + report.program);
  // The policy makes sure that the page asks no server for anything.
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"{0}\">\n<title>{1}</title>\n<style>\n{2}</style>\n"
      "</head>\n<body>\n<header>\n<h1>{1}</h1>\n<p class=\"dim\">Written by {0}</p>\n</header>\n"
      "{3}{4}<script>\n{5}</script>\n</body>\n</html>\n",
      program,
      html_text(report_title(report)),
      std::string_view(gpo_report_css, gpo_report_css_end),
      summary_element(report),
      sections,
      std::string_view(gpo_report_js, gpo_report_js_end));
}

}  // namespace

std::vector<int> report_frames(const Inspection& inspection) {
  constexpr int kShown = 5;
  const int last = inspection.window->frame_count() - 1;
  std::vector<int> frames;
  for (int k = 0; k < kShown; ++k) {
    const int frame = inspection.window->start + k * last / (kShown - 1);
    if (frames.empty() || frames.back() != frame) frames.push_back(frame);
  }
  return frames;
}

ReportSection drawn_section(const std::shared_ptr<const Inspection>& inspection) {
  ReportSection section{.inspection = inspection};
  for (const int frame : report_frames(*inspection))
    section.frames.push_back({frame, snapshot_image(*inspection, frame)});
  section.scene = snapshot_scene(*inspection,
                                 inspection->window->start,
                                 cv::Size(1120, 630),
                                 {.says_failure = false},
                                 Theme::light);
  section.normals =
      snapshot_normals(inspection, section.frames.back().frame, cv::Size(860, 780), Theme::light);
  return section;
}

Figure with_single_windows(Figure figure, const std::string& recording, int start) {
  for (Chart& chart : figure.charts)
    for (Curve& curve : chart.curves) curve.counts.clear();
  figure.title = fmt::format("{}: windows from frame {} over their length", recording, start);
  return figure;
}

Figure growth_figure(const Inspection& inspection) {
  Curve curve{.name = "1 sigma of the normal", .rgb = color_of(Role::accent, Theme::light)};
  int frames = 2;
  // The last verdict is that of the result, by another estimator.
  const auto& growth = shown_growth(inspection);
  for (const Verdict& verdict : std::span(growth).first(growth.empty() ? 0 : growth.size() - 1)) {
    if (verdict.normal_sigma_deg && *verdict.normal_sigma_deg > 0) {
      curve.x.push_back(frames);
      curve.y.push_back(*verdict.normal_sigma_deg);
    }
    ++frames;
  }
  Figure figure{.name = "growth", .title = "The growing window, before the method"};
  if (curve.x.size() < 2) return figure;
  figure.charts.push_back({.title = "",
                           .x_label = "frames of the window",
                           .y_label = "normal, 1 sigma [deg]",
                           .logarithmic = true,
                           .curves = {std::move(curve)}});
  return figure;
}

std::string report_page(const Report& report) {
  std::size_t bytes = 0;
  for (const ImageLevel& level : kLevels) {
    std::string page = page_at(report, level);
    if (page.size() <= kMostReportBytes) return page;
    bytes = page.size();
  }
  throw InputError(
      fmt::format("the report of {} would have {:.1f} MB, more than {:.0f} MB, with the smallest "
                  "images; choose fewer recordings, methods or frames",
                  counted(report.sections.size(), "recording"),
                  1e-6 * static_cast<double>(bytes),
                  1e-6 * kMostReportBytes));
}

}  // namespace gpo
