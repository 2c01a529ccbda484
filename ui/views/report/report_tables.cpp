// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/experiment/row.h"
#include "engine/files/text_file.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"
#include "engine/recording/board/board.h"
#include "ui/views/report/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using Eigen::Vector3d;
using NumberRows = std::vector<std::vector<HtmlCell>>;

std::string vector_text(const Vector3d& v, int digits) {
  return fmt::format("{:.{}f}", fmt::join(v, " "), digits);
}

/// Returns a standard deviation of a direction; beyond a right angle it means nothing.
std::string text_of_sigma(double sigma_deg) {
  return sigma_deg <= 90 ? fmt::format("{:.3g} deg", sigma_deg) : "undetermined";
}

/// Collects rows of a quantity, its value, its standard deviation, and what they depend on.
struct Numbers {
  NumberRows rows{};

  void add(const std::string& name,
           const std::string& value,
           const std::string& sigma,
           const std::string& about = "") {
    rows.push_back({{name}, {value}, {sigma}, {about}});
  }
};

std::string normal_parts(const Uncertainty& u) {
  std::string text = u.own ? "" : "of the window, not of the method; ";
  text += fmt::format("rotations {}", to_string(u.rotations));
  const auto add = [&](const char* name, const std::optional<double>& sigma) {
    if (sigma && *sigma > 0) text += fmt::format(", {} {:.3g} deg", name, *sigma);
  };
  add("neighboring tracks", u.neighbors_sigma_deg);
  add("bent surface", u.bend_sigma_deg);
  add("late clock", u.clock_sigma_deg);
  add("rolling shutter", u.shutter_sigma_deg);
  add("lens", u.lens_sigma_deg);
  if (u.typical_lens_sigma_deg)
    text += fmt::format("; {:.3g} deg with a typical error of the calibration",
                        *u.typical_lens_sigma_deg);
  return text;
}

void add_planes(Numbers& numbers, const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  const auto& u = result.uncertainty;
  numbers.add("normal of the main plane",
              vector_text(result.plane.normal, 5),
              u ? text_of_sigma(u->normal_sigma_deg) : "unknown",
              u ? normal_parts(*u) : "the method states no uncertainty");
  for (const PlaneEstimate& one : result.planes) {
    if (one.number == inspection.window->leader) continue;
    const std::string name = plane_title(inspection, one.number);
    std::string sigma = "unknown";
    if (const auto& covariance = one.normal_covariance)
      sigma = text_of_sigma(degrees(std::sqrt(std::max(0.0, covariance->trace()))));
    numbers.add("normal of " + name, vector_text(one.plane.normal, 5), sigma);
    numbers.add("distance of " + name,
                fmt::format("{:.4f} d", one.plane.distance),
                one.distance_sigma ? fmt::format("{:.2g} d", *one.distance_sigma) : "unknown");
  }
  for (int k = 0; k < std::ssize(inspection.window->planes); ++k)
    if (const auto name = plane_name(inspection, k))
      numbers.add(fmt::format("tilt of plane {}", k + 1),
                  fmt::format("{:.2f} deg from up", name->tilt_deg),
                  name->sigma_deg ? text_of_sigma(*name->sigma_deg) : "unknown",
                  name->name);
}

void add_poses(Numbers& numbers, const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  double path = 0;
  for (std::size_t i = 1; i < result.cameras.size(); ++i)
    path += (result.cameras[i].p_wc - result.cameras[i - 1].p_wc).norm();
  numbers.add("length of the camera's path", fmt::format("{:.4f} d", path), "");
  if (result.cameras.empty()) return;
  const auto& u = result.uncertainty;
  const bool known = u && u->center_covariances.size() == result.cameras.size();
  numbers.add(
      "center of the last camera",
      vector_text(result.cameras.back().p_wc, 4) + " d",
      known ? fmt::format("{:.2g} d", std::sqrt(u->center_covariances.back().trace())) : "unknown",
      "root of the covariance's trace");
}

void add_sensor_numbers(Numbers& numbers, const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  const auto& u = result.uncertainty;
  if (result.bias_rad_s)
    numbers.add(
        "bias of the gyroscope",
        vector_text(*result.bias_rad_s, 5) + " rad/s",
        u && u->bias_covariance
            ? vector_text(u->bias_covariance->diagonal().cwiseMax(0).cwiseSqrt(), 5) + " rad/s"
            : "unknown");
  if (result.time_offset_s)
    numbers.add("time offset of the gyroscope",
                fmt::format("{:.2f} ms", 1e3 * *result.time_offset_s),
                u && u->time_offset_sigma_s
                    ? fmt::format("{:.2g} ms", 1e3 * *u->time_offset_sigma_s)
                    : "unknown");
  if (result.row_delay_s)
    numbers.add("row delay",
                fmt::format("{:.2f} us", 1e6 * *result.row_delay_s),
                u && u->row_delay_sigma_s ? fmt::format("{:.2g} us", 1e6 * *u->row_delay_sigma_s)
                                          : "unknown");
}

