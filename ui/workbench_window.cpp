// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench_window.h"

#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/files/output_file.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>
#include <thread>

#include <GL/glew.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

/// Dear ImGui knows the sizes of tables and popups only after it has drawn them once.
constexpr int kFramesToSettle = 3;
const cv::Size kDefaultSize(1280, 720);

Rectangle rectangle_of(cv::Size size) {
  return {0, 0, static_cast<float>(size.width), static_cast<float>(size.height)};
}

void clear_framebuffer(std::uint32_t rgb) {
  glDisable(GL_SCISSOR_TEST);
  const Eigen::Vector3f color = Vector3d(red(rgb), green(rgb), blue(rgb)).cast<float>();
  glClearColor(color.x(), color.y(), color.z(), 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

void draw_views(const PanelContext& ui, const WindowLayout& layout) {
  if (layout.views.empty()) return;
  if (!ui.state.document.recording) return empty_panel(ui, layout.views);
  if (ui.state.view.panes.compare) return compare_panel(ui, layout.views);
  if (!layout.image.empty()) image_panel(ui, layout.image);
  if (layout.side.empty()) return;
  side_tabs(ui, layout.side_tabs);
  draw_pane(ui, layout.side, "side", ui.state.view.panes.side);
}

void use_theme(Theme theme, Gui& gui, Views& views) {
  if (gui.theme() == theme) return;
  gui.set_theme(theme);
  views.window = WindowImage();
}

/// Only the views and the findings below the verdict have something to hover over.
void forget_hover(const PanelContext& ui, const WindowLayout& layout) {
  const ImVec2 at = ImGui::GetIO().MousePos;
  const auto is_in = [&](const Rectangle& part) {
    return at.x >= part.x && at.x < part.right() && at.y >= part.y && at.y < part.bottom();
  };
  if (!is_in(layout.views) && !is_in(layout.verdict) && ui.state.hover != Hover{})
    push(ui.commands, HoverOver{});
}

void draw_overlays(const PanelContext& ui, const Rectangle& window) {
  const ViewState& view = ui.state.view;
  if (view.tour > 0) tour_card(ui, window);
  if (view.show_help) help_overlay(ui, window);
  if (view.palette) palette_overlay(ui, window);
  if (view.browse) browser_overlay(ui, window);
  if (view.sources) sources_overlay(ui, window);
  if (!view.palette) ui.views.palette = {};
  if (!view.browse) ui.views.browser.open = false;
  if (!view.sources) ui.views.sources = {};
}

void draw_panels(PanelContext ui, cv::Size size) {
  const Rectangle window = rectangle_of(size);
  const ViewState& view = ui.state.view;
  const WindowLayout layout = window_layout({.width = window.width,
                                             .height = window.height,
                                             .scale = ui.scale,
                                             .division = view.division,
                                             .drawer_open = view.panes.drawer != nullptr,
                                             .scan = view.toggles.scan,
                                             .beside_open = view.panes.beside != nullptr,
                                             .failed = ui.state.live || has_failed(ui),
                                             .verdict_height = ui.views.verdict_height,
                                             .settings_height = ui.views.settings_height});
  menu_bar(ui);
  if (!layout.verdict.empty()) verdict_panel(ui, layout.verdict);
  ui.banner = !layout.banner.empty();
  if (ui.banner) (ui.state.live ? live_banner : failure_banner)(ui, layout.banner);
  if (!layout.settings.empty()) settings_panel(ui, layout.settings);
  if (!layout.results.empty()) results_panel(ui, layout.results);
  draw_views(ui, layout);
  if (!layout.drawer_tabs.empty()) drawer_tabs(ui, layout.drawer_tabs);
  draw_pane(ui, layout.drawer, "drawer", view.panes.drawer);
  draw_pane(ui, layout.beside, "drawer beside", view.panes.beside);
  if (!layout.timeline.empty()) timeline_panel(ui, layout.timeline);
  status_line(ui, layout.status);
  splitters(ui, layout);
  forget_hover(ui, layout);
  draw_overlays(ui, window);
  context_menu(ui);
}

/// Draws one view that fills the framebuffer, between `begin_frame` and `end_frame`.
void draw_alone(const Pane& pane, const PanelContext& ui, cv::Size size) {
  const Rectangle place = rectangle_of(size);
  WorkbenchState state = ui.state;
  if (pane.kind == PaneKind::side) state.view.panes.side = &pane;
  if (pane.kind == PaneKind::drawer) state.view.panes = {.drawer = &pane};
  const PanelContext shown{ui.with(state), ui.views, ui.commands};
  if (pane.kind == PaneKind::side || pane.kind == PaneKind::drawer)
    draw_pane(shown, place, pane.kind == PaneKind::side ? "side" : "drawer", &pane);
  else
    draw_function(pane)(shown, place);
}

const Pane& pane_named(const std::string& name) {
  if (const Pane* pane = find_pane(name)) return *pane;
  throw InputError(fmt::format(
      "screenshot: unknown view '{}', expected one of {}", name, fmt::join(pane_names(), ", ")));
}

/// Returns a view's size in a window; of the image as recorded. Throws InputError if none is open.
cv::Size default_size(const Pane& pane, const PanelInput& input, cv::Size window) {
  if (pane.kind == PaneKind::window) return window;
  if (!input.state.document.recording) throw InputError("no recording is open");
  if (pane.kind == PaneKind::image) return shown_size(*input.state.document.recording);
  const bool below = pane.kind == PaneKind::drawer;
  const Rectangle whole = rectangle_of(window);
  const WindowLayout layout = window_layout(
      {.width = whole.width, .height = whole.height, .scale = input.scale, .drawer_open = below});
  const Rectangle& place = below                         ? layout.drawer
                           : pane.kind == PaneKind::side ? layout.side
                                                         : layout.views;
  return {static_cast<int>(place.width), static_cast<int>(place.height)};
}

bool button(const std::string& title, float scale, bool first) {
  if (first) ImGui::PushStyleColor(ImGuiCol_Button, imgui_color(Role::active));
  const float width = ImGui::CalcTextSize(title.c_str()).x + 48 * scale;
  const bool clicked = ImGui::Button(title.c_str(), {std::max(width, 120 * scale), 32 * scale});
  if (first) ImGui::PopStyleColor();
  return clicked;
}

void write_wrapped(Role role, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(role));
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::PopStyleColor();
}

/// Returns "desk-0029.png", or with a number if that exists.
fs::path free_image_name(const WorkbenchState& state) {
  const std::string stem =
      state.document.recording
          ? fmt::format("{}-{:04}", state.document.recording->name, state.view.frame)
          : "window";
  fs::path name = stem + ".png";
  for (int i = 2; fs::exists(name); ++i) name = fmt::format("{}-{}.png", stem, i);
  return name;
}

}  // namespace

