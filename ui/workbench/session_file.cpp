// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session_file.h"

#include "engine/base/error.h"
#include "engine/experiment/configuration.h"
#include "engine/files/json_text.h"
#include "engine/files/text_file.h"
#include "engine/inspection/setting_values.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Eigen::Vector3d;

constexpr int kVersion = 1;
constexpr const char* kKind = "gpo-inspector session";

Json numbers(const auto& vector) {
  return std::vector<double>(vector.data(), vector.data() + vector.size());
}

Json settings_json(const Settings& settings) {
  Json json;
  for (const std::string& key : setting_keys()) json[key] = setting_text(settings, key);
  return json;
}

Json view_json(const ViewToggles& view) {
  return {{"tracks", view.tracks},
          {"tails", view.tails},
          {"residuals", view.residuals},
          {"cube", view.cube},
          {"truth", view.truth},
          {"uncertainty", view.uncertainty}};
}

Json panes_json(const Panes& panes) {
  Json json = {{"side", to_string(panes.side)}, {"compare", panes.compare}};
  json["drawer"] = panes.drawer ? Json(to_string(*panes.drawer)) : Json();
  return json;
}

Json zoom_json(const PictureZoom& zoom) {
  return {{"factor", zoom.factor}, {"center", numbers(zoom.center)}};
}

Json orbit_json(const std::optional<OrbitCamera>& orbit) {
  if (!orbit) return nullptr;
  return {{"target", numbers(orbit->target)},
          {"up", numbers(orbit->up)},
          {"front", numbers(orbit->front)},
          {"yaw_deg", orbit->yaw_deg},
          {"pitch_deg", orbit->pitch_deg},
          {"distance", orbit->distance},
          {"view_angle_deg", orbit->view_angle_deg}};
}

Json selection_json(const Selection& selection) {
  Json json = {{"tracks", selection.tracks}};
  json["focus"] = selection.focus ? Json(*selection.focus) : Json();
  return json;
}

Json bookmarks_json(const std::vector<Bookmark>& bookmarks) {
  Json json = Json::array();
  for (const Bookmark& one : bookmarks) json.push_back({{"frame", one.frame}, {"note", one.note}});
  return json;
}

/// Reads one object of a session; remembers where it is, for messages.
class Reader {
 public:
  Reader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
    if (!json.is_object()) throw InputError(where_ + ": expected an object");
  }

  bool has(const char* key) const { return json_.contains(key) && !json_.at(key).is_null(); }
  Reader object(const char* key) const { return {json_.at(key), where_ + ": " + key}; }

  /// Leaves the value as it is where the key is missing or null.
  template <class T>
  void operator()(const char* key, T& value) const {
    if (!has(key)) return;
    try {
      json_.at(key).get_to(value);
    } catch (const Json::exception&) {
      refuse(key);
    }
  }
  void operator()(const char* key, double& value, double least, double most) const {
    (*this)(key, value);
    if (!(value >= least && value <= most)) refuse(key);
  }
  void operator()(const char* key, int& value, int least, int most) const {
    if (!has(key)) return;
    const Json& json = json_.at(key);
    // Neither 1.5 nor a number that only fits after its first bits are cut off.
    if (!json.is_number_integer() || json < least || json > most) refuse(key);
    json.get_to(value);
  }
  template <int N>
  void operator()(const char* key, Eigen::Matrix<double, N, 1>& vector) const {
    std::vector<double> all(vector.data(), vector.data() + N);
    (*this)(key, all);
    if (all.size() != N) refuse(key);
    std::ranges::copy(all, vector.data());
  }
  [[noreturn]] void refuse(const char* key) const {
    throw InputError(
        fmt::format("{}: {}: {} is not a value for it", where_, key, json_.at(key).dump()));
  }
  const Json& json() const { return json_; }
  const std::string& where() const { return where_; }

 private:
  const Json& json_;
  std::string where_;
};

