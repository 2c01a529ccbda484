// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/diagnosis.h"

#include "engine/base/error.h"
#include "engine/diagnosis/checks.h"
#include "engine/diagnosis/not_finite.h"
#include "engine/diagnosis/window_evidence.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/uncertainty/uncertainty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

/// Returns the remarks on a check's key as notes.
std::vector<Finding> remarked(const Evidence& evidence, std::string_view key) {
  std::vector<Finding> findings;
  for (const Remark& remark : evidence.remarks)
    if (remark.key == key)
      findings.push_back({.sentence = remark.sentence, .advice = remark.advice});
  return findings;
}

/// Returns null for an unknown key.
const Check* check_of(std::string_view key) {
  const auto found = std::ranges::find_if(checks(), [&](const Check& c) { return c.key == key; });
  return found == checks().end() ? nullptr : &*found;
}

/// Returns why a window without a finding above a note is ready.
std::string why_ready(const Evidence& e) {
  const auto sigma_deg = e.numbers->normal_sigma_deg;
  if (!sigma_deg) return "";
  std::string text = fmt::format("normal uncertainty {:.2f} deg (1 sigma)", *sigma_deg);
  if (const Uncertainty* u = e.uncertainty(); u != nullptr && *sigma_deg > u->normal_sigma_deg)
    text += fmt::format("; {:.2f} deg if the lens is exact", u->normal_sigma_deg);
  return text;
}

}  // namespace

std::span<const Check> checks() {
  using namespace check;
  // clang-format off
  static const Check table[] = {
      {"not-finite", "A number that is not finite", Of::length, false, not_finite},
      {"no-plane", "No plane among the tracks", Of::window, false, no_plane},
      {"two-orientations", "Two orientations of the plane fit", Of::window, false, two_orientations},
      {"implausible-intrinsics", "Implausible focal length or principal point", Of::recording, true, implausible_intrinsics},
      {"truth-conventions", "The ground truth fits by another convention", Of::window, false, truth_conventions},
      {"static-tracks", "Tracks that do not move while others do", Of::window, true, static_tracks},
      {"repeated-texture", "Texture that repeats within the motion of a frame", Of::window, true, repeated_texture},
      {"camera-at-rest", "The camera rests, the plane moves", Of::window, true, camera_at_rest},
      {"gyroscope-bias", "The gyroscope's bias contradicts its prior", Of::result, false, contradicted_bias},
      {"rotation-only", "Rotations alone explain the images", Of::length, false, rotation_only},
      {"method-failed", "The method failed", Of::result, false, method_failed},
      {"late-clock", "The gyroscope's clock is late", Of::result, false, late_clock},
      {"rolling-shutter", "A rolling shutter that the method neglects", Of::result, false, neglected_rolling_shutter},
      {"changing-focal-length", "The focal length changes", Of::result, true, changing_focal_length},
      {"little-parallax", "The camera hardly moved", Of::length, false, little_parallax},
      {"uncertain-lens", "A typical calibration error decides", Of::result, false, uncertain_lens},
      {"uneven-surface", "The surface is uneven", Of::result, false, uneven_surface},
      {"regions-disagree", "Regions of the image disagree", Of::result, false, regions_disagree},
      {"uncertain-normal", "The plane's normal is uncertain", Of::length, false, uncertain_normal},
      {"unstable-method", "The method depends on a few tracks", Of::result, true, unstable_method},
      {"guessed-camera", "The camera is a guess", Of::recording, true, guessed_camera},
      {"moving-objects", "Objects move in the scene", Of::result, true, moving_objects},
      {"gyroscope-units", "The gyroscope's unit, hand or direction is wrong", Of::window, false, nullptr},
      {"interlaced", "The video is interlaced", Of::recording, false, interlaced},
      {"gyroscope-misfit", "The gyroscope does not fit the images", Of::window, false, nullptr},
      {"faulty-frames", "Frames repeat, or do not show the scene", Of::window, false, nullptr},
      {"missing-plane", "The requested plane does not exist", Of::window, false, nullptr},
      {"truth-jump", "The ground truth jumps", Of::inspection, false, nullptr},
      {"truth-of-board", "The ground truth's board and the readout time", Of::inspection, false, nullptr},
      {"truth-of-another-plane", "The ground truth describes another plane", Of::inspection, false, truth_of_another_plane},
      {"truth-contradicts", "The result contradicts the ground truth", Of::inspection, false, truth_contradicts},
      {"unknown-scale", "Requested points do not give a scale or a world", Of::inspection, false, nullptr},
      {"unused-settings", "Settings that have no effect", Of::inspection, false, nullptr},
  };
  // clang-format on
  return table;
}

