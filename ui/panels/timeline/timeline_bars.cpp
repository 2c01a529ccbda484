// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/timeline/timeline_bars.h"

#include "engine/inspection/studies/studies.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kLeast_deg = 0.01, kMost_deg = 10;  // range of a scan's columns

struct MotionLine {
  const char* name;
  const char* unit;
  Role color;
  double FrameMotion::*value;
};
constexpr MotionLine kMotionLines[] = {
    {"parallax", " px", Role::text, &FrameMotion::parallax_px},
    {"angular rate", "\u00b0/s", Role::rotation, &FrameMotion::rotation_rate_deg_s}};

double largest(const Inspection& inspection, const MotionLine& line) {
  double most = 0;
  for (const FrameMotion& motion : inspection.motion)
    if (std::isfinite(motion.*line.value)) most = std::max(most, motion.*line.value);
  return most;
}

/// Returns the color of a frame's inliers. A failed window is gray: green would look like success.
ImU32 inlier_color(const Inspection& inspection, std::span<const Verdict> growth, int frame) {
  const bool failed = !inspection.initialization || !inspection.initialization->ok;
  const bool judged = !failed && frame >= 1 && frame <= std::ssize(growth);
  return imgui_color(judged ? style_of(growth[frame - 1].readiness).rgb : color_of(Role::text_dim),
                     0.75);
}

/// Text and signs from left to right; only their width is computed unless `drawn`.
struct LegendLine {
  const BarArea& area;
  float left;
  bool drawn = true;
  float middle = area.top + font(Font::small)->FontSize / 2;

  void write(const std::string& text, Role role) {
    if (drawn) write_text(area.list, Font::small, {left, area.top}, text, color_of(role));
    left += static_cast<float>(text_width(Font::small, text));
  }
  /// Draws the sign `offset` right of the last text, and continues `advance` right of it.
  void sign(Sign sign, std::uint32_t rgb, float offset, float advance) {
    if (drawn) draw_sign(area.list, sign, {left + offset * area.scale, middle}, rgb);
    skip(advance);
  }
  void line(Role role) {
    const float y = std::round(middle), s = area.scale;
    if (drawn) area.list.AddLine({left, y}, {left + 14 * s, y}, imgui_color(role), 1.4F * s);
    skip(18);
  }
  void skip(float width) { left += width * area.scale; }
};

/// Draws a text right of the strip, where no column is.
void draw_scan_label(ImDrawList& list,
                     const StartScan& scan,
                     const Rectangle& gutter,
                     float scale) {
  const bool truth = shown_error(scan) == &ScannedStart::pne_deg;
  const std::string what = scan.finished()
                               ? truth ? "plane normal error" : "normal uncertainty"
                               : fmt::format("scanned {} of {}", scan.starts.size(), scan.of);
  const Vector2d at(gutter.x, gutter.y + (gutter.height - font(Font::small)->FontSize) / 2);
  const std::string text = fitting_text(Font::small,
                                        {what, fmt::format("{}/{}", scan.starts.size(), scan.of)},
                                        std::max(1.0F, gutter.width - 4 * scale));
  write_text(list, Font::small, at, text, color_of(Role::text_dim));
}

/// Returns whether a scanned start has its column in the shown span.
bool shows_a_start(const StartScan& scan, const TimeAxis& axis) {
  return std::ranges::any_of(scan.starts, [&](const ScannedStart& start) {
    return axis.slot_begin(start.start + scan.step) > axis.left &&
           axis.slot_begin(start.start) < axis.right;
  });
}

/// How many words the legend leaves out, so that narrow windows and many planes show all of it.
enum class Brevity { full, compact, shortest };

void write_legend(LegendLine& legend, const Inspection& inspection, Brevity brevity) {
  const bool compact = brevity != Brevity::full;
  const bool shortest = brevity == Brevity::shortest;
  if (inspection.initialization && !inspection.initialization->ok) {
    legend.sign(Sign::cross, color_of(Role::bad), 6, 16);
    return legend.write("not initialized", Role::text);
  }
  if (!shortest) legend.write("window up to here:", Role::text_dim);
  for (const Readiness readiness : {Readiness::ready, Readiness::weak, Readiness::degenerate}) {
    const SignStyle look = style_of(readiness);
    legend.sign(look.sign, look.rgb, 14, 23);
    legend.write(to_string(readiness), Role::text);
  }
  legend.skip(16);
  legend.write("height: tracks", Role::text_dim);
  bool first = true;
  for (const int k : other_planes(*inspection.window)) {
    legend.sign(Sign::disc, plane_color(k), 12, 20);
    const std::string number = std::to_string(k + 1);
    legend.write(first || !shortest ? plane_title(inspection, k) : number, Role::text_dim);
    first = false;
  }
  legend.skip(8);
  legend.write("gray: outliers", Role::text_dim);
  if (inspection.metric_scale_from) {
    legend.skip(16);
    legend.write("m:", Role::gravity);
    legend.write(compact ? " metric scale" : " metric scale available from here", Role::text_dim);
  }
  for (const MotionLine& line : kMotionLines) {
    if (inspection.motion.empty()) return;
    legend.skip(16);
    legend.line(line.color);
    const std::string name = line.name + std::string(compact ? "" : " up to");
    const double most = largest(inspection, line);
    legend.write(fmt::format("{} {:.0f}{}", name, most, line.unit), Role::text_dim);
  }
}

}  // namespace

