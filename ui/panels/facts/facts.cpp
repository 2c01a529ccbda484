// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/facts.h"

#include "engine/evaluation/evaluation.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/board/board.h"
#include "ui/views/image/image_view.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

struct Stage {
  const char* label;
  double Timing::*ms;
  const char* meaning;
};
constexpr Stage kStages[] = {
    {"Track", &Timing::track, "Detection and tracking of corners"},
    {"RANSAC", &Timing::ransac, "Homographies from the reference frame, and outlier rejection"},
    {"Rotations", &Timing::rotations, "Rotations from gyroscope, averaging or ground truth"},
    {"Initialize", &Timing::initialize, "The method, with its checks and the map points"},
    {"Solver", &Timing::optimize, "The solver's share of Initialize"},
    {"Total", &Timing::total, "All stages, each when it was last computed"}};

std::string why_no_metric(const Inspection& inspection, bool needs_alignment) {
  const auto& evaluation = inspection.evaluation;
  if (!inspection.truth) return "Unknown: the recording has no ground truth";
  if (!evaluation) return "Unknown: the initialization failed";
  if (const auto& convention = inspection.truth_convention)
    return "Unknown: " + sentence_of(*convention);
  if (evaluation->plane != inspection.window->leader)
    return "Unknown: the ground truth describes another plane";
  if (needs_alignment && evaluation->alignment == Alignment::point)
    return "Unknown: the true camera path is a point and does not determine the scale";
  if (needs_alignment && evaluation->alignment == Alignment::line)
    return "Unknown: the true camera path is a line and does not determine the rotation about it";
  return "Unknown: the ground truth does not cover the reference frame or the plane";
}

/// Returns the uncertainty of ground truth from a board; nullopt for any other ground truth.
std::optional<ResultRow> truth_row(const Inspection& inspection) {
  if (!inspection.truth) return std::nullopt;
  const auto uncertainty = median_uncertainty(inspection.truth->uncertainties);
  if (!uncertainty) return std::nullopt;
  const std::string note = board_truth_note(inspection);
  const bool estimated = inspection.truth->estimated_readout.has_value();
  std::string tooltip = "Uncertainty of the ground truth from the board (1 sigma): " +
                        uncertainty_text(*uncertainty) + ". Calibration errors are not included";
  if (!note.empty()) tooltip += (estimated ? "; " : ", nor those of the rolling shutter: ") + note;
  return ResultRow{.label = "Truth",
                   .value = sigma_text(uncertainty->normal_sigma_deg),
                   .note = note.empty() ? "normal"
                           : estimated  ? "readout estimated"
                                        : "readout unknown",
                   .tooltip = std::move(tooltip)};
}

ResultGroup metrics_group(const Inspection& inspection) {
  const Evaluation e = inspection.evaluation.value_or(Evaluation{});
  ResultGroup group{"ERROR AGAINST GROUND TRUTH", {}};
  const Role color = is_contradiction(e) ? Role::bad : Role::text;
  for (const ComparedColumn& metric : metrics()) {
    const auto& value = e.*metric.evaluated;
    const bool needs_alignment =
        metric.evaluated != &Evaluation::pne_deg && metric.evaluated != &Evaluation::path_error_m;
    group.rows.push_back(
        value ? ResultRow{metric.title, metric.text(*value), "", metric.meaning, color}
              : dash(metric.title, why_no_metric(inspection, needs_alignment)));
    if (metric.evaluated == &Evaluation::path_error_m && e.path_error_percent)
      group.rows.back().note = number_text(*e.path_error_percent, 1) + " % of the path";
  }
  if (e.pne_deg && e.pne_bound_deg) {
    group.rows[0].note = "bound " + angle_text(*e.pne_bound_deg);
    group.rows[0].tooltip +=
        ". The Cram\u00e9r-Rao bound is the smallest error to expect with these tracks";
  }
  if (e.scale_error_percent)
    group.rows.push_back(
        {.label = "Scale error",
         .value = fmt::format("{:+.1f} %", without_negative_zero(*e.scale_error_percent, 1)),
         .tooltip = "Relative error of the metric scale"});
  if (e.gravity_error_deg)
    group.rows.push_back({.label = "Up error",
                          .value = angle_text(*e.gravity_error_deg),
                          .tooltip = "Angle between estimated gravity and the true vertical"});
  if (const auto row = truth_row(inspection)) group.rows.push_back(*row);
  return group;
}

constexpr const char* kTransferRms = "Transfer RMS";

