// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The compared results that the window shows besides the current one.
#include "ui/workbench/state.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace gpo {
namespace {

/// Returns the result of the survey, if there is one.
Compared surveyed(const WorkbenchState& state, Configuration name, const Settings& settings) {
  Compared one{std::move(name), settings};
  if (const Surveyed* found = find_surveyed(state.results.surveyed.get(), settings)) {
    one.inspection = found->inspection;
    one.error = found->error;
  }
  return one;
}

Compared compared(const WorkbenchState& state, const Settings& settings) {
  Compared one = surveyed(state, name_among_compared(state, settings), settings);
  // Equal settings may be written differently: a default left out or written out.
  if (!one.inspection && state.results.inspection &&
      as_used(state.results.inspection->settings) == as_used(settings))
    one.inspection = state.results.inspection;
  return one;
}

Compared current_result(const WorkbenchState& state) {
  const Settings& settings = state.document.settings;
  const auto& latest = state.results.inspection;
  return {name_among_compared(state, settings),
          settings,
          latest && latest->settings == settings ? latest : nullptr};
}

/// The ray on which all cubes are placed, in the reference camera.
std::optional<Vector3d> common_ray(const WorkbenchState& state, const std::vector<Compared>& all) {
  if (state.document.cube_ray) return state.document.cube_ray;
  for (const Compared& one : all) {
    if (!one.inspection || !one.inspection->cube) continue;
    // On a board all cubes have the same corners.
    if (one.inspection->cube->on_board) return std::nullopt;
    return one.inspection->cube->origin;
  }
  return std::nullopt;
}

void place_cubes_alike(const WorkbenchState& state, std::vector<Compared>& all) {
  const auto ray = common_ray(state, all);
  for (Compared& one : all)
    one.inspection = with_cube(one.inspection, ray, state.document.other_cube_rays);
}

/// Settings to which the image flips: the first that differ. nullopt: `flip` is off, or none do.
std::optional<Settings> flipped_settings(const WorkbenchState& state) {
  const Configuration current = name_among_compared(state, state.document.settings);
  if (state.view.flip)
    for (const Settings& one : compared_settings(state, state.document.settings))
      if (name_among_compared(state, one) != current) return one;
  return std::nullopt;
}

}  // namespace

std::shared_ptr<const Inspection> with_cube(std::shared_ptr<const Inspection> inspection,
                                            const std::optional<Vector3d>& ray_c,
                                            const std::map<int, Vector3d>& others_c) {
  if (!inspection || (!ray_c && others_c.empty())) return inspection;
  Inspection moved = *inspection;
  if (ray_c) move_cubes(moved, *ray_c);
  for (const auto& [plane, ray] : others_c) move_cubes(moved, ray, plane - 1);
  return std::make_shared<const Inspection>(std::move(moved));
}

Configuration name_among_compared(const WorkbenchState& state, const Settings& settings) {
  return configuration_of(settings, base_of(state.document.compared, state.document.settings));
}

std::vector<Settings> compared_settings(const WorkbenchState& state, const Settings& window) {
  const std::vector<Configuration>& list = state.document.compared;
  const Settings base = base_of(list, window);
  std::vector<Settings> all;
  for (const Configuration& one : list) all.push_back(apply(one, base));
  return all;
}

std::vector<Settings> settings_with_current(const WorkbenchState& state, const Settings& window) {
  std::vector<Settings> all = compared_settings(state, window);
  const Configuration current = name_among_compared(state, window);
  const auto is_current = [&](const Settings& one) {
    return name_among_compared(state, one) == current;
  };
  if (std::ranges::none_of(all, is_current)) all.insert(all.begin(), window);
  return all;
}

std::vector<Compared> compared_results(const WorkbenchState& state) {
  std::vector<Compared> all = compared_with_current(state);
  place_cubes_alike(state, all);
  if (state.view.flip && all.size() > 1) std::swap(all[0], all[1]);
  return all;
}

std::vector<Compared> compared_with_current(const WorkbenchState& state) {
  std::vector<Compared> all;
  for (const Settings& settings : compared_settings(state, state.document.settings))
    all.push_back(compared(state, settings));
  Compared current = current_result(state);
  if (std::ranges::find(all, current.configuration, &Compared::configuration) == all.end())
    all.insert(all.begin(), std::move(current));
  return all;
}

std::optional<Compared> flipped_result(const WorkbenchState& state) {
  const auto other = flipped_settings(state);
  if (!other) return std::nullopt;
  // The cube is placed where the current result has it.
  std::vector<Compared> both = {current_result(state), compared(state, *other)};
  place_cubes_alike(state, both);
  return both.back();
}

std::vector<int> curve_lengths(int frames) {
  constexpr int kStep = 5;
  std::vector<int> lengths = {frames};
  for (int shorter = (frames - 1) / kStep * kStep; shorter >= kStep; shorter -= kStep)
    lengths.push_back(shorter);
  return lengths;
}

std::vector<Settings> wanted_inspections(const WorkbenchState& state) {
  std::vector<Settings> wanted;
  if (!state.document.recording) return wanted;
  PaneNeeds needs = needs_of(state.view.panes);
  if (wants_report(state)) needs.compared = needs.lengths = true;
  if (!needs.compared) {
    if (const auto other = flipped_settings(state)) wanted.push_back(*other);
    return wanted;
  }
  // The longest window first: the shorter ones reuse its tracks.
  Settings window = state.document.settings;
  for (const int frames : curve_lengths(window.frames)) {
    if (!needs.lengths && frames < state.document.settings.frames) break;
    window.frames = frames;
    std::ranges::copy(settings_with_current(state, window), std::back_inserter(wanted));
  }
  return wanted;
}

std::vector<ShownResult> shown_results(const WorkbenchState& state) {
  std::vector<ShownResult> shown;
  if (!state.results.inspection) return shown;
  const Settings& s = state.results.inspection->settings;
  const auto add = [&](const Settings& settings, std::shared_ptr<const Inspection> inspection) {
    const Configuration one = name_among_compared(state, settings);
    shown.push_back({title_of(one), color_of(one), std::move(inspection), shown.empty()});
  };
  add(s, state.results.inspection);
  for (const Settings& settings : compared_settings(state, s)) {
    if (as_used(settings) == as_used(s)) continue;
    const Surveyed* surveyed = find_surveyed(state.results.surveyed.get(), settings);
    if (surveyed != nullptr && surveyed->inspection) add(settings, surveyed->inspection);
  }
  return shown;
}

}  // namespace gpo
