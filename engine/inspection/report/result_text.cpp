// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/geometry/statistics.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"
#include "engine/recording/board/board.h"
#include "engine/recording/layouts/write_recording.h"
#include "engine/window/window.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

std::string row(const char* name, const std::string& value) {
  return fmt::format("{:<12}{}\n", name, value);
}

template <class... Values>
std::string row(const char* name, fmt::format_string<Values...> format, Values&&... values) {
  return row(name, fmt::format(format, std::forward<Values>(values)...));
}

std::string with_unit(const std::optional<double>& value,
                      double factor,
                      int digits,
                      const char* unit) {
  return value ? fmt::format(
                     "{:.{}f} {}", without_negative_zero(*value * factor, digits), digits, unit)
               : "-";
}

std::string rotations_text(const Inspection& inspection) {
  const char* source = to_string(inspection.rotations_used);
  if (!inspection.gyroscope_bias_rad_s) {
    if (inspection.rotations_note.empty()) return source;
    return fmt::format("{} ({})", source, inspection.rotations_note);
  }
  return fmt::format("{} (bias {:.4f} rad/s: {})",
                     source,
                     fmt::join(*inspection.gyroscope_bias_rad_s, " "),
                     inspection.rotations_used == RotationSource::gyro
                         ? inspection.recording->gyroscope->bias_source
                         : "estimated from the window");
}

/// Beyond a right angle, and if it is not a number, a standard deviation of a direction means
/// nothing.
std::string sigma_text(double sigma_deg, int digits) {
  return sigma_deg <= 90 ? fmt::format("{:.{}f} deg", sigma_deg, digits) : "undetermined";
}

std::string normal_text(const Uncertainty& u, CameraSource source) {
  const char* rotations = to_string(u.rotations);
  const char* one_sigma = u.own ? "1 sigma" : "1 sigma of the window, not of the method";
  const bool guess = source == CameraSource::guess;
  if (u.typical_lens_sigma_deg)
    return fmt::format("normal {} (lens exact), {} ({}); {}, rotations {}",
                       sigma_text(u.normal_sigma_deg, 3),
                       sigma_text(*u.typical_lens_sigma_deg, 3),
                       guess ? "lens a guess" : "typical calibration",
                       one_sigma,
                       rotations);
  return fmt::format(
      "normal {} ({}; rotations {}, lens {})",
      sigma_text(u.normal_sigma_deg, 3),
      one_sigma,
      rotations,
      u.lens_sigma_deg.value_or(0) > 0 ? sigma_text(*u.lens_sigma_deg, 3) + " of it" : "exact");
}

std::string verdict_text(const Verdict& verdict) {
  const std::string word = to_string(verdict.readiness);
  return row("verdict",
             verdict.reason.starts_with(word) ? verdict.reason : word + ": " + verdict.reason);
}

/// Returns the findings that lower the verdict, with their keys.
std::string findings_text(const Verdict& verdict, std::span<const Finding> findings) {
  std::string text;
  for (const Finding& finding : findings) {
    if (finding.level == Level::note) continue;
    const std::string sentence = text_of(finding);
    text += row("finding",
                "{}: {} ({}{}{})",
                to_string(finding.level),
                sentence == verdict.reason ? "as the verdict says" : sentence,
                finding.key,
                finding.command.empty() ? "" : "; script: ",
                finding.command);
  }
  return text;
}

std::string uncertainty_text(const Initialization& result, CameraSource source) {
  std::string text;
  if (result.uncertainty) text += row("uncertainty", normal_text(*result.uncertainty, source));
  if (result.bias_rad_s) text += row("bias", "{:.5f} rad/s", fmt::join(*result.bias_rad_s, " "));
  const Uncertainty u = result.uncertainty.value_or(Uncertainty{});
  const auto sigma = [](double factor, std::optional<double> value) {
    return value ? fmt::format(" +- {:.2f}", factor * *value) : "";
  };
  if (result.time_offset_s)
    text += row("time offset",
                "{:.2f}{} ms ({:+.2f} ms to the recorded one)",
                1e3 * *result.time_offset_s,
                sigma(1e3, u.time_offset_sigma_s),
                1e3 * result.time_offset_correction_s.value_or(0));
  if (result.row_delay_s)
    text += row("shutter",
                "rolling, row delay {:.2f}{} us",
                1e6 * *result.row_delay_s,
                sigma(1e6, u.row_delay_sigma_s));
  return text;
}

std::string planes_text(const Inspection& inspection) {
  std::string text;
  for (int k = 0; k < std::max<int>(1, static_cast<int>(inspection.window->planes.size())); ++k) {
    const auto name = plane_name(inspection, k);
    if (!name) continue;
    const auto sigma = name->sigma_deg ? fmt::format(" +- {:.1f}", *name->sigma_deg) : "";
    text += fmt::format("{}{} {} ({:.1f}{} deg from up)",
                        text.empty() ? "" : ", ",
                        k + 1,
                        name->name,
                        name->tilt_deg,
                        sigma);
  }
  return text.empty() ? "" : row("planes", text);
}