void read_settings(const Reader& read, Settings& settings) {
  for (const auto& [key, value] : read.json().items()) {
    if (!value.is_string()) read.refuse(key.c_str());
    try {
      settings = with_setting(settings, key, value.get<std::string>());
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", read.where(), error.what()));
    }
  }
}

void read_view(const Reader& read, ViewToggles& view) {
  read("tracks", view.tracks);
  read("tails", view.tails);
  read("residuals", view.residuals);
  read("cube", view.cube);
  read("truth", view.truth);
  read("uncertainty", view.uncertainty, 0, 100);
}

void read_panes(const Reader& read, Panes& panes) {
  std::string side = to_string(panes.side), drawer;
  read("side", side);
  read("drawer", drawer);
  read("compare", panes.compare);
  if (!is_choice<SidePane>(side)) read.refuse("side");
  panes.side = choice<SidePane>(side);
  if (drawer.empty()) return;
  if (!is_choice<Drawer>(drawer)) read.refuse("drawer");
  panes.drawer = choice<Drawer>(drawer);
}

OrbitCamera read_orbit(const Reader& read) {
  OrbitCamera orbit;
  read("target", orbit.target);
  read("up", orbit.up);
  read("front", orbit.front);
  read("yaw_deg", orbit.yaw_deg, -1e6, 1e6);
  read("pitch_deg", orbit.pitch_deg, -89, 89);
  read("distance", orbit.distance, 1e-6, 1e6);
  read("view_angle_deg", orbit.view_angle_deg, 1, 170);
  return orbit;
}

void read_selection(const Reader& read, Selection& selection) {
  std::vector<std::int64_t> tracks;
  if (read.has("tracks")) {
    const auto whole = [](const Json& one) { return one.is_number_integer(); };
    if (!std::ranges::all_of(read.json().at("tracks"), whole)) read.refuse("tracks");
  }
  read("tracks", tracks);
  selection = selected(tracks);
  if (!read.has("focus")) return;
  if (!read.json().at("focus").is_number_integer()) read.refuse("focus");
  std::int64_t focus = 0;
  read("focus", focus);
  if (selection.contains(focus)) selection.focus = focus;
}

