// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/pipeline.h"

#include "engine/base/error.h"
#include "engine/diagnosis/growth.h"
#include "engine/diagnosis/window_evidence.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/uncertainty/uncertainty.h"
#include "engine/pipeline/method_defaults.h"
#include "engine/planes/inliers.h"
#include "engine/planes/readout_compensation.h"
#include "engine/rotations/gyroscope_alignment.h"

#include <limits>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Returns the rotations of one orientation; the first one is 1.
Rotations of_orientation(int number, Rotations both) {
  if (both.R_wc_other.empty()) return both;
  if (number == 2) both.R_wc = std::move(both.R_wc_other);
  both.R_wc_other.clear();
  both.note = fmt::format("orientation {} of two that are {:.0f} deg apart and fit equally well",
                          number,
                          both.orientations_apart_deg);
  return both;
}

Rotations rotations_from(RotationSource source,
                         const Window& window,
                         const RotationInputs& inputs,
                         const std::stop_token& stop) {
  using enum RotationSource;
  if (source == gyro) return sensitive_gyro_rotations(*inputs.gyroscope, window.timestamps_ns);
  if (source == truth) return {{inputs.R_wc_true.begin(), inputs.R_wc_true.end()}, ""};
  if (auto reason = reason_not_to_try(window)) return {{}, *reason};
  if (source == averaging) return averaged_rotations(window, stop);
  if (source == averaging_first || source == averaging_second)
    return of_orientation(source == averaging_first ? 1 : 2, averaged_rotations(window, stop));
  if (source == gyro_calibrated) return calibrated_gyro_rotations(*inputs.gyroscope, window, stop);
  const auto solver = source == direct ? RelativeSolver::eigensolver : RelativeSolver::five_point;
  return pair_rotations(window, {solver, window.threshold_px, inputs.seed}, stop);
}

/// Returns the rotations of a window whose points are at the time stamps of their frames.
ChosenRotations rotations_at_stamps(const Window& window,
                                    const RotationInputs& inputs,
                                    RotationSource requested,
                                    const std::stop_token& stop) {
  const bool has_gyroscope = inputs.gyroscope != nullptr;
  const RotationSource first = first_source(requested, has_gyroscope);
  ChosenRotations chosen{first, rotations_from(first, window, inputs, stop)};
  chosen.note = chosen.rotations.note;
  const bool settled = !chosen.rotations.R_wc.empty() || chosen.rotations.stopped;
  if (requested != RotationSource::automatic || settled) return chosen;
  chosen.note = chosen.rotations.reason;
  chosen.source = has_gyroscope ? RotationSource::gyro : RotationSource::averaging;
  chosen.rotations = rotations_from(chosen.source, window, inputs, stop);
  if (!chosen.rotations.note.empty()) chosen.note += "; " + chosen.rotations.note;
  return chosen;
}

std::string why_not_covered_by(const Gyroscope& gyroscope, const Window& window) {
  const auto& times = window.timestamps_ns;
  return why_not_covered(
      gyroscope, times.front() + gyroscope.time_offset_ns, times.back() + gyroscope.time_offset_ns);
}

Initialization run(const Window& window,
                   const Sources& sources,
                   const InitializeOptions& options,
                   const Watch& watch) {
  const Method& method = options.method.row();
  return method.initialize_from ? method.initialize_from(window, sources, watch)
                                : method.initialize(window, options.method_options, watch);
}

bool has_accelerations(const Sources& sources) {
  return sources.gyroscope != nullptr && !sources.gyroscope->accelerations_m_s2.empty();
}

/// Returns the numbers of the window for its verdict: by the result, else as the window grew.
Verdict numbers_for(const Window& window,
                    std::span<const Verdict> growth,
                    const Initialization& result,
                    Lens lens) {
  if (result.ok) return window_numbers(window, result, lens);
  const bool whole = std::ssize(growth) == window.frame_count() - 1 && !growth.empty();
  return whole ? growth.back() : Verdict{};
}

void set_readout(const Camera& camera, const Tracks& tracks, Window& window) {
  window.readout_direction = readout_direction(camera);
  window.image_rows = readout_lines(camera);
  for (const Eigen::Matrix2Xd& raw_px : tracks.raw_px) {
    Eigen::VectorXd& rows = window.rows.emplace_back(raw_px.cols());
    for (Eigen::Index j = 0; j < rows.size(); ++j) rows[j] = row_from_middle(camera, raw_px.col(j));
  }
  if (camera.readout && readout_lines(camera) > 1) {
    const double rows = readout_lines(camera) - 1;
    window.row_delay = {camera.readout->seconds / rows, camera.readout->sigma_s / rows};
  }
}

}  // namespace