void add_gravity_and_scale(Numbers& numbers, const Inspection& inspection) {
  const auto& inertial = inspection.inertial;
  if (inertial && inertial->ok)
    numbers.add("down, by the accelerometer",
                vector_text(inertial->gravity_m_s2.normalized(), 4),
                text_of_sigma(inertial->gravity_sigma_deg));
  else if (inertial)
    numbers.add("down, by the accelerometer", "not found", "", inertial->reason);
  const auto scale = known_scale(inspection);
  const auto& measured = inspection.measured_scale;
  if (!scale && !measured && !inertial) return;
  const std::string reason = measured             ? measured->reason
                             : inertial && !scale ? inertial->scale_reason
                                                  : "";
  const auto sigma = scale_log_sigma(inspection);
  constexpr std::array kSources{
      "from two points", "the result's own unit", "from the accelerometer"};
  numbers.add(
      "scale",
      scale ? fmt::format("1 d = {:.4f} m", *scale) : "unknown",
      sigma   ? fmt::format("{:.2g} %", 100 * *sigma)
      : scale ? "unknown"
              : "",
      !reason.empty() ? reason : kSources[static_cast<std::size_t>(scale_source(inspection))]);
}

void add_residuals(Numbers& numbers, const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  const auto px = [](double value) { return fmt::format("{:.3f} px", value); };
  if (result.transfer_rms_px)
    numbers.add("residual of the solution, RMS",
                px(*result.transfer_rms_px),
                "",
                "inliers of the main plane");
  if (result.reprojection_rms_px)
    numbers.add("reprojection error, RMS", px(*result.reprojection_rms_px), "", "the same inliers");
}

void add_errors(Numbers& numbers, const Inspection& inspection) {
  const auto& e = inspection.evaluation;
  if (!e) return;
  std::string position = "unknown", normal = "unknown";
  if (const auto truth = median_uncertainty(inspection.truth->uncertainties)) {
    position = fmt::format("{:.2g} mm", 1e3 * truth->position_sigma_m);
    normal = text_of_sigma(truth->normal_sigma_deg);
  }
  const std::string about = "uncertainty of the ground truth, " + inspection.truth->source;
  const std::size_t first = numbers.rows.size();
  if (e->ate_m) numbers.add("ATE", fmt::format("{:.2f} mm", 1e3 * *e->ate_m), position, about);
  if (e->pne_deg)
    numbers.add("error of the normal (PNE)",
                fmt::format("{:.3f} deg", *e->pne_deg),
                normal,
                e->pne_bound_deg ? fmt::format("bound {:.3f} deg", *e->pne_bound_deg) : "");
  if (e->pde_m)
    numbers.add(
        "error of the plane's distance (PDE)", fmt::format("{:.2f} mm", 1e3 * *e->pde_m), position);
  if (e->path_error_m)
    numbers.add(
        "error of the path without alignment",
        fmt::format("{:.2f} mm", 1e3 * *e->path_error_m),
        position,
        e->path_error_percent ? fmt::format("{:.2f} % of the path", *e->path_error_percent) : "");
  if (e->scale_ratio)
    numbers.add("scale ratio",
                fmt::format("{:.4f}", *e->scale_ratio),
                "unknown",
                "scale of the alignment over that by the plane's distance");
  if (e->scale_error_percent)
    numbers.add("error of the scale", fmt::format("{:.2f} %", *e->scale_error_percent), "unknown");
  if (e->gravity_error_deg)
    numbers.add("error of up", fmt::format("{:.2f} deg", *e->gravity_error_deg), "unknown");
  if (is_contradiction(*e))
    for (std::size_t i = first; i < numbers.rows.size(); ++i) numbers.rows[i][1].style = "failed";
}

