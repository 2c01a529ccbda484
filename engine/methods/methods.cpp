// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/methods.h"

#include "engine/base/error.h"
#include "engine/methods/ba.h"
#include "engine/methods/certainty/scene_evidence.h"
#include "engine/methods/certainty/uncertainty.h"
#include "engine/methods/certainty/window_evidence.h"
#include "engine/methods/closed_form.h"
#include "engine/methods/dbscan.h"
#include "engine/methods/fpba.h"
#include "engine/methods/gpo.h"
#include "engine/methods/gpo_joint.h"
#include "engine/methods/pba.h"
#include "engine/methods/plane/other_planes.h"
#include "engine/methods/pnp.h"
#include "engine/methods/pnp_ba.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace gpo {

namespace {

/// Of a method that leaves its user no choice.
template <Initialization (*initialize)(const Window&, const Watch&)>
Initialization plain(const Window& window, const MethodOptions& /*options*/, const Watch& watch) {
  return initialize(window, watch);
}

/// The planes as the cameras of a method see them that knows of one only.
void add_planes(const Window& window, Initialization& result) {
  result.planes.push_back({window.leader, result.plane});
  for (const auto& [number, m] : other_planes(window, motion_of(result.plane, result.cameras)))
    result.planes.push_back({number, {m.normalized(), result.plane.distance / m.norm()}});
}

/// Weak for want of a plane, or of a camera as it is taken to be, rather than of parallax.
void say_what_makes_it_weak(const std::optional<Uncertainty>& judged_by, Verdict& verdict) {
  constexpr double kMostOfIt = 0.7;  // a half of the variance
  if (verdict.readiness != Readiness::weak || !judged_by) return;
  const auto is_most = [&](const std::optional<double>& part_deg) {
    return part_deg && *part_deg >= kMostOfIt * judged_by->normal_sigma_deg;
  };
  if (is_most(judged_by->bend_sigma_deg))
    verdict.reason = fmt::format(
        "not flat, or bent by the lens: the normal varies by {:.2f} deg over the plane's tracks",
        *judged_by->bend_sigma_deg);
  else if (is_most(judged_by->neighbors_sigma_deg))
    verdict.reason = fmt::format(
        "parts of the picture disagree (lens, rolling shutter, relief): the normal moves by {:.2f} "
        "deg with them",
        *judged_by->neighbors_sigma_deg);
}

std::vector<Method> our_methods() {
  using enum MethodFamily;
  using enum Inliers;
  using enum RotationModel;
  // clang-format off
  return {
      Method{"gpo",        "GPO",        0x009E73, optimization, true,  planes, known,        {"solver"}, initialize_gpo,
             "Global plane optimization: the plane's normal and all scaled translations in one "
             "optimization. Assumes one plane, and rotations that are right"},
      Method{"pnp",        "PnP",        0xE69F00, aggregation,  true,  planes, free,         {}, plain<initialize_pnp>,
             "Decomposes the homography of the widest pair, then PnP and triangulation frame by "
             "frame. Assumes a plane in that pair alone"},
      Method{"dbscan",     "DBSCAN",     0xF0E442, aggregation,  true,  planes, known,        {}, plain<initialize_dbscan>,
             "The normal where the decomposed homographies of all frames agree most, translations "
             "by least squares. Assumes one plane, and rotations that are right"},
      Method{"ba",         "BA",         0xD55E00, optimization, false, planes, free,         {}, plain<initialize_ba>,
             "Bundle adjustment of poses and free points, from DBSCAN's. Assumes no plane, but "
             "parallax"},
      Method{"pnp_ba",     "PnP + BA",   0xCC79A7, optimization, false, planes, free,         {}, plain<initialize_pnp_ba>,
             "Bundle adjustment of poses and free points, from PnP's. Assumes no plane, but "
             "parallax"},
      Method{"pba",        "PBA",        0x8B5A2B, optimization, true,  planes, free,         {}, plain<initialize_pba>,
             "Planar bundle adjustment: of poses, a plane and points that stay on it. Assumes one "
             "plane"},
      Method{"fpba",       "FPBA",       0x6E7681, optimization, true,  planes, free,         {}, plain<initialize_fpba>,
             "Planar bundle adjustment with the normal fixed at DBSCAN's. Assumes one plane, and "
             "that normal"},
      Method{"closed_form","Closed form",0x56B4E9, aggregation,  true,  planes, known,        {}, plain<initialize_closed_form>,
             "Normal and translations from all homographies in one singular value decomposition, "
             "without iterations. Assumes one plane, and rotations that are right"},
      Method{"gpo_joint",  "GPO joint",  0x0072B2, optimization, true,  planes, std::nullopt,
             {"solver", "error", "loss", "shutter", "planes", "time_offset"}, initialize_gpo_joint,
             "GPO over all planes of the window, with what is uncertain of the rotations unknown, "
             "too. Assumes planes, but neither a known bias nor, without a gyroscope, any "
             "rotation"},
  };
  // clang-format on
}

[[noreturn]] void refuse_unknown(std::string_view key, const std::vector<MethodChoice>& known) {
  std::string keys;
  for (const MethodChoice& one : known) keys += (keys.empty() ? "" : ", ") + one.key();
  throw SettingError("method", fmt::format("unknown method '{}', expected one of {}", key, keys));
}

/// Where a method is much less sure than its window allows, since it holds rotations or is none of
/// the best: two numbers that differ need a word.
void say_what_is_lost(const std::optional<Uncertainty>& result, Verdict& verdict) {
  constexpr double kMuch = 1.5;
  if (verdict.readiness != Readiness::ready || !result || !verdict.normal_sigma_deg) return;
  if (result->normal_sigma_deg < kMuch * *verdict.normal_sigma_deg) return;
  verdict.reason +=
      fmt::format("; this result{} to {:.2f} deg",
                  result->rotations == RotationModel::known ? ", with rotations held," : "",
                  result->normal_sigma_deg);
}

}  // namespace

std::span<const Method> methods() {
  static const std::vector<Method> table = our_methods();
  return table;
}

Initialization assessed(const Method& method, const Window& window, Initialization result) {
  if (!result.ok) return result;
  const auto judged_by =
      method.rotations ? uncertainty_of(window, result.plane, result.cameras, window.rotations)
                       : result.uncertainty;
  double travel = 0;
  for (const Pose& camera : result.cameras) travel = std::max(travel, camera.p_wc.norm());
  result.verdict = judged(evidence_of(window),
                          judged_by ? std::optional(judged_by->normal_sigma_deg) : std::nullopt,
                          travel / result.plane.distance);
  say_what_makes_it_weak(judged_by, *result.verdict);
  result.verdict->scene = scene_of(window);
  result.verdict->planes = plane_evidence(window);
  result.verdict->criterion =
      scene_criterion(window, result.cameras, result.verdict->noise_px.value_or(0));
  if (result.planes.empty() && !window.planes.empty()) add_planes(window, result);
  if (method.rotations)
    result.uncertainty =
        uncertainty_of(window, result.plane, result.cameras, *method.rotations, Centers::jointly);
  say_what_is_lost(result.uncertainty, *result.verdict);
  if (result.verdict->readiness != Readiness::degenerate) return result;
  const std::string reason = result.verdict->reason;
  return refused(reason, std::move(result));
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