bool uses_ransac(const InitializeOptions& options) {
  return options.ransac.value_or(options.method.row().needs_plane);
}

Inliers inliers_used(const InitializeOptions& options) {
  return options.inliers.value_or(options.method.row().inliers);
}

Gravity gravity_used(const InitializeOptions& options) {
  const bool joins = !options.method.row().rotations;
  return options.gravity == Gravity::joint && !joins ? Gravity::after : options.gravity;
}

InertialOptions inertial_options(const InitializeOptions& options) {
  return {.bias_sigma_m_s2 = options.accelerometer_bias_sigma_m_s2};
}

RansacOptions ransac_options(const InitializeOptions& options) {
  RansacOptions ransac;
  ransac.enabled = uses_ransac(options) || !options.method.row().needs_plane;
  ransac.threshold_px = options.ransac_threshold_px;
  ransac.seed = options.seed;
  return ransac;
}

Window window_of(const Tracks& tracks,
                 const Camera& camera,
                 std::span<const std::int64_t> timestamps_ns,
                 const InitializeOptions& options,
                 const std::vector<bool>& on_first_plane) {
  const InlierOptions selection{.ransac = ransac_options(options),
                                .inliers = inliers_used(options),
                                .leader = options.plane - 1,
                                .on_first_plane = on_first_plane};
  Window window = make_window(tracks, camera, timestamps_ns, selection);
  set_readout(camera, tracks, window);
  if (options.method_options.shutter == Shutter::global) window.row_delay = RowDelayPrior{};
  return with_late_rows(window, [&](double row_delay_s) {
    Tracks at_stamps = tracks;
    at_stamps.raw_px = without_readout(window, std::move(at_stamps.raw_px), row_delay_s);
    for (Eigen::Matrix2Xd& raw_px : at_stamps.raw_px)
      for (const int j : window.static_tracks)
        raw_px.col(j).setConstant(std::numeric_limits<double>::quiet_NaN());
    return make_window(at_stamps, camera, timestamps_ns, selection);
  });
}

std::string missing_plane(const Window& window, const InitializeOptions& options) {
  if (window.planes.empty() || options.plane == window.leader + 1) return "";
  return fmt::format("plane {} does not exist: the window has {}",
                     options.plane,
                     counted(window.planes.size(), "plane"));
}

RotationSource first_source(RotationSource requested, bool has_gyroscope) {
  using enum RotationSource;
  if (requested == automatic) return has_gyroscope ? gyro_calibrated : five_point;
  if (requested == raw) return has_gyroscope ? gyro : averaging;
  return requested;
}

ChosenRotations chosen_rotations(const Window& window,
                                 const RotationInputs& inputs,
                                 RotationSource requested,
                                 const std::stop_token& stop) {
  ChosenRotations chosen = rotations_at_stamps(at_time_stamps(window), inputs, requested, stop);
  const auto is_clear = [](const Rotations& r) { return !r.R_wc.empty() && r.R_wc_other.empty(); };
  if (is_clear(chosen.rotations) || window.row_delay) return chosen;
  Window late = window;
  for (const double row_delay_s : likely_row_delays_s(window)) {
    if (chosen.rotations.stopped) break;
    late.selection_row_delay_s = row_delay_s;
    ChosenRotations other = rotations_at_stamps(at_time_stamps(late), inputs, requested, stop);
    const bool best =
        !is_clear(chosen.rotations) || other.rotations.sigma_rad < chosen.rotations.sigma_rad;
    if (other.rotations.stopped || (is_clear(other.rotations) && best)) chosen = std::move(other);
  }
  return chosen;
}

const Gyroscope* WindowRotations::usable(const Gyroscope* given) const {
  if (given == nullptr || !gyroscope_is_usable) return nullptr;
  return corrected ? &*corrected : given;
}