/// Returns the cells of a result with the titles of their columns.
std::vector<std::pair<const char*, HtmlCell>> comparison_cells(const Inspection& inspection) {
  const Row row = make_row(inspection);
  const Initialization& result = *inspection.initialization;
  const Window& window = *inspection.window;
  const std::string word = !result.ok       ? "failed"
                           : result.verdict ? to_string(result.verdict->readiness)
                                            : "";
  const auto number = [](std::string text) { return HtmlCell{std::move(text), "number"}; };
  const auto decimals = [&](const std::optional<double>& value, double factor, int digits) {
    return number(value ? fmt::format("{:.{}f}", factor * *value, digits) : "");
  };
  const bool contradicts = inspection.evaluation && is_contradiction(*inspection.evaluation);
  const auto error = [&](const std::optional<double>& value, double factor, int digits) {
    HtmlCell cell = decimals(value, factor, digits);
    if (contradicts) cell.style += " failed";
    return cell;
  };
  return {
      {"recording", {inspection.recording->name}},
      {"method", {title_of(configuration_of(inspection.settings))}},
      {"verdict", {word, word == "no plane" ? "degenerate" : word}},
      {"frames",
       number(fmt::format("{} to {}", window.start, window.start + window.frame_count() - 1))},
      {"normal, 1 sigma [deg]",
       decimals(result.ok ? normal_sigma_deg(inspection) : std::nullopt, 1, 3)},
      {"inliers", number(fmt::format("{}/{}", row.inliers.value_or(0), row.tracks.value_or(0)))},
      {"reprojection [px]", decimals(result.reprojection_rms_px, 1, 3)},
      {"ATE [mm]", decimals(row.ate_m, 1e3, 2)},
      {"PNE [deg]", error(row.pne_deg, 1, 3)},
      {"PDE [mm]", error(row.pde_m, 1e3, 2)},
      {"path error [%]", error(row.path_error_percent, 1, 2)},
      {"scale ratio", error(row.scale_ratio, 1, 4)},
      {"scale error [%]", decimals(row.scale_error_percent, 1, 2)},
      {"time [ms]", decimals(row.total_ms, 1, 0)},
      {"reason of the failure", {result.ok ? "" : result.reason}}};
}

std::string shell_word(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,+:=@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Returns the options that define the user's own methods, each once.
std::string method_options(const Settings& settings, const std::vector<Configuration>& compared) {
  std::vector<const Method*> methods{&settings.options.method.row()};
  for (const Configuration& one : compared) methods.push_back(&one.method.row());
  std::set<std::string> options;
  bool resampled = false;
  for (const Method* method : methods) {
    if (!method->command.empty())
      options.insert(" --method-command " + shell_word(method->command));
    if (!method->result.empty()) options.insert(" --result " + shell_word(method->result));
    resampled = resampled || (method->resampled && !method->command.empty());
  }
  std::string text;
  for (const std::string& option : options) text += option;
  return text + (resampled ? " --method-resample" : "");
}

std::string html_class(const std::string& style) {
  return style.empty() ? "" : fmt::format(" class=\"{}\"", style);
}

std::string html_row(const std::vector<HtmlCell>& cells, const std::string& style) {
  std::string row = fmt::format("<tr{}>", html_class(style));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const char* element = i == 0 ? "th" : "td";
    row += fmt::format(
        "<{0}{1}>{2}</{0}>", element, html_class(cells[i].style), html_text(cells[i].text));
  }
  return row + "</tr>\n";
}

}  // namespace

std::string html_text(const std::string& text) {
  // Serializing replaces invalid UTF-8.
  const auto valid = nlohmann::json::parse(json_text(text, -1)).get<std::string>();
  constexpr std::pair<char, const char*> kEscapes[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  std::string made;
  for (const char c : valid) {
    const auto* escape = std::ranges::find(kEscapes, c, &std::pair<char, const char*>::first);
    made += escape != std::end(kEscapes) ? std::string(escape->second) : std::string(1, c);
  }
  return made;
}

std::string data_uri(std::string_view type, std::string_view bytes) {
  return fmt::format("data:{};base64,{}", type, to_base64(bytes));
}

std::string script_json(const nlohmann::ordered_json& json) {
  std::string made;
  // "</script>" and "<!--" would end or change the element.
  for (const char c : json_text(json, -1)) made += c == '<' ? "\\u003c" : std::string(1, c);
  return made;
}

std::string html_table(const std::vector<std::string>& header,
                       std::vector<std::vector<HtmlCell>> rows,
                       const std::vector<std::string>& row_styles) {
  std::vector<bool> used(header.size(), false);
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) used[i] = used[i] || !row[i].text.empty();
  std::string head;
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (!used[i]) continue;
    const bool number = !rows.empty() && i < rows[0].size() && rows[0][i].style == "number";
    head += fmt::format("<th{}>{}</th>", number ? " class=\"number\"" : "", html_text(header[i]));
  }
  std::string body;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::vector<HtmlCell> cells;
    for (std::size_t i = 0; i < rows[r].size(); ++i)
      if (used[i]) cells.push_back(std::move(rows[r][i]));
    body += html_row(cells, r < row_styles.size() ? row_styles[r] : "");
  }
  return fmt::format(
      "<div class=\"wide\"><table><thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
      head,
      body);
}