Commands draw_workbench(
    const PanelInput& input, cv::Size size, Gui& gui, Views& views, double delta_seconds) {
  Commands commands;
  PanelContext ui{input, views, commands};
  ui.scale = gui.scale();
  use_theme(input.state.view.theme, gui, views);
  if (gui.provide_glyphs(shown_names(input, views))) views.window = WindowImage();
  gui.begin_frame(size.width, size.height, delta_seconds);
  draw_panels(ui, size);
  gui.end_frame(views.window, color_of(Role::border));
  return commands;
}

cv::Mat draw_view(const std::string& view,
                  std::optional<cv::Size> wanted,
                  const PanelInput& input,
                  cv::Size window_size,
                  const Drawing& drawing) {
  Gui& gui = drawing.gui;
  Commands ignored;
  PanelContext ui{input, drawing.views, ignored};
  ui.scale = gui.scale();
  const Pane& pane = pane_named(view);
  const cv::Size size = wanted.value_or(default_size(pane, ui, window_size));
  const Framebuffer framebuffer(size.width, size.height);
  framebuffer.bind();
  use_theme(input.state.view.theme, gui, drawing.views);
  gui.provide_glyphs(shown_names(input, drawing.views));
  for (int i = 0; i < kFramesToSettle; ++i) {
    if (pane.kind == PaneKind::window) {
      draw_workbench(input, size, gui, drawing.views);
    } else {
      clear_framebuffer(color_of(Role::background));
      gui.begin_frame(size.width, size.height);
      draw_alone(pane, ui, size);
      gui.end_frame();
    }
  }
  return read_bound_framebuffer(size.width, size.height);
}

