// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session/session_fields.h"

#include <concepts>
#include <type_traits>

namespace gpo {
namespace {

using Json = SessionJson;
using State = WorkbenchState;

// `each_part` calls `use(key, part, limits...)` for each part of a value stored as an object.

template <class T, class Value>
concept Is = std::same_as<std::remove_const_t<T>, Value>;
template <class T>
concept Object = Is<T, ImageZoom> || Is<T, NormalsZoom> || Is<T, OrbitCamera> || Is<T, Division> ||
    Is<T, ViewToggles>;

template <class T>
concept HasChoiceRows = requires {
  choice_rows(T{});
};

template <class T>
requires Is<T, ImageZoom> || Is<T, NormalsZoom>
void each_part(T& zoom, auto&& use) {
  use("factor", zoom.factor, 1, Is<T, ImageZoom> ? 64 : kLargestNormalsZoom);
  use("center", zoom.center);
}

void each_part(Is<OrbitCamera> auto& orbit, auto&& use) {
  use("target", orbit.target);
  use("up", orbit.up);
  use("front", orbit.front);
  use("yaw_deg", orbit.yaw_deg, -1e6, 1e6);
  use("pitch_deg", orbit.pitch_deg, -89, 89);
  use("distance", orbit.distance, 1e-6, 1e6);
  use("view_angle_deg", orbit.view_angle_deg, 1, 170);
}

void each_part(Is<Division> auto& division, auto&& use) {
  use("column_px", division.column_px, 0, 10'000);
  use("settings_px", division.settings_px, 0, 10'000);
  use("picture_share", division.image_share, 0, 1);
  use("drawer_share", division.drawer_share, 0, 1);
  use("column", division.column);
  use("timeline", division.timeline);
}

void each_part(Is<ViewToggles> auto& view, auto&& use) {
  for (const ViewToggle& one : kViewToggles) use(one.key, view.*one.shown);
  for (const ViewNumber& one : kViewNumbers) use(one.key, view.*one.value, one.least, one.most);
}

struct ToJson {
  template <class T>
  Json operator()(const T& value) const {
    return value;
  }
  template <int N>
  Json operator()(const Eigen::Matrix<double, N, 1>& vector) const {
    return std::vector<double>(vector.data(), vector.data() + N);
  }
  template <class T>
  Json operator()(const std::optional<T>& value) const {
    return value ? (*this)(*value) : Json();
  }
  template <Object T>
  Json operator()(const T& value) const {
    Json json;
    each_part(value,
              [&](const char* key, const auto& part, auto...) { json[key] = (*this)(part); });
    return json;
  }
  Json operator()(const Settings& settings) const {
    Json json;
    for (const std::string& key : setting_keys()) json[key] = setting_text(settings, key);
    return json;
  }
  template <HasChoiceRows T>
  Json operator()(const T& value) const {
    return std::ranges::find(choice_rows(value), value, &ChoiceRow<T>::value)->key;
  }
  Json operator()(const Panes& panes) const {
    Json json = {{"side", panes.side->key}, {"compare", panes.compare}};
    json["drawer"] = panes.drawer == nullptr ? Json() : Json(panes.drawer->key);
    if (panes.beside != nullptr) json["beside"] = panes.beside->key;
    return json;
  }
  Json operator()(const Selection& selection) const {
    return {{"tracks", selection.tracks}, {"focus", (*this)(selection.focus)}};
  }
  Json operator()(const std::map<int, Vector3d>& rays) const {
    Json json = Json::array();
    for (const auto& [plane, ray] : rays) json.push_back({{"plane", plane}, {"ray", (*this)(ray)}});
    return json;
  }
  Json operator()(const std::vector<Configuration>& compared) const {
    Json json = Json::array();
    for (const Configuration& one : compared) json.push_back(key_of(one));
    return json;
  }
  Json operator()(const std::vector<Bookmark>& bookmarks) const {
    Json json = Json::array();
    for (const Bookmark& one : bookmarks)
      json.push_back({{"frame", one.frame}, {"note", one.note}});
    return json;
  }
};

/// Reads each kind of value, within optional limits. Throws InputError that names the key.
struct FromJson {
  const SessionReader& read;
  const MethodTable& methods;

  template <class T>
  void operator()(const char* key, T& value, auto... limits) const {
    read(key, value, limits...);
  }
  template <class T>
  void operator()(const char* key, std::optional<T>& value) const {
    (*this)(key, value.emplace());
  }
  template <Object T>
  void operator()(const char* key, T& value) const {
    const SessionReader parts = read.object(key);
    each_part(value, [&](const char* part_key, auto& part, auto... limits) {
      FromJson{parts, methods}(part_key, part, limits...);
    });
    if constexpr (std::same_as<T, NormalsZoom>) value = within_limits(value);
  }
  void operator()(const char* key, Settings& settings) const {
    const SessionReader all = read.object(key);
    for (const auto& [one, value] : all.json().items()) {
      if (!value.is_string()) all.refuse(one.c_str());
      try {
        settings = with_setting(settings, one, value.template get<std::string>(), methods);
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", all.where(), error.what()));
      }
    }
  }
  template <HasChoiceRows T>
  void operator()(const char* key, T& value) const {
    std::string name;
    read(key, name);
    const auto found = std::ranges::find(choice_rows(value), name, &ChoiceRow<T>::key);
    if (found == choice_rows(value).end()) read.refuse(key);
    value = found->value;
  }
  void operator()(const char* key, Panes& panes) const {
    const SessionReader open = read.object(key);
    std::string side = panes.side->key, drawer, beside;
    open("side", side);
    open("drawer", drawer);
    if (open.has("beside")) open("beside", beside);
    open("compare", panes.compare);
    const Pane* found = find_pane(side, side_panes());
    if (found == nullptr) open.refuse("side");
    panes.side = found;
    if (drawer.empty()) return;
    panes.drawer = find_pane(drawer, drawers());
    if (panes.drawer == nullptr) open.refuse("drawer");
    panes.beside = find_pane(beside, drawers());
    if (panes.beside == panes.drawer || (panes.beside == nullptr && !beside.empty()))
      open.refuse("beside");
  }
  void operator()(const char* key, Selection& selection) const {
    const SessionReader picked = read.object(key);
    std::vector<std::int64_t> tracks;
    if (picked.has("tracks")) {
      const auto whole = [](const Json& one) { return one.is_number_integer(); };
      if (!std::ranges::all_of(picked.json().at("tracks"), whole)) picked.refuse("tracks");
    }
    picked("tracks", tracks);
    selection = selected(tracks);
    if (!picked.has("focus")) return;
    if (!picked.json().at("focus").is_number_integer()) picked.refuse("focus");
    std::int64_t focus = 0;
    picked("focus", focus);
    if (selection.contains(focus)) selection.focus = focus;
  }
  void operator()(const char* key, std::vector<Configuration>& compared) const {
    std::vector<std::string> keys;
    read(key, keys);
    if (keys.empty()) return;  // panes compare at least one result
    compared.clear();
    for (const std::string& one : keys) compared.push_back(parse_configuration(one, methods));
  }
  void operator()(const char* key, std::map<int, Vector3d>& rays) const {
    for (const Json& json : read.json().at(key)) {
      const SessionReader entry(json, read.where() + ": " + key);
      int plane = 0;
      Vector3d ray = Vector3d::Zero();
      entry("plane", plane, 1, 1000);
      entry("ray", ray);
      rays[plane] = ray;
    }
  }
  void operator()(const char* key, std::vector<Bookmark>& bookmarks) const {
    for (const Json& json : read.json().at(key)) {
      Bookmark one;
      const SessionReader entry(json, read.where() + ": " + key);
      entry("frame", one.frame, 0, 1'000'000'000);
      entry("note", one.note);
      bookmarks.push_back(one);
    }
    std::ranges::stable_sort(bookmarks, {}, &Bookmark::frame);
  }
};

/// Sessions used to have one cube, on any plane.
SessionField cube_plane_of_old_sessions() {
  return {"cube_plane",
          [](const State&) { return Json(0); },
          [](const SessionReader& read, State& state) {
            int plane = 0;
            read("cube_plane", plane, 0, 1000);
            auto& ray = state.document.cube_ray;
            if (plane == 0 || !ray) return;
            state.document.other_cube_rays[plane] = *ray;
            ray.reset();
          },
          [](const State&, State&) {}};
}

template <class Part>
auto& part_of(auto& state) {
  if constexpr (std::derived_from<Document, Part>) {
    return state.document;
  } else if constexpr (std::same_as<Part, ViewState>) {
    return state.view;
  } else {
    return state;
  }
}

/// A member of the state or of one of its parts, with optional smallest and largest values.
template <class Part, class T>
SessionField field(const char* key, T Part::*member, auto... limits) {
  return {key,
          [member](const State& state) { return ToJson{}(part_of<Part>(state).*member); },
          [key, member, limits...](const SessionReader& read, State& state) {
            FromJson{read, state.methods}(key, part_of<Part>(state).*member, limits...);
          },
          [member](const State& from, State& to) {
            part_of<Part>(to).*member = part_of<Part>(from).*member;
          }};
}

}  // namespace

std::span<const SessionField> session_fields() {
  static const std::vector<SessionField> table = {
      field("settings", &Document::settings),
      field("frame", &ViewState::frame, 0, 1'000'000'000),
      field("speed", &ViewState::speed, 0.01, 100.0),
      field("loop", &ViewState::loop),
      field("theme", &ViewState::theme),
      field("view", &ViewState::toggles),
      field("panes", &ViewState::panes),
      field("division", &ViewState::division),
      field("text_zoom", &ViewState::text_zoom, 0.5, 3.0),
      field("compared", &Document::compared),
      field("hidden_curves", &ViewState::hidden_curves),
      field("compare_zoom", &ViewState::compare_zoom),
      field("metric", &Document::metric),
      field("cube_side", &Document::cube_side, 0.0, 2.0),
      field("cube_ray", &Document::cube_ray),
      field("model", &Document::model),
      field("picture_zoom", &ViewState::image_zoom),
      field("normals_zoom", &ViewState::normals_zoom),
      field("viewpoint", &ViewState::viewpoint),
      field("coloring", &ViewState::coloring),
      field("orbit", &ViewState::orbit),
      field("selection", &State::selection),
      field("bookmarks", &Document::bookmarks),
      cube_plane_of_old_sessions(),
      field("other_cubes", &Document::other_cube_rays)};
  return table;
}

}  // namespace gpo