int TimeAxis::frame_at(float x) const {
  // Clamped as a floating-point number: Dear ImGui's position of no pointer overflows an integer.
  const double frame = span.first + std::floor((x - left) / slot_width());
  return static_cast<int>(std::clamp(frame, 0.0, frames - 1.0));
}

void draw_tracks(const BarArea& area, const Inspection& inspection) {
  const Window& window = *inspection.window;
  const TimeAxis& axis = area.axis;
  const std::vector<Verdict>& growth = shown_growth(inspection);
  const float a_track =
      (area.bottom - area.top) / static_cast<float>(std::max(1, window.track_count()));
  for (int i = 0; i < window.frame_count() && window.start + i < axis.frames; ++i) {
    const auto& points = window.points_px[i];
    const auto seen = (points.row(0).array() == points.row(0).array()).count();
    const float left = axis.slot_begin(window.start + i);
    const float right = std::max(left + 1, axis.slot_begin(window.start + i + 1) - 1);
    float y = area.bottom;
    const auto stack = [&](std::ptrdiff_t tracks, ImU32 color) {
      const float upper = y - a_track * static_cast<float>(tracks);
      area.list.AddRectFilled({left, upper}, {right, y}, color);
      y = upper;
    };
    std::ptrdiff_t rest = seen - window.inlier_count(i);
    stack(window.inlier_count(i), inlier_color(inspection, growth, i));
    for (const int k : other_planes(window)) {
      const auto tracks = std::ranges::count(window.planes[k].inlier[i], true);
      stack(tracks, imgui_color(plane_color(k), 0.6));
      rest -= tracks;
    }
    stack(rest, imgui_color(Role::text_dim, 0.4));  // red would look like a verdict
  }
}

void draw_verdict_signs(const BarArea& area, const Inspection& inspection) {
  const float s = area.scale;
  for (const VerdictRun& run : verdict_runs(shown_growth(inspection))) {
    const int start = inspection.window->start;
    const float left = area.axis.slot_begin(start + run.first);
    if (area.axis.slot_begin(start + run.last + 1) - left < 16 * s) continue;
    const ImVec2 at(left + 9 * s, area.bottom - 9 * s);
    area.list.AddCircleFilled(at, 8 * s, imgui_color(Role::background, 0.8), 20);
    const SignStyle look = style_of(run.readiness);
    draw_sign(area.list, look.sign, at, look.rgb);
  }
}

void draw_motion(const BarArea& area, const Inspection& inspection) {
  const int start = inspection.window->start;
  for (const MotionLine& line : kMotionLines) {
    const double most = largest(inspection, line);
    if (most <= 0) continue;
    std::vector<ImVec2> points;
    for (int i = 0; i < std::ssize(inspection.motion); ++i) {
      const double value = inspection.motion[i].*line.value;
      if (std::isfinite(value))
        points.emplace_back(
            area.axis.slot_middle(start + i),
            area.bottom - static_cast<float>(value / most) * (area.bottom - area.top));
    }
    const auto count = static_cast<int>(points.size());
    area.list.AddPolyline(points.data(), count, imgui_color(Role::background, 0.7), 0, 3);
    area.list.AddPolyline(points.data(), count, imgui_color(line.color), 0, 1.4F);
  }
}

void draw_scale_mark(const BarArea& area, const Inspection& inspection) {
  if (!inspection.metric_scale_from) return;
  const int frame = inspection.window->start + *inspection.metric_scale_from;
  const float x = std::round(area.axis.slot_begin(frame + 1));
  const float dash = std::round(3 * area.scale);
  const float width = std::max(1.0F, std::round(1.5F * area.scale));
  for (float y = area.top; y < area.bottom; y += 2 * dash)
    area.list.AddRectFilled(
        {x, y}, {x + width, std::min(area.bottom, y + dash)}, imgui_color(Role::gravity));
  const Vector2d at(x + 3 * area.scale, std::round(area.top));
  write_text(area.list, Font::small, at, "m", color_of(Role::gravity));
}