cv::Mat snapshot_pane(const std::string& view,
                      const std::shared_ptr<const Inspection>& inspection,
                      int frame,
                      std::optional<cv::Size> size,
                      const std::shared_ptr<const Extrapolation>& after) {
  WorkbenchState state;
  state.document.settings = inspection->settings;
  apply_recording(state, inspection->recording);
  state.results.inspection = inspection;
  state.results.after = after;
  if (after) state.results.extended = after->extended;
  state.messages.text.clear();
  const Pane& pane = pane_named(view);
  if (pane.kind != PaneKind::window)
    state.document.compared = {configuration_of(state.document.settings)};
  if (pane.needs.study) state.results.study = study_normals(*inspection);
  apply(state, GoToFrame{frame});
  const cv::Size window = size.value_or(kDefaultSize);
  const OffscreenContext context(window.width, window.height);
  Gui gui;
  Views views;
  return draw_view(view, size, {.state = state, .timings = false}, kDefaultSize, {gui, views});
}

cv::Mat snapshot_live(const std::string& view,
                      const LiveView& live,
                      const Settings& settings,
                      std::optional<cv::Size> size) {
  WorkbenchState state;
  state.document.settings = settings;
  show_live(state, live);
  const cv::Size window = size.value_or(kDefaultSize);
  const OffscreenContext context(window.width, window.height);
  Gui gui;
  Views views;
  return draw_view(view, size, {.state = state, .timings = false}, kDefaultSize, {gui, views});
}

