// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/tables.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;

/// Off, as it is, enlarged 10 and 100 times, off.
void enlarge_uncertainty(ViewToggles& view) {
  view.uncertainty = view.uncertainty == 0     ? 1
                     : view.uncertainty >= 100 ? 0
                                               : 10 * view.uncertainty;
}

std::string uncertainty_text(const ViewToggles& view) {
  if (view.uncertainty > 1) return "\u00d7" + std::to_string(view.uncertainty);
  return view.uncertainty == 1 ? "on" : "off";
}

Action view_toggle(std::string name,
                   std::string title,
                   std::vector<Shortcut> shortcuts,
                   std::string tooltip,
                   bool ViewToggles::*member) {
  return toggle(std::move(name),
                std::move(title),
                std::move(shortcuts),
                std::move(tooltip),
                [member](State& s) -> bool& { return s.view.*member; });
}

void add_toggles(std::vector<Action>& table) {
  table.push_back(view_toggle(
      "tracks", "Tracks", {}, "Inliers as circles, outliers as crosses", &ViewToggles::tracks));
  table.push_back(view_toggle("tails",
                              "Tails",
                              {letter('T')},
                              "Where each track came from in the last frames",
                              &ViewToggles::tails));
  table.push_back(view_toggle("residuals",
                              "Residual vectors",
                              {letter('E')},
                              "From where a track is seen to where the result puts it, enlarged",
                              &ViewToggles::residuals));
  table.push_back(view_toggle("cube",
                              "Cube",
                              {letter('B')},
                              "A cube that stands on the estimated plane",
                              &ViewToggles::cube));
  table.push_back(view_toggle("truth",
                              "Ground truth",
                              {letter('G')},
                              "True cameras, plane and cube in gray, where they are known",
                              &ViewToggles::truth));
  Action uncertainty = plain("uncertainty",
                             "Uncertainty",
                             "View",
                             {letter('U')},
                             "95 % of camera centers and normal in the scene; again: enlarged 10 "
                             "and 100 times, then off",
                             [](State& s) { enlarge_uncertainty(s.view); });
  uncertainty.checked = [](const State& s) { return s.view.uncertainty > 0; };
  uncertainty.value = [](const State& s) { return uncertainty_text(s.view); };
  uncertainty.needs_recording = false;
  table.push_back(uncertainty);
}

struct PaneRow {
  const char* title;
  const char* tooltip;
};

constexpr PaneRow kSidePanes[] = {
    {"Scene", "Cameras, plane, points and cube in 3-D"},
    {"Normals", "The hemisphere of plane normals: cost, candidates, answers"},
    {"Solver", "Cost, gradient and step over the iterations"},
    {"Candidates", "Every reading of the frame's homography, and why it was rejected"}};
constexpr PaneRow kDrawers[] = {{"Curves", "Errors over the length of the window"},
                                {"Table", "The compared results in numbers, and their differences"},
                                {"Residuals", "Histogram, and root mean square frame by frame"},
                                {"Timing", "Where the time went, stage by stage"},
                                {"Track", "The whole life of the selected track"},
                                {"Log", "Every message"}};

void add_panes(std::vector<Action>& table) {
  for (std::size_t i = 0; i < std::size(kSidePanes); ++i) {
    const auto pane = static_cast<SidePane>(i);
    Action action = plain(std::string("view ") + to_string(pane),
                          kSidePanes[i].title,
                          "View",
                          {},
                          kSidePanes[i].tooltip,
                          [pane](State& s) {
                            s.panes.side = pane;
                            s.panes.compare = false;
                          });
    action.checked = [pane](const State& s) { return s.panes.side == pane && !s.panes.compare; };
    action.needs_recording = false;
    table.push_back(action);
  }
  for (std::size_t i = 0; i < std::size(kDrawers); ++i) {
    const auto drawer = static_cast<Drawer>(i);
    Action action = plain(std::string("view ") + to_string(drawer),
                          kDrawers[i].title,
                          "View",
                          {},
                          kDrawers[i].tooltip,
                          [drawer](State& s) { s.panes.drawer = drawer; });
    action.checked = [drawer](const State& s) { return s.panes.drawer == drawer; };
    action.needs_recording = false;
    table.push_back(action);
  }
  Action shut = plain("view no-drawer",
                      "Shut the drawer",
                      "View",
                      {},
                      "Picture and side pane take all of the height",
                      [](State& s) { s.panes.drawer.reset(); });
  shut.needs_recording = false;
  table.push_back(shut);
}

void add_themes(std::vector<Action>& table) {
  for (const auto& [name, title, theme] : {std::tuple{"theme dark", "Dark theme", Theme::dark},
                                           {"theme light", "Light theme", Theme::light}}) {
    Action action = plain(name,
                          title,
                          "View",
                          {},
                          "Colors of the window; those of methods and data stay",
                          [theme = theme](State& s) { s.theme = theme; });
    action.checked = [theme = theme](const State& s) { return s.theme == theme; };
    action.needs_recording = false;
    table.push_back(action);
  }
}

void add_cameras(std::vector<Action>& table) {
  table.push_back(plain("fit",
                        "Fit view",
                        "View",
                        {letter('F')},
                        "Shows all of the picture, of the scene and of the normals",
                        [](State& s) {
                          s.picture_zoom = {};
                          s.compare_zoom.reset();
                          s.normals_zoom = {};
                          s.orbit.reset();
                        }));
  Action zoom{"zoom", "Zoom the picture", "View", {}, "Shows the picture enlarged around a point"};
  zoom.arguments = "FACTOR [X Y]";
  zoom.run = [](State& s, const Arguments& arguments) {
    expect_count("zoom", arguments, 1, 3);
    s.picture_zoom = zoom_in("zoom", arguments, s.recording->camera);
  };
  table.push_back(zoom);
  Action normals{"zoom-normals",
                 "Zoom the normals",
                 "View",
                 {},
                 "Shows the disc of normals enlarged around one of so much tilt to the right and "
                 "down [deg]"};
  normals.arguments = "FACTOR [RIGHT DOWN]";
  normals.run = [](State& s, const Arguments& arguments) {
    expect_count("zoom-normals", arguments, 1, 3);
    NormalsZoom wanted;
    wanted.factor = number_in("zoom-normals", arguments);
    if (arguments.size() > 1)
      wanted.center = {number_in("zoom-normals", arguments, 1) / 90,
                       number_in("zoom-normals", arguments, 2) / 90};
    s.normals_zoom = within_limits(wanted);
  };
  table.push_back(normals);
}

}  // namespace

void add_view_actions(std::vector<Action>& table) {
  add_toggles(table);
  add_panes(table);
  add_compare_actions(table);
  add_cameras(table);
  add_themes(table);
}

}  // namespace gpo