std::string inertial_text(const Inspection& inspection) {
  const std::optional<InertialAlignment>& inertial = inspection.inertial;
  const Plane& plane = inspection.initialization->plane;
  if (!inertial) return "";
  if (!inertial->ok) return row("gravity", "not found: " + inertial->reason);
  const auto& at = inspection.metric_scale_from;
  const std::string since =
      at ? fmt::format(", known from frame {} on", inspection.window->start + *at) : "";
  const Eigen::Vector3d down = inertial->gravity_m_s2.normalized();
  return row("gravity",
             "{:.4f} +- {}  (down, reference camera{})",
             fmt::join(down, " "),
             sigma_text(inertial->gravity_sigma_deg, 2),
             inertial->joint ? "; together with the planes" : "") +
         (scale_source(inspection) != ScaleSource::accelerometer ? ""
          : inertial->scale_known                                ? row("scale",
                                        "+- {:.1f} %; the plane is {:.3f} m away{}",
                                        100 * inertial->log_scale_sigma,
                                        inertial->scale * plane.distance,
                                        since)
                                  : row("scale", inertial->scale_reason)) +
         planes_text(inspection);
}

/// Rows of the scale that two points or an imported result determine, and of the chosen world.
std::string chosen_text(const Inspection& inspection) {
  std::string text;
  if (scale_source(inspection) == ScaleSource::result)
    text += row("scale",
                "by the unit of the result; the plane is {:.3f} m away",
                *known_scale(inspection) * inspection.initialization->plane.distance);
  if (const auto& scale = inspection.measured_scale) {
    const double meters = scale->meters_per_unit * inspection.initialization->plane.distance;
    const std::string sigma =
        scale->log_sigma ? fmt::format("+- {:.1f} %", 100 * *scale->log_sigma) : "unknown sigma";
    text += row("scale",
                scale->reason.empty()
                    ? fmt::format("{} by two points; the plane is {:.3f} m away", sigma, meters)
                    : scale->reason);
  }
  if (const auto& world = inspection.chosen_world; world && world->reason.empty()) {
    const auto known = known_scale(inspection);  // the unit of the JSON
    const Eigen::Vector3d camera = known.value_or(1) * world->T_world_reference.p_wc;
    text += row("world",
                "reference camera at {:.4f}  ({})",
                fmt::join(camera, " "),
                known ? "meters" : "plane distances");
  }
  return text;
}

std::string metrics_text(const Evaluation& e) {
  const char* alignment = e.alignment == Alignment::ok ? "ok"
                          : e.alignment == Alignment::line
                              ? "degenerate (the true path is a line)"
                              : "degenerate (the true path is a point)";
  return row("alignment", alignment) + row("ATE", with_unit(e.ate_m, 1e3, 2, "mm")) +
         row("PNE",
             "{}  (bound {}, after alignment {})",
             with_unit(e.pne_deg, 1, 3, "deg"),
             with_unit(e.pne_bound_deg, 1, 3, "deg"),
             with_unit(e.pne_aligned_deg, 1, 3, "deg")) +
         row("PDE", with_unit(e.pde_m, 1e3, 2, "mm")) +
         row("path error",
             "{}  ({} of the path, without alignment; scale ratio {})",
             with_unit(e.path_error_m, 1e3, 2, "mm"),
             with_unit(e.path_error_percent, 1, 2, "%"),
             e.scale_ratio ? fmt::format("{:.4f}", *e.scale_ratio) : "-") +
         (e.scale_error_percent ? row("scale error", with_unit(e.scale_error_percent, 1, 2, "%"))
                                : "") +
         (e.gravity_error_deg ? row("up error", with_unit(e.gravity_error_deg, 1, 2, "deg")) : "");
}

std::string truth_text(const WindowTruth& truth) {
  std::string text = truth.source;
  if (const auto uncertainty = median_uncertainty(truth.uncertainties))
    text += ", uncertainty " + uncertainty_text(*uncertainty);
  return row("truth", text);
}

std::string camera_row(const Recording& recording) {
  const CameraSource source = recording.camera_source;
  if (source == CameraSource::file) return "";
  const char* kind = source == CameraSource::guess ? "a guess" : "self-calibrated";
  return row("camera", "{}, f {:.0f} px", kind, recording.camera.fx);
}

constexpr int kDecimals = 9;

std::string seconds(std::int64_t ns) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return fmt::format(
      "{}{}.{:09d}", ns < 0 ? "-" : "", std::abs(ns / kSecond), std::abs(ns % kSecond));
}

std::string tum_line(std::int64_t ns, const Pose& camera) {
  return fmt::format("{} {:.9f} {:.9f}\n",
                     seconds(ns),
                     fmt::join(camera.p_wc, " "),
                     fmt::join(quaternion_xyzw(camera.R_wc), " "));
}

std::string euroc_line(std::int64_t ns, const Pose& camera) {
  return std::to_string(ns) + cells(camera.p_wc, kDecimals) +
         quaternion_cells(Eigen::Quaterniond(quaternion_xyzw(camera.R_wc)), kDecimals) + "\n";
}

