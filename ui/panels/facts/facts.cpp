// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/facts.h"

#include "engine/evaluation/evaluation.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/plane_names.h"
#include "engine/methods/methods.h"
#include "engine/recording/board/board.h"
#include "engine/recording/layouts/camera_source.h"
#include "engine/window/timestamps.h"
#include "ui/look/numbers.h"
#include "ui/panels/facts/result_row.h"
#include "ui/panels/facts/uncertainty_facts.h"
#include "ui/views/image/image_view.h"

#include <algorithm>
#include <optional>
#include <span>

#include <fmt/format.h>

namespace gpo {

namespace {

void add_meters(ResultGroup& group, const Inspection& inspection, double scale, double cube_side) {
  const double percent = 100 * inspection.inertial->log_scale_sigma;
  group.rows.push_back(
      {"Scale",
       "\u00b1" + number_text(percent, 1) + " %",
       inspection.metric_scale_from
           ? fmt::format("from frame {} on", inspection.window->start + *inspection.metric_scale_from)
           : "",
       "One standard deviation of all lengths in meters, from poses and "
       "accelerometer together; and from which frame on these tell them (20 %)"});
  group.rows.push_back({"Plane",
                        length_text(scale * inspection.initialization->plane.distance),
                        "away",
                        "Distance of the reference camera from the leading plane, by the "
                        "accelerometer"});
  if (inspection.cube)
    group.rows.push_back(
        {"Cube", length_text(scale * cube_side), "a side", "Side of the virtual cube"});
}

void add_planes(ResultGroup& group, const Inspection& inspection) {
  const int count = std::max(1, static_cast<int>(inspection.window->planes.size()));
  for (int k = 0; k < count; ++k) {
    const auto name = plane_name(inspection, k);
    if (!name) continue;
    group.rows.push_back(
        {fmt::format("Plane {}", k + 1),
         name->name,
         fmt::format("{} \u00b1{}", angle_text(name->tilt_deg), angle_text(name->sigma_deg)),
         "What the plane is to gravity: the angle of its normal from up, with one "
         "standard deviation (0\u00b0 floor or table, 90\u00b0 wall, 180\u00b0 "
         "ceiling). The floor is the lowest level plane, whatever it is"});
  }
}

/// What the accelerometer says: which way is up, how large a unit is, and what the planes are to
/// gravity. Without rows where nobody asked, or there is no accelerometer.
ResultGroup gravity_group(const Inspection& inspection, double cube_side) {
  ResultGroup group{"GRAVITY AND METERS", {}};
  if (!inspection.inertial) return group;
  const InertialAlignment& inertial = *inspection.inertial;
  if (!inertial.ok) {
    group.rows.push_back(dash("Up", "Not known: " + inertial.reason));
    return group;
  }
  group.rows.push_back({"Up",
                        "\u00b1" + angle_text(inertial.gravity_sigma_deg),
                        "",
                        "One standard deviation of gravity's direction"});
  if (const auto scale = known_scale(inspection))
    add_meters(group, inspection, *scale, cube_side);
  else
    group.rows.push_back(dash("Scale", "Not known: " + inertial.scale_reason));
  add_planes(group, inspection);
  return group;
}

std::string why_no_metric(const Inspection& inspection) {
  if (!inspection.truth) return "Not known: the recording has no ground truth";
  if (!inspection.initialization->ok) return "Not known: the initialization failed";
  return "Not known: the ground truth does not cover the reference frame or the plane";
}

std::string why_no_alignment(const Inspection& inspection) {
  if (inspection.evaluation && inspection.evaluation->alignment == Alignment::point) {
    return "Not known: the true camera path is a point, so nothing fixes the scale";
  }
  if (inspection.evaluation && inspection.evaluation->alignment == Alignment::line) {
    return "Not known: the true camera path is a line, so nothing fixes the rotation about it";
  }
  return why_no_metric(inspection);
}

ResultRow metric(std::string label,
                 const std::optional<double>& value,
                 std::string (*text)(double),
                 std::string meaning,
                 std::string why_not) {
  if (!value) return dash(std::move(label), std::move(why_not));
  return {std::move(label), text(*value), "", std::move(meaning)};
}

/// How sure a truth from the board is; nothing where it is from a file.
std::optional<ResultRow> truth_row(const Inspection& inspection) {
  if (!inspection.truth) return std::nullopt;
  const auto uncertainty = median_uncertainty(inspection.truth->uncertainties);
  if (!uncertainty) return std::nullopt;
  return ResultRow{"Truth",
                   "\u00b1" + angle_text(uncertainty->normal_sigma_deg),
                   "normal",
                   "The truth is from the board, certain to " + uncertainty_text(*uncertainty) +
                       ". Of errors in the calibration this knows nothing"};
}

ResultGroup metrics_group(const Inspection& inspection) {
  const Evaluation e = inspection.evaluation.value_or(Evaluation{});
  const std::string why = why_no_metric(inspection);
  const std::string why_unaligned = why_no_alignment(inspection);
  ResultRow pne = metric("PNE",
                         e.pne_deg,
                         angle_text,
                         "Plane normal error: angle to the true normal, in the reference camera",
                         why);
  if (e.pne_deg && e.pne_bound_deg) {
    pne.note = "bound " + angle_text(*e.pne_bound_deg);
    pne.tooltip += ". The Cramer-Rao bound says how small it can be with these tracks";
  }
  ResultGroup group{
      "AGAINST THE TRUTH",
      {pne,
       metric("PNE aligned",
              e.pne_aligned_deg,
              angle_text,
              "Plane normal error after aligning the camera paths, the paper's way",
              why_unaligned),
       metric("PDE",
              e.pde_m,
              length_text,
              "Plane distance error, from the reference camera, in the scale of the alignment",
              why_unaligned),
       metric("ATE",
              e.ate_m,
              length_text,
              "Absolute trajectory error: root mean square distance of the aligned camera "
              "centers to the true ones",
              why_unaligned)}};
  if (e.scale_error_percent)
    group.rows.push_back({"Scale error",
                          fmt::format("{:+.1f} %", *e.scale_error_percent),
                          "",
                          "The accelerometer's meters over the true ones, less one"});
  if (e.gravity_error_deg)
    group.rows.push_back({"Up error",
                          angle_text(*e.gravity_error_deg),
                          "",
                          "Angle of gravity, as the accelerometer tells it, to the true vertical"});
  if (const auto row = truth_row(inspection)) group.rows.push_back(*row);
  return group;
}

ResultGroup result_group(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  const Window& window = *inspection.window;
  ResultGroup group{"RESULT", {}};
  group.rows.push_back({"Status",
                        result.ok ? "ok" : "failed",
                        "",
                        result.ok ? "The window could be initialized" : result.reason,
                        result.ok ? Tone::good : Tone::bad});
  group.rows.push_back({"Inliers",
                        fmt::format("{} / {}", window.inlier_count(0), window.track_count()),
                        inliers_note(inspection),
                        "Tracks that agree with the plane's homographies, of all"});
  const std::string no_solution = "Not known: the initialization failed";
  if (result.ok) {
    group.rows.push_back({"RMS",
                          number_text(result.rms_px, 2) + " px",
                          "",
                          "Root mean square reprojection error of the inliers"});
  } else {
    group.rows.push_back(dash("RMS", no_solution));
  }
  if (result.solver.iterations > 0) {
    group.rows.push_back({"Iterations",
                          std::to_string(result.solver.iterations),
                          result.solver.termination == Termination::convergence ? "converged" : "",
                          fmt::format("{} unknowns, {} residuals, cost {:.4g} to {:.4g} px\u00b2",
                                      result.solver.unknowns,
                                      result.solver.residuals,
                                      result.solver.initial_cost,
                                      result.solver.final_cost)});
  } else {
    group.rows.push_back(dash("Iterations", "The solver was not run"));
  }
  return group;
}

ResultGroup timing_group(const Timing& timing, bool known) {
  ResultGroup group{"TIME", {}};
  const auto add = [&](const char* label, double ms, const char* meaning) {
    if (!known) {
      group.rows.push_back(
          dash(label, "Timings are left out of pictures, so that pictures can be compared"));
    } else {
      group.rows.push_back({label, milliseconds_text(ms), "", meaning});
    }
  };
  add("Track", timing.track, "Detecting corners and following them");
  add("RANSAC", timing.ransac, "Homographies from the reference frame, outliers rejected");
  add("Rotations", timing.rotations, "From the gyroscope, averaging or truth");
  add("Initialize", timing.initialize, "The method, with checks and map points");
  add("Solver", timing.optimize, "The solver's share of initialize");
  add("Total", timing.total, "All stages, each when it was last computed");
  return group;
}

ResultGroup nothing(std::string title, std::vector<std::string> labels) {
  ResultGroup group{std::move(title), {}};
  for (std::string& label : labels) {
    group.rows.push_back(dash(std::move(label), "Not known: nothing has been computed yet"));
  }
  return group;
}

/// Of the first time stamps: it is drawn anew with every frame of the window, and a long recording
/// has a hundred thousand.
double rate_at_start_hz(std::span<const std::int64_t> timestamps_ns) {
  constexpr std::size_t kEnough = 200;
  return rate_hz(timestamps_ns.first(std::min(timestamps_ns.size(), kEnough)));
}

}  // namespace

std::vector<std::string> recording_facts(const Recording& recording) {
  std::vector<std::string> facts = {
      recording.name,
      fmt::format("{}\u00d7{}", recording.camera.width, recording.camera.height),
      fmt::format("{} frames", recording.frame_count())};
  const double frames_hz = rate_at_start_hz(recording.timestamps_ns);
  if (frames_hz > 0) facts.back() += fmt::format(" at {:.3g} Hz", frames_hz);
  facts.push_back(
      recording.gyroscope
          ? fmt::format("gyro {:.3g} Hz", rate_at_start_hz(recording.gyroscope->timestamps_ns))
          : "no gyro");
  facts.push_back(recording.truth   ? "truth"
                  : recording.board ? "truth from the board"
                                    : "no truth");
  if (recording.camera_source == CameraSource::guess) facts.emplace_back("camera: a guess");
  if (recording.camera_source == CameraSource::self_calibrated)
    facts.emplace_back("camera: self-calibrated");
  return facts;
}

std::vector<ResultGroup> result_groups(const Inspection* inspection,
                                       bool timings,
                                       double chosen_side) {
  if (!inspection || !inspection->initialization || !inspection->window) {
    return {nothing(kVerdictTitle, {"Rotation alone", "Moved"}),
            nothing("RESULT", {"Status", "Inliers", "RMS", "Iterations"}),
            nothing("AGAINST THE TRUTH", {"PNE", "PNE aligned", "PDE", "ATE"}),
            nothing("UNCERTAINTY",
                    {"Normal", "Distance ratio", "Bound, known rotations", "Bound, unknown bias"}),
            nothing("TIME", {"Track", "RANSAC", "Rotations", "Initialize", "Solver", "Total"})};
  }
  const double side = cube_side(*inspection, chosen_side);
  std::vector<ResultGroup> groups{verdict_group(*inspection),
                                  result_group(*inspection),
                                  metrics_group(*inspection),
                                  uncertainty_group(*inspection),
                                  gravity_group(*inspection, side),
                                  timing_group(inspection->timing, timings)};
  std::erase_if(groups, [](const ResultGroup& group) { return group.rows.empty(); });
  return groups;
}

}  // namespace gpo
