// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/methods.h"

#include "engine/base/error.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/uncertainty/regions.h"
#include "engine/methods/uncertainty/uncertainty.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {

namespace {

/// Adapts a method without options.
template <Initialization (*initialize)(const Window&, const Watch&)>
Initialization plain(const Window& window, const MethodOptions& /*options*/, const Watch& watch) {
  return initialize(window, watch);
}

constexpr StartMethod kDbscan{"DBSCAN", initialize_dbscan};
constexpr StartMethod kPnp{"PnP", initialize_pnp};

/// Adapts a method that refines the result of another one.
template <const StartMethod& start, Refinement refine>
Initialization refined(const Window& window, const MethodOptions& /*options*/, const Watch& watch) {
  return refined_start(window, start, refine, watch);
}

template <Refinement refine>
Initialization again(const Window& window,
                     const Initialization& start,
                     const MethodOptions& /*options*/,
                     const Watch& watch) {
  return refine(window, start, watch);
}

/// Adds the window's other planes to the result of a method that estimates only one.
void add_planes(const Window& window, Initialization& result) {
  result.planes.push_back({window.leader, result.plane});
  for (const auto& [number, m] : other_planes(window, motion_of(result.plane, result.cameras)))
    result.planes.push_back({number, {m.normalized(), result.plane.distance / m.norm()}});
}

std::vector<Method> our_methods() {
  using enum MethodFamily;
  using enum Inliers;
  using enum RotationModel;
  // clang-format off
  std::vector<Method> table{
      Method{"gpo",        "GPO",        0x009E73, optimization, true,  planes, known,        {"solver"}, initialize_gpo,
             "Global plane optimization: one optimization of the plane normal and all scaled "
             "translations. Assumes one plane and correct rotations"},
      Method{"pnp",        "PnP",        0xE69F00, aggregation,  true,  planes, free,         {}, plain<initialize_pnp>,
             "Decomposes the homography of the pair with the largest baseline, then PnP and "
             "triangulation frame by frame. Assumes a plane in that pair only"},
      Method{"dbscan",     "DBSCAN",     0xF0E442, aggregation,  true,  planes, known,        {}, plain<initialize_dbscan>,
             "Density peak of the normals from the decomposed homographies of all frames, "
             "translations by least squares. Assumes one plane and correct rotations"},
      Method{"ba",         "BA",         0xD55E00, optimization, false, planes, free,         {},
             refined<kDbscan, refine_bundle>,
             "Bundle adjustment of poses and free points, started from DBSCAN. Assumes parallax, "
             "but no plane"},
      Method{"pnp_ba",     "PnP + BA",   0xCC79A7, optimization, false, planes, free,         {},
             refined<kPnp, refine_bundle>,
             "Bundle adjustment of poses and free points, started from PnP. Assumes parallax, but "
             "no plane"},
      Method{"pba",        "PBA",        0x8F3FFF, optimization, true,  planes, free,         {},
             refined<kDbscan, refine_on_plane<PlaneNormal::free>>,
             "Planar bundle adjustment of poses, a plane and the points on it. Assumes one plane"},
      Method{"fpba",       "FPBA",       0x6E7681, optimization, true,  planes, free,         {},
             refined<kDbscan, refine_on_plane<PlaneNormal::held>>,
             "Planar bundle adjustment with the normal fixed at DBSCAN's. Assumes one plane and a "
             "correct normal"},
      Method{"closed_form","Closed form",0x56B4E9, aggregation,  true,  planes, known,        {}, plain<initialize_closed_form>,
             "Normal and translations from all homographies by one singular value decomposition, "
             "without iterations. Assumes one plane and correct rotations"},
      Method{"gpo_joint",  "GPO joint",  0x0072B2, optimization, true,  planes, std::nullopt,
             {"solver", "error", "loss", "shutter", "planes", "time_offset"}, initialize_gpo_joint,
             "GPO over all planes of the window that also estimates the gyroscope bias or, without "
             "a gyroscope, all rotations. Assumes one or more planes"},
  };
  // clang-format on
  for (Method& method : table) {
    method.resampled = true;
    if (method.key == "ba" || method.key == "pnp_ba") method.restart = again<refine_bundle>;
    if (method.key == "pba") method.restart = again<refine_on_plane<PlaneNormal::free>>;
    if (method.key == "gpo_joint") method.restart = restart_gpo_joint;
  }
  return table;
}

[[noreturn]] void refuse_unknown(std::string_view key, const std::vector<MethodChoice>& known) {
  std::string keys;
  for (const MethodChoice& one : known) keys += (keys.empty() ? "" : ", ") + one.key();
  throw SettingError("method", fmt::format("unknown method '{}', expected one of {}", key, keys));
}

/// Returns the uncertainty of a method that does not compute it. Rotations from the images that the
/// method holds count as unknown.
std::optional<Uncertainty> uncertainty_by_tracks(RotationModel method,
                                                 const Window& window,
                                                 const Initialization& result) {
  const auto of = [&](RotationModel rotations) {
    return uncertainty_of(window, result.plane, result.cameras, rotations);
  };
  using enum RotationModel;
  auto u = of(method);
  if (method != known || window.rotations != free || !u) return u;
  auto all = of(free);
  if (!all) return std::nullopt;
  all->rotations = known;
  all->noise = std::move(u->noise);
  return all;
}

}  // namespace