std::vector<Bookmark> read_bookmarks(const Reader& read) {
  std::vector<Bookmark> bookmarks;
  for (const Json& json : read.json().at("bookmarks")) {
    Bookmark one;
    const Reader entry(json, read.where() + ": bookmarks");
    entry("frame", one.frame, 0, 1'000'000'000);
    entry("note", one.note);
    bookmarks.push_back(one);
  }
  return bookmarks;
}

void read_compared(const Reader& read, std::vector<std::string>& compared) {
  read("compared", compared);
  for (std::string& one : compared) one = key_of(parse_configuration(one));
}

void read_zoom(const Reader& read, PictureZoom& zoom) {
  read("factor", zoom.factor, 1, 64);
  read("center", zoom.center);
}

void read_state(const Reader& read, WorkbenchState& state) {
  if (read.has("settings")) read_settings(read.object("settings"), state.settings);
  read("frame", state.frame, 0, 1'000'000'000);
  read("speed", state.speed, 0.01, 100);
  read("loop", state.loop);
  std::string theme = "dark";
  read("theme", theme);
  if (theme != "dark" && theme != "light") read.refuse("theme");
  state.theme = theme == "light" ? Theme::light : Theme::dark;
  if (read.has("view")) read_view(read.object("view"), state.view);
  if (read.has("panes")) read_panes(read.object("panes"), state.panes);
  read_compared(read, state.compared);
  read("cube_side", state.cube_side, 0, 2);
  if (read.has("cube_ray")) read("cube_ray", state.cube_ray.emplace());
  if (read.has("picture_zoom")) read_zoom(read.object("picture_zoom"), state.picture_zoom);
  if (read.has("compare_zoom"))
    read_zoom(read.object("compare_zoom"), state.compare_zoom.emplace());
  read("hidden_curves", state.hidden_curves);
  if (read.has("normals_zoom")) {
    const Reader zoom = read.object("normals_zoom");
    zoom("factor", state.normals_zoom.factor, 1, kLargestNormalsZoom);
    zoom("center", state.normals_zoom.center);
    state.normals_zoom = within_limits(state.normals_zoom);
  }
  if (read.has("orbit")) state.orbit = read_orbit(read.object("orbit"));
  if (read.has("selection")) read_selection(read.object("selection"), state.selection);
  if (read.has("bookmarks")) state.bookmarks = read_bookmarks(read);
}

}  // namespace

std::string session_text(const WorkbenchState& state) {
  Json json = {{"kind", kKind}, {"version", kVersion}};
  json["recording"] = state.recording ? Json(fs::absolute(state.recording->path).string()) : Json();
  json["settings"] = settings_json(state.settings);
  json["frame"] = state.frame;
  json["speed"] = state.speed;
  json["loop"] = state.loop;
  json["theme"] = state.theme == Theme::light ? "light" : "dark";
  json["view"] = view_json(state.view);
  json["panes"] = panes_json(state.panes);
  json["compared"] = state.compared;
  json["hidden_curves"] = state.hidden_curves;
  json["compare_zoom"] = state.compare_zoom ? zoom_json(*state.compare_zoom) : Json();
  json["cube_side"] = state.cube_side;
  json["cube_ray"] = state.cube_ray ? numbers(*state.cube_ray) : Json();
  json["picture_zoom"] = zoom_json(state.picture_zoom);
  json["normals_zoom"] = {{"factor", state.normals_zoom.factor},
                          {"center", numbers(state.normals_zoom.center)}};
  json["orbit"] = orbit_json(state.orbit);
  json["selection"] = selection_json(state.selection);
  json["bookmarks"] = bookmarks_json(state.bookmarks);
  return json_text(json, 2);
}

SavedSession read_session(const fs::path& file) {
  const Json json = read_json(file);
  if (json.is_discarded()) throw InputError(file.string() + ": not valid JSON; expected a session");
  const Reader read(json, file.string());
  std::string kind, recording;
  int version = 0;
  read("kind", kind);
  read("version", version, 0, 1'000'000);
  read("recording", recording);
  if (kind != kKind)
    throw InputError(fmt::format("{}: kind: '{}', expected '{}'", file.string(), kind, kKind));
  if (version != kVersion)
    throw InputError(fmt::format("{}: version: {}, expected {}", file.string(), version, kVersion));
  SavedSession session;
  auto state = std::make_shared<WorkbenchState>();
  read_state(read, *state);
  session.state = state;
  session.recording = recording;
  std::error_code none;
  const fs::path beside = file.parent_path() / session.recording.filename();
  if (!recording.empty() && !fs::exists(session.recording, none) && fs::exists(beside, none))
    session.recording = beside;
  return session;
}

void continue_session(WorkbenchState& state, const SavedSession& session) {
  const WorkbenchState& saved = *session.state;
  state.settings = fit_window(saved.settings, state.frame_count());
  state.frame = std::clamp(saved.frame, 0, std::max(0, state.frame_count() - 1));
  state.speed = saved.speed;
  state.loop = saved.loop;
  state.theme = saved.theme;
  state.view = saved.view;
  state.panes = saved.panes;
  state.compared = saved.compared;
  state.compare_zoom = saved.compare_zoom;
  state.hidden_curves = saved.hidden_curves;
  state.cube_side = saved.cube_side;
  state.cube_ray = saved.cube_ray;
  state.picture_zoom = saved.picture_zoom;
  state.normals_zoom = saved.normals_zoom;
  state.orbit = saved.orbit;
  state.selection = saved.selection;
  state.bookmarks = saved.bookmarks;
}

bool is_session(const fs::path& file) {
  std::error_code none;
  if (file.extension() != ".json" || !fs::is_regular_file(file, none)) return false;
  return read_file(file).find(kKind) != std::string::npos;
}

}  // namespace gpo