std::optional<bool> ask_for_commands(Gui& gui,
                                     cv::Size size,
                                     const std::vector<std::string>& commands) {
  gui.provide_glyphs(std::vector<std::string_view>(commands.begin(), commands.end()));
  const float s = gui.scale();
  const auto window_width = static_cast<float>(size.width);
  std::optional<bool> answer;
  clear_framebuffer(color_of(Role::background));
  gui.begin_frame(size.width, size.height);
  ImGui::SetNextWindowPos({window_width / 2, static_cast<float>(size.height) / 2}, 0, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({std::min(640 * s, window_width - 32 * s), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {24 * s, 20 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::raised));
  ImGui::Begin("question",
               nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PushFont(font(Font::heading));
  write_wrapped(Role::text, "This session wants to start commands");
  ImGui::PopFont();
  ImGui::Dummy({1, 6 * s});
  for (const std::string& command : commands) write_wrapped(Role::accent, command);
  ImGui::Dummy({1, 6 * s});
  write_wrapped(Role::text_dim,
                "They run with your permissions. Start them only if you trust the author "
                "of the session. If they are not started, their methods fail.");
  ImGui::Dummy({1, 10 * s});
  if (button("Do not start them", s, true)) answer = false;
  ImGui::SameLine(0, 12 * s);
  if (button("Start them", s, false)) answer = true;
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) answer = false;
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
  gui.end_frame();
  return answer;
}

WorkbenchHost::WorkbenchHost(Gui& gui,
                             Worker::Open open,
                             fs::path example,
                             const std::function<void()>& changed)
    : live(changed),
      gui_(gui),
      fetcher_(changed),
      lister_(changed),
      models_(changed),
      exports_(changed),
      survey_(changed),
      scan_(changed),
      recordings_(changed),
      worker_(std::move(open), changed) {
  link.example = std::move(example);
  link.reader = std::make_unique<FileReader>(changed);
  link.extrapolator = std::make_unique<Extrapolator>(changed);
}

PanelInput WorkbenchHost::input() const {
  PanelInput input{state, link.reading.busy ? link.reading : link.worker, link.survey, link.scan};
  if (movie_) input.writing = {true, "movie", movie_->done(), movie_->of()};
  if (!movie_ && wants_report(state)) input.writing = report_status(state);
  for (const JobStatus& saving : {recordings_.status(), exports_.status()})
    if (saving.busy && !input.writing.busy) input.writing = saving;
  input.timings = timings;
  input.opening = link.loading;
  return input;
}

void WorkbenchHost::synchronize() {
  gui_.set_zoom(state.view.text_zoom);
  if ((movie_ || state.requests.movie) && std::exchange(state.requests.cancel, false)) {
    movie_.reset();
    apart_.reset();
    state.requests.movie.reset();
    say(state, "Movie canceled. The incomplete file was deleted");
  }
  gpo::synchronize(state, exports_);
  gpo::synchronize(state, recordings_);
  if (!live.synchronize(state, link, worker_))
    gpo::synchronize(state, link, worker_, survey_, scan_);
  if (const auto copied = std::exchange(state.requests.copied, {}))
    ImGui::SetClipboardText(copied->c_str());
  if (writing()) write_movie();
  for (const Screenshot& screenshot : take_screenshots(state, link)) save(screenshot);
}

void WorkbenchHost::settle() {
  do {
    check_stop();
    synchronize();
    if (link.busy() || exports_.busy() || recordings_.busy())
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (busy());
  synchronize();
}

Commands WorkbenchHost::draw(double delta_seconds) {
  PanelInput shown = input();
  shown.hurries = state.live.has_value();
  shown.fetcher = &fetcher_;
  shown.lister = &lister_;
  if (!reads_models_at_once) shown.models = &models_;
  if (const JobStatus reading = models_.status(); reading.busy) shown.worker = reading;
  shown.example = link.example;
  Commands commands = draw_workbench(shown, size, gui_, views_, delta_seconds);
  const std::string& error = views_.model.value.error;
  if (error != model_error_) {
    retract_error(state, "model: " + std::exchange(model_error_, error));
    if (!error.empty()) say(state, "model: " + error, Severity::error);
  }
  return commands;
}

cv::Mat WorkbenchHost::image(const std::string& view, std::optional<cv::Size> wanted) {
  return draw_view(view, wanted, input(), size, {gui_, views_});
}

cv::Mat WorkbenchHost::draw_apart(const WorkbenchState& shown,
                                  const std::string& view,
                                  cv::Size pixels) {
  const struct Back {
    const Gui& gui;
    ~Back() { gui.make_current(); }
  } back{gui_};
  if (!apart_) apart_.reset(new Apart{Gui(gui_.scale()), Views()});
  apart_->gui.make_current();
  return draw_view(view, pixels, input().with(shown), size, {apart_->gui, apart_->views});
}

/// Starts the movie if everything that it shows is computed, or continues it.
void WorkbenchHost::write_movie() {
  try {
    if (!movie_) movie_.emplace(*std::exchange(state.requests.movie, {}), state);
    movie_->step([this](const WorkbenchState& shown, const std::string& view, cv::Size pixels) {
      return draw_apart(shown, view, pixels);
    });
    if (!movie_->finished()) return;
    say(state, "saved " + movie_->file().string());
  } catch (const InputError& error) {
    state.requests.movie.reset();
    say(state, error.what(), Severity::error);
  }
  movie_.reset();
  apart_.reset();
}

void WorkbenchHost::save(const Screenshot& wanted) {
  const auto file = wanted.file.empty() ? fs::absolute(free_image_name(state)) : wanted.file;
  try {
    check_writable(file);
    if (wanted.view == kReportView)
      write_window_report(state, file, [this](const auto& shown, const auto& view, cv::Size px) {
        return draw_apart(shown, view, px);
      });
    else
      write_image(file, image(wanted.view, wanted.size));
    say(state, "saved " + file.string());
  } catch (const InputError& error) {
    say(state, error.what(), Severity::error);
  }
  if (!movie_) apart_.reset();
}

}  // namespace gpo