std::vector<TruthJump> shown_jumps(const WorkbenchState& state, const Inspection* inspection) {
  const Recording* recording = state.document.recording.get();
  if (recording != nullptr && recording->truth) return recording->truth->jumps;
  return inspection != nullptr && inspection->window ? truth_jumps(*inspection)
                                                     : std::vector<TruthJump>();
}

int frame_after(const TruthJump& jump, const Recording& recording) {
  const auto& times = recording.timestamps_ns;
  const auto after = std::ranges::lower_bound(times, jump.last_ns) - times.begin();
  return static_cast<int>(std::min(after, std::ssize(times) - 1));
}

void draw_jumps(const BarArea& area, const Recording& recording, std::span<const TruthJump> jumps) {
  const float s = area.scale;
  for (const TruthJump& jump : jumps) {
    const float x = std::round(area.axis.slot_begin(frame_after(jump, recording)));
    area.list.AddLine(
        {x, area.top}, {x, area.bottom}, imgui_color(Role::bad), std::round(1.5F * s));
    draw_sign(area.list, Sign::cross, {x, area.top + 6 * s}, color_of(Role::bad));
  }
}

std::vector<RulerTick> ruler_ticks(const TimeAxis& axis,
                                   std::span<const std::int64_t> timestamps_ns,
                                   double apart_px) {
  const int first = axis.span.first;
  const int count = axis.span.count > 0 ? axis.span.count : axis.frames;
  const int last = std::min<int>(first + count, static_cast<int>(timestamps_ns.size())) - 1;
  if (last <= first || axis.right <= axis.left) return {};
  const auto seconds = [&](int frame) {
    return static_cast<double>(timestamps_ns[frame] - timestamps_ns.front()) * 1e-9;
  };
  const double pixels = axis.slot_middle(last) - axis.slot_middle(first);
  const double least = (seconds(last) - seconds(first)) * apart_px / std::max(pixels, 1.0);
  if (!(least > 0)) return {};
  const double decade = std::pow(10, std::floor(std::log10(least)));
  const double step = decade * (least <= decade       ? 1
                                : least <= 2 * decade ? 2
                                : least <= 5 * decade ? 5
                                                      : 10);
  const int decimals = std::clamp(-static_cast<int>(std::floor(std::log10(step) + 1e-9)), 0, 6);
  constexpr double kRounding = 1e-4;  // tolerance [s]
  std::vector<RulerTick> ticks;
  for (auto k = std::llround(std::ceil((seconds(first) - kRounding) / step));
       static_cast<double>(k) * step <= seconds(last) + kRounding;
       ++k) {
    const double at = static_cast<double>(k) * step;
    const auto ns = timestamps_ns.front() + std::llround((at - kRounding) * 1e9);
    const auto found = std::ranges::lower_bound(timestamps_ns, ns) - timestamps_ns.begin();
    const int frame = std::min(static_cast<int>(found), last);
    // Several times in a gap have the same next frame, the last one is closest to it.
    if (!ticks.empty() && ticks.back().frame == frame) ticks.pop_back();
    const bool round = std::abs(seconds(frame) - at) < 0.05 * std::pow(10, -decimals);
    ticks.push_back(
        {frame,
         fmt::format("{:.{}f} s \u00b7 {}", seconds(frame), decimals + (round ? 0 : 1), frame)});
  }
  return ticks;
}

void draw_ruler(const BarArea& area, std::span<const std::int64_t> timestamps_ns) {
  constexpr double kApart = 110;  // room for a text at scale 1 [px]
  constexpr float kGap = 6;       // between texts at scale 1 [px]
  const float s = area.scale;
  double end = area.axis.left;
  for (const RulerTick& tick : ruler_ticks(area.axis, timestamps_ns, kApart * s)) {
    const float x = std::round(area.axis.slot_middle(tick.frame));
    if (x < end - kGap * s) continue;  // behind a text: times may have long gaps
    area.list.AddRectFilled({x, area.top},
                            {x + std::max(1.0F, std::round(s)), area.bottom},
                            imgui_color(Role::text_dim));
    const double width = text_width(Font::small, tick.text);
    if (x + 3 * s < end || x + 3 * s + width > area.axis.right) continue;
    write_text(area.list, Font::small, {x + 3 * s, area.top}, tick.text, color_of(Role::text_dim));
    end = x + (3 + kGap) * s + width;
  }
}

void draw_bookmarks(const BarArea& area, std::span<const Bookmark> bookmarks) {
  const float s = area.scale, top = area.top;
  for (const Bookmark& bookmark : bookmarks) {
    const float x = std::round(area.axis.slot_middle(bookmark.frame));
    const ImU32 color = imgui_color(Role::text);  // no verdict's
    area.list.AddLine({x, top - 6 * s}, {x, top + 10 * s}, color, std::round(1.5F * s));
    area.list.AddRectFilled({x, top - 6 * s}, {x + 8 * s, top}, color);
  }
}