ResultRow rms_row(const Initialization& result) {
  if (!result.transfer_rms_px) return dash(kTransferRms, "Unknown: the initialization failed");
  ResultRow row{.label = kTransferRms,
                .value = number_text(*result.transfer_rms_px, 2) + " px",
                .tooltip =
                    "RMS of the inliers' residuals of the solution: distances from their "
                    "reference positions, transferred by plane and cameras"};
  if (!result.reprojection_rms_px) return row;
  row.note = "reproj. " + number_text(*result.reprojection_rms_px, 2) + " px";
  row.tooltip += ". Reprojection RMS: the same from the projected map points";
  return row;
}

int used_tracks(const Inspection& inspection) {
  const Settings& settings = inspection.settings;
  const Window& window = *inspection.window;
  int used = window.track_count() -
             static_cast<int>(settings.exclude.size() + window.static_tracks.size());
  if (settings.mask.areas.empty()) return used;
  for (const std::int64_t id : left_out(*inspection.tracks, settings.mask))
    used -= std::ranges::binary_search(settings.exclude, id) ? 0 : 1;
  return used;
}

ResultGroup result_group(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  const Window& window = *inspection.window;
  const SolverReport& solver = result.solver;
  ResultGroup group{
      "RESULT",
      {{.label = "Inliers",
        .value = fmt::format("{} / {}", window.inlier_count(0), used_tracks(inspection)),
        .note = inliers_note(inspection),
        .tooltip = "Tracks that agree with the homographies of the plane, and all tracks that are "
                   "not excluded. The last frame does not see the lost ones, which may be inliers "
                   "before"}}};
  group.rows.push_back(rms_row(result));
  group.rows.push_back(
      solver.iterations > 0
          ? ResultRow{.label = "Iterations",
                      .value = iterations_text(solver),
                      .note = solver.termination == Termination::convergence ? "converged" : "",
                      .tooltip = fmt::format(
                          "Iterations of the solver, \"42 of 110\" if the others belong "
                          "to discarded attempts; {} unknowns, {} residuals, cost "
                          "{:.4g} to {:.4g} px\u00b2",
                          solver.unknowns,
                          solver.residuals,
                          solver.initial_cost,
                          solver.final_cost)}
          : dash("Iterations", "The solver was not run"));
  return group;
}

ResultGroup timing_group(const Timing& timing, bool timings) {
  ResultGroup group{kTimeTitle, {}};
  for (const Stage& stage : kStages) {
    ResultRow row{stage.label, milliseconds_text(timing.*stage.ms), "", stage.meaning};
    group.rows.push_back(timings ? std::move(row) : dash(stage.label, kNoTimes));
  }
  return group;
}

const char* rotations_note(RotationModel model) {
  if (model == RotationModel::known) return "rotations fixed";
  return model == RotationModel::bias ? "gyro bias unknown" : "rotations unknown";
}

ResultRow normal_row(const Uncertainty& uncertainty) {
  ResultRow row{
      .label = "Normal",
      .value = sigma_text(uncertainty.normal_sigma_deg),
      .note = uncertainty.own ? rotations_note(uncertainty.rotations) : "of the window",
      .tooltip = fmt::format("Normal uncertainty (1 sigma, first order) for noise of {} px in each "
                             "coordinate. Unknown rotations are taken into account{}",
                             number_text(uncertainty.sigma_px, 2),
                             uncertainty.own ? ""
                                             : ". It is the window's: this method's own is "
                                               "not computed")};
  if (!uncertainty.typical_lens_sigma_deg) return row;
  const std::string typical = sigma_text(*uncertainty.typical_lens_sigma_deg);
  row.tooltip += fmt::format(
      " ({}). The calibration states no uncertainty: {} if the lens is exact, {} with a typical "
      "calibration",
      row.note,
      row.value,
      typical);
  row.note = "lens exact, " + typical + " typical";
  return row;
}

ResultRow distance_row(const Initialization& result) {
  const double ratio =
      plane_in_camera(result.plane, result.cameras.back()).distance / result.plane.distance;
  return {.label = "Distance ratio",
          .value = uncertain_text(ratio, result.uncertainty->distance_ratio_sigmas.back()),
          .note = "last / first",
          .tooltip =
              "Plane distance of the window's last camera over that of its first camera, "
              "with its standard deviation"};
}

ResultRow bias_row(const Initialization& result, int axis) {
  const double bias = (*result.bias_rad_s)[axis];
  const auto& uncertainty = result.uncertainty;
  return {
      .label = std::string("Bias ") + "xyz"[axis],
      .value = (uncertainty && uncertainty->bias_covariance
                    ? uncertain_text(bias, std::sqrt((*uncertainty->bias_covariance)(axis, axis)))
                    : fmt::format("{:.4f}", bias)) +
               " rad/s",
      .tooltip = "Estimated gyroscope bias, with its standard deviation if known"};
}