WindowRotations window_rotations(const Window& window,
                                 const RotationInputs& inputs,
                                 RotationSource requested,
                                 const std::stop_token& stop) {
  using enum RotationSource;
  const auto choose = [&](const Gyroscope* gyroscope) {
    return chosen_rotations(window, {gyroscope, inputs.R_wc_true, inputs.seed}, requested, stop);
  };
  const auto without_gyroscope = [&](const std::string& why) -> WindowRotations {
    return {choose(nullptr), std::nullopt, false, "the gyroscope is not used" + why};
  };
  if (inputs.gyroscope == nullptr) return {choose(nullptr)};
  const Gyroscope& gyroscope = *inputs.gyroscope;
  const bool may_do_without = requested == automatic || requested == raw;
  const std::string gap = may_do_without ? why_not_covered_by(gyroscope, window) : "";
  if (!gap.empty()) return without_gyroscope(": " + gap);
  WindowRotations found{choose(&gyroscope)};
  const Rotations& rotations = found.chosen.rotations;
  if (requested != automatic || rotations.R_wc_images.empty()) return found;
  const ImageRotations by_images{window.timestamps_ns, rotations.R_wc_images};
  const GyroscopeCheck check =
      check_gyroscope_against({&by_images, 1}, gyroscope, rotations.sigma_rad);
  if (check.misfit == GyroscopeMisfit::none) return found;
  const std::string sentence = sentence_of(check);
  Gyroscope corrected = gyroscope;
  corrected.time_offset_ns += to_ns(check.late_s.value_or(0));
  if (check.late_s && why_not_covered_by(corrected, window).empty()) {
    found.chosen = choose(&corrected);
    found.corrected = std::move(corrected);
    found.note = fmt::format("the gyroscope does not fit the images: {}, corrected in this window",
                             sentence);
  } else {
    found = without_gyroscope(", it does not fit the images: " + sentence);
  }
  found.misfit = check.misfit;
  found.advice = advice_of(check, gyroscope);
  return found;
}

Window with_rotations(Window window, const Rotations& rotations, const InitializeOptions& options) {
  window.all_tracks = !uses_ransac(options);
  window.rotations = rotations.model;
  window.camera_is_guess = options.camera_is_guess;
  window.gyro = rotations.gyro;
  if (!rotations.R_wc.empty()) window.R_wc = rotations.R_wc;
  return window;
}

MethodRun run_method(Window window,
                     const Rotations& rotations,
                     const Sources& sources,
                     const InitializeOptions& options,
                     const Watch& watch) {
  if (rotations.R_wc.empty()) {
    Initialization result = failed(rotations.reason);
    result.stopped = rotations.stopped;
    return {std::move(window), std::move(result)};
  }
  if (rotations.R_wc_other.empty()) {
    Initialization result = run(window, sources, options, watch);
    return {std::move(window), std::move(result)};
  }
  return run_from_both(std::move(window), rotations, [&](const Window& one) {
    Initialization result = run(one, sources, options, watch);
    add_own_noise(one, sources, options, watch.stop, result);
    return result.ok ? with_uncertainty(options.method.row(), one, std::move(result)) : result;
  });
}

void add_own_noise(const Window& window,
                   const Sources& sources,
                   const InitializeOptions& options,
                   const std::stop_token& stop,
                   Initialization& result) {
  if (result.own_noise) return;  // known since two orientations were compared
  const Watch watch{stop};
  const auto again = [&](const Window& w) { return run(w, sources, options, watch); };
  result.own_noise =
      own_noise(options.method.row(), window, result, again, options.method_options, watch);
}

std::vector<Verdict> growing_numbers(const Window& window, Lens lens, const std::stop_token& stop) {
  std::vector<Verdict> numbers;
  for (GrowthStep& step : grow(window, lens, stop)) numbers.push_back(std::move(step.numbers));
  return numbers;
}

Finished finished(const Window& window,
                  const Sources& sources,
                  const InitializeOptions& options,
                  Evidence known,
                  std::span<const Verdict> growth,
                  Initialization result) {
  const Method& method = options.method.row();
  Finished end;
  Initialization& found = end.initialization;
  found = result.ok ? with_uncertainty(method, window, std::move(result)) : std::move(result);
  Verdict numbers = numbers_for(window, growth, found, options.lens);
  known.window = &window;
  known.numbers = &numbers;
  known.method = &method;
  known.camera_is_guess |= options.camera_is_guess;
  known.lens = options.lens;
  known.result = &found;
  const bool determined =
      found.ok && heaviest(findings_of(known, {Of::length})) < Level::degenerate;
  if (determined && options.gravity != Gravity::off && has_accelerations(sources)) {
    end.poses = uncertain_poses(window, found);
    end.inertial = find_gravity(window, sources, end.poses, options, found);
    known.inertial = &*end.inertial;
    if (end.inertial->joint) numbers = window_numbers(window, found, options.lens);
  }
  if (options.lens == Lens::typical) add_typical_lens(found);
  end.findings = findings_of(
      known, {Of::recording, Of::window, Of::length, Of::result}, options.ignore_findings);
  found = judged(verdict_of(end.findings, known), std::move(found));
  if (!found.ok) end.inertial.reset();
  return end;
}

}  // namespace gpo