void draw_verdict_legend(const BarArea& area, const Inspection& shown, float left, float right) {
  using enum Brevity;
  const auto fits = [&](Brevity brevity) {
    LegendLine measured{.area = area, .left = left, .drawn = false};
    write_legend(measured, shown, brevity);
    return measured.left <= right;
  };
  LegendLine legend{.area = area, .left = left};
  write_legend(legend, shown, fits(full) ? full : fits(compact) ? compact : shortest);
}

const ScannedStart* start_at(const StartScan& scan, int frame) {
  const int start = frame / scan.step * scan.step;
  const auto found = std::ranges::lower_bound(scan.starts, start, {}, &ScannedStart::start);
  return found != scan.starts.end() && found->start == start ? &*found : nullptr;
}

std::optional<double> ScannedStart::*shown_error(const StartScan& scan) {
  const bool truth = std::ranges::any_of(
      scan.starts, [](const ScannedStart& start) { return start.pne_deg.has_value(); });
  return truth ? &ScannedStart::pne_deg : &ScannedStart::sigma_deg;
}

float column_height(const ScannedStart& start, std::optional<double> ScannedStart::*error) {
  if (!start.ok || !(start.*error)) return 1;
  const double share =
      std::log10(*(start.*error) / kLeast_deg) / std::log10(kMost_deg / kLeast_deg);
  return static_cast<float>(std::clamp(share, 0.0, 1.0));
}

std::string scan_text(const ScannedStart& start) {
  std::string text = fmt::format(
      "start {}: {}", start.start, start.ok ? to_string(start.readiness) : "not initialized");
  if (start.sigma_deg) text += ", normal " + sigma_text(*start.sigma_deg);
  if (start.pne_deg) text += ", PNE " + angle_text(*start.pne_deg);
  if (!start.reason.empty()) text += "\n" + start.reason;
  return text;
}

void scan_strip(const PanelContext& ui,
                const TimeAxis& axis,
                const Rectangle& place,
                float gutter_px) {
  const WorkbenchState& state = ui.state;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 from{place.x, place.y}, to{place.right(), place.bottom()};
  list.AddRectFilled(from, to, imgui_color(Role::raised));
  if (!state.results.scan) return;
  const StartScan& scan = *state.results.scan;
  const bool clicked = hit_area_at("scan", place);
  list.PushClipRect(from, to, true);
  const auto error = shown_error(scan);
  for (const ScannedStart& start : scan.starts) {
    const float left = axis.slot_begin(start.start);
    const float right = std::max(left + 1, axis.slot_begin(start.start + scan.step) - 1);
    const float height = std::max(2.0F, column_height(start, error) * (place.height - 2));
    const ImU32 color = start.ok ? imgui_color(style_of(start.readiness).rgb, 0.85)
                                 : imgui_color(Role::text_dim, 0.4);
    list.AddRectFilled({left, std::round(place.bottom() - height)}, {right, place.bottom()}, color);
  }
  const float x = std::round(axis.slot_middle(state.document.settings.start));
  list.AddLine({x, place.y}, {x, place.bottom()}, imgui_color(Role::accent), 2 * ui.scale);
  if (!shows_a_start(scan, axis))
    write_text(list,
               Font::small,
               {place.x + 6 * ui.scale, place.y + 2 * ui.scale},
               fitting_text(Font::small,
                            {"no scanned start in this span: double-click the time line to show "
                             "all frames",
                             "double-click the time line"},
                            place.width - 8 * ui.scale),
               color_of(Role::text_dim));
  list.PopClipRect();
  draw_scan_label(
      list, scan, {place.right() + 8 * ui.scale, place.y, gutter_px, place.height}, ui.scale);
  const float mouse = ImGui::GetIO().MousePos.x;
  const ScannedStart* under = start_at(scan, axis.frame_at(mouse));
  if (ImGui::IsItemHovered()) {
    const float share = mouse / ImGui::GetIO().DisplaySize.x;
    ImGui::SetNextWindowPos({mouse, place.y - 8 * ui.scale}, 0, {share, 1});
    const std::string range =
        fmt::format("\nHeight: {:g}\u00b0 to {:g}\u00b0, logarithmic", kLeast_deg, kMost_deg);
    tooltip((under ? scan_text(*under) + "\nClick to start the window here" : "not scanned yet") +
            range);
  }
  if (!clicked || under == nullptr) return;
  Settings settings = state.document.settings;
  settings.start = under->start;
  push(ui.commands, ChangeSettings{settings});
  push(ui.commands, GoToFrame{under->start + settings.frames - 1});
}

}  // namespace gpo