ResultRow bound_row(const char* label,
                    const std::optional<double>& bound_deg,
                    const char* condition,
                    const std::string& why_not) {
  if (!bound_deg) return dash(label, why_not);
  return {.label = label,
          .value = angle_text(*bound_deg),
          .tooltip = std::string("Cram\u00e9r-Rao bound of the normal in degrees: the smallest "
                                 "uncertainty of an unbiased method with these tracks and this "
                                 "noise, ") +
                     condition};
}

/// Returns what the verdict is based on, except for the normal uncertainty beside its badge.
ResultGroup verdict_group(const Inspection& inspection) {
  const Verdict verdict = inspection.initialization->verdict.value_or(Verdict{});
  const std::string why = "Unknown: it could not be computed for this window";
  ResultGroup group{kMotionTitle, {dash("Rotation alone", why), dash("Baseline |t|", why)}};
  if (verdict.rotation_rms_px)
    group.rows[0] = {
        .label = "Rotation alone",
        .value = number_text(*verdict.rotation_rms_px, 2) + " px",
        .note = verdict.noise_px ? "noise " + number_text(*verdict.noise_px, 2) + " px" : "",
        .tooltip =
            "RMS error [px] that the best rotations leave without any translation. If it is "
            "not larger than the noise, there is no parallax"};
  if (verdict.largest_translation)
    group.rows[1] = {.label = "Baseline |t|",
                     .value = number_text(*verdict.largest_translation, 3) + " d",
                     .tooltip = "Largest distance to the reference camera, in plane distances d"};
  return group;
}

ResultGroup uncertainty_group(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  const std::string why = result.ok ? "Unknown: it could not be determined for this result"
                                    : "Unknown: the initialization failed";
  const Uncertainty u = result.uncertainty.value_or(Uncertainty{});
  const bool distances = !u.distance_ratio_sigmas.empty() && !result.cameras.empty();
  ResultGroup group{"UNCERTAINTY",
                    {result.uncertainty ? normal_row(u) : dash("Normal", why),
                     distances ? distance_row(result) : dash("Distance ratio", why)}};
  for (int axis = 0; result.bias_rad_s && axis < 3; ++axis)
    group.rows.push_back(bias_row(result, axis));
  if (result.time_offset_s)
    group.rows.push_back(
        {.label = "Time offset",
         .value =
             u.time_offset_sigma_s
                 ? uncertain_text(1e3 * *result.time_offset_s, 1e3 * *u.time_offset_sigma_s) + " ms"
                 : milliseconds_text(1e3 * *result.time_offset_s),
         .tooltip = fmt::format("Estimated offset, with its standard deviation: gyroscope time = "
                                "camera time + offset. It differs by {:+.2f} ms from the recorded "
                                "one",
                                1e3 * result.time_offset_correction_s.value_or(0))});
  group.rows.push_back(
      bound_row("Bound, known R", u.bound_known_rotations_deg, "if the rotations are exact", why));
  group.rows.push_back(
      bound_row("Bound, free bias",
                u.bound_unknown_bias_deg,
                "if a constant bias and the clock of the gyroscope are estimated, too",
                result.uncertainty ? "Unknown: it needs rotations from a gyroscope" : why));
  return group;
}

ResultRow up_row(const InertialAlignment& inertial) {
  if (!inertial.ok) return dash("Up", "Unknown: " + inertial.reason);
  return {.label = "Up",
          .value = sigma_text(inertial.gravity_sigma_deg),
          .tooltip = "Standard deviation of the direction of gravity"};
}

/// Texts for the sources of the scale.
constexpr const char* kScaleMeanings[] = {
    "Standard deviation by the length between two points (0.5 px each) and by the planes",
    "The imported result is metric: its own unit is the scale",
    "Standard deviation by poses and accelerometer, and the frame from which on it is below 20 %"};

void add_metric_rows(ResultGroup& group, const Inspection& inspection, double cube_side) {
  const auto scale = known_scale(inspection);
  const auto& measured = inspection.measured_scale;
  if (!scale)
    return group.rows.push_back(dash(
        "Scale", "Unknown: " + (measured ? measured->reason : inspection.inertial->scale_reason)));
  const auto sigma = scale_log_sigma(inspection);
  const ScaleSource source = scale_source(inspection);
  const int start = inspection.window->start;
  const auto& from = inspection.metric_scale_from;
  group.rows.push_back({.label = "Scale",
                        .value = sigma ? "\u00b1" + number_text(100 * *sigma, 1) + " %" : "known",
                        .note = source == ScaleSource::points   ? "two points"
                                : source == ScaleSource::result ? "the result's unit"
                                : from ? fmt::format("from frame {} on", start + *from)
                                       : "",
                        .tooltip = kScaleMeanings[static_cast<std::size_t>(source)]});
  group.rows.push_back({.label = "Plane distance",
                        .value = length_text(*scale * inspection.initialization->plane.distance),
                        .tooltip = "Distance between the reference camera and the leading plane, "
                                   "in meters"});
  if (inspection.cube)
    group.rows.push_back({.label = "Cube side",
                          .value = length_text(*scale * cube_side),
                          .tooltip = "Side of the virtual cubes, in meters"});
}