std::string kitti_line(std::int64_t /*ns*/, const Pose& camera) {
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> T;
  T << camera.R_wc, camera.p_wc;
  return fmt::format("{:.9e}\n", fmt::join(T.data(), T.data() + T.size(), " "));
}

/// Returns the number of tracks that were neither excluded by hand nor left out as static.
int used_tracks(const Inspection& inspection) {
  int count = 0;
  for (int column = 0; column < inspection.window->track_count(); ++column)
    count += is_excluded(inspection, column) || is_static(inspection, column) ? 0 : 1;
  return count;
}

}  // namespace

std::string to_text(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  const Window& window = *inspection.window;
  const Timing& t = inspection.timing;
  const int frames = window.frame_count(), last = window.start + frames - 1;
  const int inliers = window.inlier_count(0), tracks = used_tracks(inspection);
  std::string text = row("recording", inspection.recording->name) +
                     row("window", "frames {} to {} ({})", window.start, last, frames) +
                     camera_row(*inspection.recording) +
                     row("method", inspection.settings.options.method.row().title) +
                     row("rotations", rotations_text(inspection)) +
                     row("status", result.ok ? "ok" : "failed: " + result.reason) +
                     row("inliers", "{} of {} {}", inliers, tracks, inliers_note(inspection));
  for (const std::string& note : notes_of(inspection)) text += row("note", note);
  if (result.verdict)
    text += verdict_text(*result.verdict) + findings_text(*result.verdict, inspection.findings);
  if (result.ok) {
    text += row("normal",
                "{:.5f}  (reference camera; distance = 1)",
                fmt::join(result.plane.normal, " ")) +
            uncertainty_text(result, inspection.recording->camera_source) +
            inertial_text(inspection) + chosen_text(inspection) +
            row("residual",
                "{} RMS (transfer), {} RMS (reprojection)",
                with_unit(result.transfer_rms_px, 1, 3, "px"),
                with_unit(result.reprojection_rms_px, 1, 3, "px"));
    if (const SolverReport& solver = result.solver; solver.unknowns > 0)  // not in closed form
      text += row("solver",
                  "{}, {} unknowns, {} residuals",
                  counted(solver.iterations, "iteration"),
                  solver.unknowns,
                  solver.residuals);
  }
  text += row("time",
              "{:.1f} ms  (track {:.1f}, RANSAC {:.1f}, rotations {:.1f}, initialize {:.1f}, of "
              "which solver {:.1f})",
              t.total,
              t.track,
              t.ransac,
              t.rotations,
              t.initialize,
              t.optimize);
  if (inspection.evaluation)
    text += metrics_text(*inspection.evaluation) + truth_text(*inspection.truth);
  return text;
}

CameraPath estimated_path(const Inspection& inspection, const ExportWorld& world) {
  if (!inspection.initialization->ok)
    throw InputError(fmt::format("{}: the initialization failed ({}), so there is no trajectory",
                                 inspection.recording->name,
                                 inspection.initialization->reason));
  CameraPath path{
      inspection.window->timestamps_ns, inspection.initialization->cameras, world.description()};
  const Similarity& T = world.T_world_reference;
  for (Pose& camera : path.cameras) camera = {T.R_ab * camera.R_wc, T * camera.p_wc};
  return path;
}

CameraPath true_path(const Inspection& inspection) {
  if (!inspection.truth)
    throw InputError(inspection.recording->name + ": no ground truth to write a trajectory of");
  CameraPath trajectory{{}, {}, "world = that of " + inspection.truth->source + "; unit = meter"};
  const auto& cameras = inspection.truth->cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    trajectory.complete = trajectory.complete && cameras[i];
    if (!cameras[i]) continue;
    trajectory.timestamps_ns.push_back(inspection.window->timestamps_ns[i]);
    trajectory.cameras.push_back(*cameras[i]);
  }
  return trajectory;
}

std::string to_text(const CameraPath& trajectory, TrajectoryFormat format) {
  struct Style {
    const char* header;  ///< empty for KITTI
    std::string (*line)(std::int64_t ns, const Pose& camera);
  };
  constexpr std::array<Style, 3> kStyles{
      {{"# timestamp[s] tx ty tz qx qy qz qw; camera to world; ", tum_line},
       {"#timestamp [ns],p_x,p_y,p_z,q_w,q_x,q_y,q_z; camera to world; ", euroc_line},
       {"", kitti_line}}};
  if (format == TrajectoryFormat::kitti && !trajectory.complete)
    throw InputError(
        "trajectory: some frames have no pose, which KITTI's format cannot express. Choose tum or "
        "euroc");
  const Style& style = kStyles[static_cast<std::size_t>(format)];
  std::string text = *style.header == '\0' ? "" : style.header + trajectory.world + "\n";
  for (std::size_t i = 0; i < trajectory.cameras.size(); ++i)
    text += style.line(trajectory.timestamps_ns[i], trajectory.cameras[i]);
  return text;
}

}  // namespace gpo