std::span<const Method> methods() {
  static const std::vector<Method> table = our_methods();
  return table;
}

std::optional<NoiseSpread> own_noise(const Method& method,
                                     const Window& window,
                                     const Initialization& result,
                                     const std::function<Initialization(const Window&)>& initialize,
                                     const MethodOptions& options,
                                     const Watch& watch) {
  if (!method.resampled || !result.ok) return std::nullopt;
  if (!method.restart) return spread_by_regions(window, result, initialize);
  Initialization start = result;
  start.points.clear();  // they have the places of the tracks in the whole window
  return spread_by_regions(window, result, [&](const Window& without_region) {
    return method.restart(without_region, start, options, watch);
  });
}

Initialization with_uncertainty(const Method& method, const Window& window, Initialization result) {
  if (!result.transfer_rms_px) set_fit_errors(window, result);
  auto& uncertainty = result.uncertainty;
  if (method.rotations)
    uncertainty = uncertainty_by_tracks(*method.rotations, window, result);
  else if (uncertainty)
    uncertainty->own = true;
  if (uncertainty && !uncertainty->has_size) {
    const bool known = result.own_noise && !result.own_noise->unstable;
    uncertainty = with_size(
        std::move(*uncertainty), window, result.plane, known ? result.own_noise : std::nullopt);
  }
  if (result.planes.empty() && !window.planes.empty()) add_planes(window, result);
  set_plane_uncertainties(result);
  return result;
}

std::vector<std::string> readers_of(const std::string& option) {
  std::vector<std::string> readers;
  for (const Method& method : methods())
    if (std::ranges::find(method.reads, option) != method.reads.end())
      readers.push_back(method.key);
  return readers;
}

const Method& find_method(std::string_view key) {
  const auto found = std::ranges::find(methods(), key, &Method::key);
  if (found == methods().end()) refuse_unknown(key, MethodTable().all());
  return *found;
}

void MethodTable::add(Method own) {
  if (contains(own.key)) throw InputError(fmt::format("there already is a method '{}'", own.key));
  own_.push_back(std::make_shared<const Method>(std::move(own)));
}

void MethodTable::add(const MethodChoice& choice) {
  if (choice.own() && std::ranges::find(own_, choice.own()) == own_.end())
    own_.push_back(choice.own());
}

std::vector<MethodChoice> MethodTable::all() const {
  std::vector<MethodChoice> all;
  for (const Method& method : methods()) all.emplace_back(method.key);
  for (const auto& method : own_) all.emplace_back(method);
  return all;
}

bool MethodTable::contains(std::string_view key) const {
  const std::vector<MethodChoice> known = all();
  return std::ranges::find(known, key, &MethodChoice::key) != known.end();
}

MethodChoice MethodTable::find(std::string_view key) const {
  const std::vector<MethodChoice> known = all();
  const auto found = std::ranges::find(known, key, &MethodChoice::key);
  if (found == known.end()) refuse_unknown(key, known);
  return *found;
}

}  // namespace gpo