/// Returns gravity and the metric scale, with the planes' tilts if gravity is known; the side of
/// the cubes is in plane distances.
ResultGroup gravity_group(const Inspection& inspection, double cube_side) {
  ResultGroup group{"GRAVITY AND METRIC SCALE", {}};
  if (const Finding* misfit = find_finding(inspection.findings, "gyroscope-misfit"))
    group.rows.push_back(dash("Gyroscope", text_of(*misfit)));
  if (inspection.inertial) group.rows.push_back(up_row(*inspection.inertial));
  const bool gravity = inspection.inertial && inspection.inertial->ok;
  const bool scaled = scale_source(inspection) != ScaleSource::accelerometer;
  if (gravity || (scaled && inspection.initialization->ok))
    add_metric_rows(group, inspection, cube_side);
  if (!gravity) return group;
  const int planes = std::max(1, static_cast<int>(inspection.window->planes.size()));
  for (int k = 0; k < planes; ++k)
    if (const auto name = plane_name(inspection, k))
      group.rows.push_back(
          {.label = fmt::format("Plane {}", k + 1),
           .value = name->name,
           .note =
               name->sigma_deg
                   ? fmt::format("{} {}", angle_text(name->tilt_deg), sigma_text(*name->sigma_deg))
                   : angle_text(name->tilt_deg),
           .tooltip = "Angle between the plane's normal and up, with its standard deviation: "
                      "0\u00b0 floor or table, 90\u00b0 wall, 180\u00b0 ceiling. The lowest level "
                      "plane is called the floor"});
  return group;
}

}  // namespace

NormalSigma shown_normal_sigma(const Initialization& result) {
  if (!result.verdict || !result.verdict->normal_sigma_deg) return {};
  const std::string sigma = sigma_text(*result.verdict->normal_sigma_deg);
  const Readiness readiness = result.verdict->readiness;
  const bool answers = readiness == Readiness::ready || readiness == Readiness::weak;
  if (result.ok && answers) return {sigma, true};
  return {"window: normal " + sigma, false};
}

std::string iterations_text(const SolverReport& solver) {
  const int shown = std::max(0, static_cast<int>(solver.trace.size()) - 1);
  if (shown == 0 || shown + 1 >= solver.iterations) return std::to_string(solver.iterations);
  return fmt::format("{} of {}", shown, solver.iterations);
}

bool has_values(const ResultGroup& group) {
  return std::ranges::any_of(group.rows,
                             [](const ResultRow& row) { return row.value != "\u2013"; });
}

std::string why_no_values(const ResultGroup& group) {
  const bool alike = std::ranges::all_of(
      group.rows, [&](const ResultRow& row) { return row.tooltip == group.rows.front().tooltip; });
  std::string text = group.title + ": ";
  if (alike) return text + group.rows.front().tooltip;
  for (const ResultRow& row : group.rows) text += "\n  " + row.label + ": " + row.tooltip;
  return text;
}

std::pair<std::string, std::string> value_and_uncertainty(const std::string& value) {
  const std::size_t sign = value.find("\u00b1");
  if (sign == std::string::npos) return {value, ""};
  return {sign == 0 ? "" : value.substr(0, sign - 1), value.substr(sign)};
}

std::vector<ResultGroup> result_groups(const Inspection* inspection, bool timings, double side) {
  if (!inspection || !inspection->initialization || !inspection->window) {
    std::vector<ResultGroup> unknown;
    for (const char* title :
         {"ERROR AGAINST GROUND TRUTH", "RESULT", kMotionTitle, "UNCERTAINTY", kTimeTitle})
      unknown.push_back({title, {dash("", "Unknown: nothing has been computed yet")}});
    return unknown;
  }
  // The most important rows come first: a window of 1280x720 shows no others without scrolling.
  std::vector<ResultGroup> groups{metrics_group(*inspection),
                                  result_group(*inspection),
                                  verdict_group(*inspection),
                                  uncertainty_group(*inspection),
                                  gravity_group(*inspection, cube_side(*inspection, side)),
                                  timing_group(inspection->timing, timings)};
  std::erase_if(groups, [](const ResultGroup& group) { return group.rows.empty(); });
  return groups;
}

}  // namespace gpo