void check_ignored(std::span<const std::string> keys) {
  for (const std::string& key : keys) {
    const Check* check = check_of(key);
    if (check != nullptr && check->may_be_ignored) continue;
    std::vector<std::string_view> known;
    for (const Check& one : checks())
      if (one.may_be_ignored) known.emplace_back(one.key);
    throw SettingError("ignore_findings",
                       fmt::format("{} '{}', expected some of {}",
                                   check == nullptr ? "unknown finding" : "cannot ignore",
                                   key,
                                   fmt::join(known, ", ")));
  }
}

std::vector<Finding> findings_of(const Evidence& evidence,
                                 std::initializer_list<Of> of,
                                 std::span<const std::string> ignored) {
  std::vector<Finding> all;
  for (const Check& check : checks()) {
    if (std::ranges::find(of, check.of) == of.end()) continue;
    // The other checks would compare and print the same numbers.
    const bool finite = find_finding(all, "not-finite") == nullptr;
    if (!finite && (check.of == Of::length || check.of == Of::result)) continue;
    for (Finding& finding :
         check.look != nullptr ? check.look(evidence) : remarked(evidence, check.key)) {
      finding.key = check.key;
      finding.ignored =
          check.may_be_ignored && std::ranges::find(ignored, finding.key) != ignored.end();
      if (finding.ignored) finding.level = Level::note;
      all.push_back(std::move(finding));
    }
  }
  sort_by_level(all);
  return all;
}

void sort_by_level(std::vector<Finding>& findings) {
  std::ranges::stable_sort(findings, std::ranges::greater(), &Finding::level);
}

Verdict verdict_of(std::span<const Finding> findings, const Evidence& evidence) {
  Verdict verdict = *evidence.numbers;
  constexpr std::array kReadiness{
      Readiness::ready, Readiness::weak, Readiness::degenerate, Readiness::no_plane};
  verdict.readiness = kReadiness[static_cast<std::size_t>(heaviest(findings))];
  for (auto* number : {&verdict.normal_sigma_deg,
                       &verdict.rotation_rms_px,
                       &verdict.noise_px,
                       &verdict.largest_translation})
    if (*number && !std::isfinite(**number)) number->reset();
  const auto heavy = std::ranges::max_element(findings, {}, &Finding::level);
  verdict.reason = verdict.readiness == Readiness::ready ? why_ready(evidence) : text_of(*heavy);
  if (verdict.readiness == Readiness::no_plane) verdict.scene = SceneKind::no_plane;
  return verdict;
}

std::vector<Verdict> growth_verdicts(std::span<const Verdict> numbers,
                                     std::span<const Finding> of_whole) {
  std::vector<Finding> standing;
  for (const Finding& finding : of_whole) {
    const Of of = check_of(finding.key)->of;
    if (of == Of::recording || of == Of::window) standing.push_back(finding);
  }
  std::vector<Verdict> verdicts;
  for (const Verdict& one : numbers) {
    const Evidence evidence{.numbers = &one};
    std::vector<Finding> findings = findings_of(evidence, {Of::length});
    findings.insert(findings.end(), standing.begin(), standing.end());
    verdicts.push_back(verdict_of(findings, evidence));
  }
  return verdicts;
}

std::vector<Verdict> comparable_numbers(std::span<const Verdict> growth, const Verdict& whole) {
  if (growth.empty() || !growth.back().normal_sigma_deg || !whole.normal_sigma_deg) return {};
  const double ratio = std::max(1.0, *whole.normal_sigma_deg / *growth.back().normal_sigma_deg);
  std::vector<Verdict> numbers(growth.begin(), growth.end());
  for (Verdict& one : numbers)
    if (one.normal_sigma_deg) *one.normal_sigma_deg *= ratio;
  return numbers;
}

Initialization assessed(const Method& method,
                        const Window& window,
                        Initialization result,
                        Lens lens) {
  if (!result.ok) return result;
  result = with_uncertainty(method, window, std::move(result));
  const Verdict numbers = window_numbers(window, result, lens);
  const Evidence evidence{
      .window = &window, .numbers = &numbers, .method = &method, .lens = lens, .result = &result};
  const auto findings = findings_of(evidence, {Of::window, Of::length, Of::result});
  return judged(verdict_of(findings, evidence), std::move(result));
}

Initialization judged(Verdict verdict, Initialization result) {
  const bool fails = result.ok && verdict.readiness == Readiness::degenerate;
  result.verdict = std::move(verdict);
  if (!fails) return result;
  const std::string reason = result.verdict->reason;
  const bool finite = first_not_finite(result).empty();
  Initialization failure = refused(reason, std::move(result));
  if (!finite) failure.refused.reset();
  return failure;
}

}  // namespace gpo