std::string numbers_table(const Inspection& inspection) {
  if (!inspection.initialization->ok) return "";
  Numbers numbers;
  add_planes(numbers, inspection);
  add_poses(numbers, inspection);
  add_gravity_and_scale(numbers, inspection);
  add_sensor_numbers(numbers, inspection);
  add_residuals(numbers, inspection);
  add_errors(numbers, inspection);
  return html_table({"quantity", "value", "uncertainty (1 sigma)", "remark"}, numbers.rows);
}

std::string findings_table(std::span<const Finding> findings) {
  if (findings.empty()) return "";
  NumberRows rows;
  for (const Finding& finding : findings) {
    const std::string level = to_string(finding.level);
    const std::string style = level == "no plane" ? "degenerate" : level == "note" ? "" : level;
    rows.push_back({{finding.key},
                    {finding.ignored ? "ignored" : level, style},
                    {finding.sentence},
                    {finding.advice},
                    {finding.command}});
  }
  return "<h3>Findings</h3>\n" +
         html_table({"key", "level", "finding", "advice", "command in a script"}, std::move(rows));
}

std::string settings_table_html(const Inspection& inspection) {
  const Settings used = settings_used(inspection), usual;
  NumberRows rows;
  std::vector<std::string> styles;
  for (const Setting& setting : settings_table()) {
    if (!is_read(setting, used.options.method)) continue;
    const std::string given = setting_text(inspection.settings, setting.key);
    const std::string value = setting_text(used, setting.key);
    const bool changed = given != setting_text(usual, setting.key);
    const std::string idle = why_idle(setting, inspection.settings, inspection.recording.get());
    if (!changed && !idle.empty()) continue;
    rows.push_back({{setting.title},
                    {setting.unit.empty() || value == "default" || value == "none"
                         ? value
                         : value + " " + setting.unit},
                    {changed ? "changed" : ""},
                    {idle.empty() ? setting.help : "not used: " + idle}});
    styles.emplace_back(changed ? "changed" : "");
  }
  return html_table({"setting", "value", "from the default", "meaning"}, std::move(rows), styles);
}

std::string comparison_table(const std::vector<std::shared_ptr<const Inspection>>& inspections,
                             bool recordings) {
  NumberRows rows;
  std::vector<std::string> header;
  for (const auto& inspection : inspections) {
    header.clear();
    std::vector<HtmlCell>& row = rows.emplace_back();
    for (auto& [title, cell] : comparison_cells(*inspection)) {
      if (!recordings && std::string_view(title) == "recording") continue;
      header.emplace_back(title);
      row.push_back(std::move(cell));
    }
  }
  return html_table(header, std::move(rows));
}

std::vector<std::string> opening_options(const Recording& recording,
                                         const std::optional<fs::path>& tracks,
                                         const TopicChoices& topics) {
  std::vector<std::string> words;
  if (tracks) words = {"--tracks", tracks->string()};
  for (const auto& [role, name] : topics)
    words.insert(words.end(), {"--topic", fmt::format("{}={}", to_string(role), name)});
  if (recording.camera_source == CameraSource::self_calibrated)
    words.insert(words.end(), {"--calibrate", "auto"});
  return words;
}

std::string report_command(const fs::path& recording,
                           const std::vector<std::string>& opening,
                           const Settings& settings,
                           const std::vector<Configuration>& compared) {
  std::string line = "gpo-inspector report " + shell_word(recording.string());
  for (const std::string& word : opening) line += " " + shell_word(word);
  const Settings usual;
  for (const Setting& setting : settings_table()) {
    const std::string value = setting_text(settings, setting.key);
    if (value == setting_text(usual, setting.key)) continue;
    std::string option = setting.key;
    std::ranges::replace(option, '_', '-');
    if (setting.kind == SettingKind::on_off)
      line += (value == "off" ? " --no-" : " --") + option;
    else
      line += fmt::format(" --{} {}", option, shell_word(value));
  }
  line += method_options(settings, compared);
  std::vector<std::string> methods;
  for (const Configuration& one : compared) methods.push_back(key_of(one));
  if (!methods.empty())
    line += " --methods " + shell_word(fmt::format("{}", fmt::join(methods, ",")));
  return line + " --output report.html";
}

}  // namespace gpo
