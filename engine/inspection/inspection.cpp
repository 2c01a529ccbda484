// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspection.h"

#include "engine/base/error.h"
#include "engine/geometry/statistics.h"
#include "engine/pipeline/method_defaults.h"
#include "engine/pipeline/pipeline.h"
#include "engine/recording/companions/companion_files.h"

#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double parallax_px(const Window& window, int frame) {
  const Eigen::Matrix3d H_rotation =
      window.K * window.R_wc[frame].transpose() * window.R_wc[0] * window.K.inverse();
  std::vector<double> lengths;
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.inlier[frame][j]) continue;
    const Vector2d rotated = (H_rotation * window.points_px[0].col(j).homogeneous()).hnormalized();
    lengths.push_back((window.points_px[frame].col(j) - rotated).norm());
  }
  return lengths.empty() ? std::numeric_limits<double>::quiet_NaN() : median(std::move(lengths));
}

double rotation_rate_deg_s(const Window& window, int from, int to) {
  const Eigen::AngleAxisd rotation(window.R_wc[from].transpose() * window.R_wc[to]);
  const double seconds =
      1e-9 * static_cast<double>(window.timestamps_ns[to] - window.timestamps_ns[from]);
  return rotation.angle() * 180 / M_PI / seconds;
}

Vector3d middle_of_base(const Inspection& inspection, const CubeAnchor& cube) {
  if (!cube.on_board) return Vector3d::Zero();
  const double side = default_cube_side(cube, inspection.initialization->plane.distance);
  return Vector3d(0.5, 0.5, 0) * side / cube.unit;
}

void put(CubeAnchor& cube, const Vector3d& place, const Vector3d& middle) {
  cube.origin = place - cube.axes * (cube.unit * middle);
}

Eigen::Matrix3d axes_on(const Plane& plane_w, const Pose& camera, const Vector3d& x_w) {
  const bool towards = plane_w.normal.dot(camera.p_wc) + plane_w.distance >= 0;
  const Vector3d z = towards ? plane_w.normal : Vector3d(-plane_w.normal);
  const Vector3d x = (x_w - z * z.dot(x_w)).normalized();
  Eigen::Matrix3d axes;
  axes << x, x.cross(z), z;
  return axes;
}

std::vector<Vector3d> undistorted_rays(const Camera& camera, const std::vector<Vector2d>& raw_px) {
  const Eigen::Matrix3d K_inverse = intrinsic_matrix(camera).inverse();
  std::vector<Vector3d> rays;
  for (const auto& px : raw_px) rays.emplace_back(K_inverse * undistort(camera, px).homogeneous());
  return rays;
}

Vector3d centroid_ray(const Window& window) {
  Vector2d sum = Vector2d::Zero();
  for (int j = 0; j < window.track_count(); ++j)
    if (window.inlier[0][j]) sum += window.points_px[0].col(j);
  return window.K.inverse() * (sum / std::max(1, window.inlier_count(0))).homogeneous();
}

/// Moves the cube of a further plane; leaves it unchanged if the ray misses its plane.
void put_on(Inspection& inspection, const Vector3d& ray_c, int number) {
  const Plane* plane = estimated_plane(inspection, number);
  const auto cube = std::ranges::find(inspection.other_cubes, number, &CubeAnchor::plane);
  if (plane == nullptr || cube == inspection.other_cubes.end()) return;
  if (const auto place = intersect(*plane, Pose{}, ray_c)) cube->origin = *place;
}

}  // namespace

std::optional<CubeAnchor> anchor_on_plane(const Plane& plane_w,
                                          const Pose& camera,
                                          const Vector3d& ray_c) {
  const auto origin = intersect(plane_w, camera, ray_c);
  if (!origin) return std::nullopt;
  const double distance = std::abs(plane_w.normal.dot(camera.p_wc) + plane_w.distance);
  return CubeAnchor{
      .origin = *origin, .axes = axes_on(plane_w, camera, camera.R_wc.col(0)), .unit = distance};
}

std::optional<CubeAnchor> anchor_on_board(const Plane& plane_w,
                                          const Pose& camera,
                                          std::span<const Vector3d> corner_rays_c,
                                          const Board& board) {
  const auto first = intersect(plane_w, camera, corner_rays_c.front());
  const auto row_end = intersect(plane_w, camera, corner_rays_c[board.columns - 1]);
  if (!first || !row_end) return std::nullopt;
  const double square = (*row_end - *first).norm() / (board.columns - 1);
  return CubeAnchor{.origin = *first,
                    .axes = axes_on(plane_w, camera, *row_end - *first),
                    .on_board = true,
                    .unit = square};
}

double default_cube_side(const CubeAnchor& anchor, double plane_distance) {
  const double side = 0.2 * plane_distance;
  return anchor.on_board ? std::max(1.0, std::round(side / anchor.unit)) * anchor.unit : side;
}

std::array<Vector3d, 8> cube_corners(const CubeAnchor& anchor, double side, double height_sides) {
  const double shift = anchor.on_board ? 0 : -0.5;
  std::array<Vector3d, 8> corners;
  for (int k = 0; k < 8; ++k) {
    const Vector3d unit((k & 1) + shift, ((k >> 1) & 1) + shift, height_sides * (k >> 2));
    corners[k] = anchor.origin + anchor.axes * (side * unit);
  }
  return corners;
}

std::optional<CubeAnchor> place_cube(const Plane& plane_w,
                                     const Pose& reference,
                                     const Recording& recording,
                                     const Window& window,
                                     const std::vector<Vector2d>& board_corners_raw_px) {
  const auto rays = undistorted_rays(recording.camera, board_corners_raw_px);
  return rays.empty() ? anchor_on_plane(plane_w, reference, centroid_ray(window))
                      : anchor_on_board(plane_w, reference, rays, *recording.board);
}

std::optional<int> plane_of_track(const Window& window, int frame, int column) {
  if (window.inlier[frame][column]) return window.leader;
  for (int k = 0; k < static_cast<int>(window.planes.size()); ++k)
    if (window.planes[k].inlier[frame][column]) return k;
  return std::nullopt;
}

std::optional<int> plane_near(const Inspection& inspection,
                              int frame,
                              const Eigen::Vector2d& raw_px) {
  std::optional<int> plane;
  double nearest = kNearPlane * inspection.recording->camera.width;
  for (int column = 0; column < inspection.tracks->track_count(); ++column) {
    if (!inspection.tracks->seen(frame, column)) continue;
    const double away = (inspection.tracks->raw_px[frame].col(column) - raw_px).norm();
    const auto of_track = plane_of_track(*inspection.window, frame, column);
    if (!of_track || !(away <= nearest)) continue;
    nearest = away;
    plane = of_track;
  }
  return plane;
}

const Plane* estimated_plane(const Inspection& inspection, int number) {
  const Initialization& result = *inspection.initialization;
  if (!result.ok) return nullptr;
  if (number == inspection.window->leader) return &result.plane;
  const auto found = std::ranges::find(result.planes, number, &PlaneEstimate::number);
  return found == result.planes.end() ? nullptr : &found->plane;
}

ScaleSource scale_source(const Inspection& inspection) {
  if (inspection.measured_scale) return ScaleSource::points;
  const auto& imported = inspection.imported;
  return imported && imported->meters_per_unit ? ScaleSource::result : ScaleSource::accelerometer;
}

std::optional<double> scale_log_sigma(const Inspection& inspection) {
  if (!known_scale(inspection)) return std::nullopt;
  const ScaleSource source = scale_source(inspection);
  if (source == ScaleSource::points) return inspection.measured_scale->log_sigma;
  if (source == ScaleSource::result) return std::nullopt;
  return inspection.inertial->log_scale_sigma;
}

std::optional<double> known_scale(const Inspection& inspection) {
  if (const auto& measured = inspection.measured_scale)
    return measured->reason.empty() ? std::optional(measured->meters_per_unit) : std::nullopt;
  if (scale_source(inspection) == ScaleSource::result) return inspection.imported->meters_per_unit;
  const auto& inertial = inspection.inertial;
  const bool known = inertial && inertial->ok && inertial->scale_known;
  return known ? std::optional(inertial->scale) : std::nullopt;
}

double meters_per_unit(const Inspection& inspection) {
  if (const auto scale = known_scale(inspection)) return *scale;
  if (inspection.measured_scale) throw InputError(inspection.measured_scale->reason);
  const auto& inertial = inspection.inertial;
  throw InputError(fmt::format("meters: the scale is unknown ({})",
                               !inertial      ? "no accelerometer is used"
                               : inertial->ok ? inertial->scale_reason
                                              : inertial->reason));
}

std::vector<CubeAnchor> place_other_cubes(const Inspection& inspection) {
  const Window& window = *inspection.window;
  std::vector<CubeAnchor> cubes;
  for (const PlaneEstimate& estimate : inspection.initialization->planes) {
    if (estimate.number == window.leader) continue;
    const auto& tracks = window.planes[estimate.number].tracks;
    if (tracks.empty()) continue;
    const Eigen::Matrix2Xd pixels = window.points_px[0](Eigen::all, tracks);
    Eigen::Index nearest = 0;
    (pixels.colwise() - pixels.rowwise().mean()).colwise().norm().minCoeff(&nearest);
    const Vector3d ray = window.K.inverse() * pixels.col(nearest).homogeneous();
    auto cube = anchor_on_plane(estimate.plane, Pose{}, ray);
    if (!cube) continue;
    cube->plane = estimate.number;
    cubes.push_back(*cube);
  }
  return cubes;
}

Vector3d base_center(const Inspection& inspection, const CubeAnchor& cube) {
  return cube.origin + cube.axes * (cube.unit * middle_of_base(inspection, cube));
}

std::vector<CubeAnchor> all_cubes(const Inspection& inspection) {
  std::vector<CubeAnchor> cubes = inspection.other_cubes;
  if (inspection.cube) cubes.insert(cubes.begin(), *inspection.cube);
  return cubes;
}

std::vector<FrameMotion> frame_motion(const Window& window) {
  const int count = window.frame_count();
  std::vector<FrameMotion> motion(count);
  for (int i = 0; i < count; ++i) {
    motion[i].parallax_px = parallax_px(window, i);
    const int from = std::min(i, count - 2);
    if (count > 1) motion[i].rotation_rate_deg_s = rotation_rate_deg_s(window, from, from + 1);
  }
  return motion;
}

void move_cubes(Inspection& inspection, const Vector3d& ray_c, std::optional<int> plane) {
  if (!inspection.cube) return;
  if (plane && *plane != inspection.window->leader) return put_on(inspection, ray_c, *plane);
  const auto place = intersect(inspection.initialization->plane, Pose{}, ray_c);
  if (!place) return;
  const Vector3d middle = middle_of_base(inspection, *inspection.cube);
  put(*inspection.cube, *place, middle);
  if (!inspection.true_cube) return;
  const WindowTruth& truth = *inspection.truth;
  if (const auto true_place = intersect(*truth.plane, *truth.cameras.front(), ray_c))
    put(*inspection.true_cube, *true_place, middle);
  else
    inspection.true_cube.reset();
}

std::optional<double> normal_sigma_deg(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  if (result.uncertainty)
    return normal_sigma_deg(*result.uncertainty, inspection.settings.options.lens);
  return result.verdict ? result.verdict->normal_sigma_deg : std::nullopt;
}

std::string inliers_note(const Inspection& inspection) {
  const Window& window = *inspection.window;
  const int lost = lost_count(window, window.frame_count() - 1);
  const std::string note = lost > 0 ? fmt::format("tracks, {} lost", lost) : "tracks";
  if (window.inliers == Inliers::consistent) return note + ", consistent";
  const InitializeOptions& options = inspection.settings.options;
  const bool requested = uses_ransac(options) && inliers_used(options) == Inliers::consistent;
  return note + (requested ? ", per frame: too few are consistent" : "");
}

std::vector<TruthJump> truth_jumps(const Inspection& inspection) {
  if (!inspection.truth) return {};
  const auto& times = inspection.window->timestamps_ns;
  const auto& recorded = inspection.recording->truth;
  std::vector<TruthJump> jumps =
      recorded ? recorded->jumps : jumps_of(times, inspection.truth->cameras);
  keep_between(times.front(), times.back(), jumps);
  return jumps;
}

std::string board_truth_note(const Inspection& inspection) {
  const bool from_board = inspection.truth && !inspection.truth->uncertainties.empty();
  if (from_board && inspection.truth->estimated_readout)
    return fmt::format(
        "ground truth from the {}: with a readout time of {:.1f} +- {:.1f} ms, "
        "estimated from its corners",
        inspection.truth->source,
        1e3 * inspection.truth->estimated_readout->seconds,
        1e3 * inspection.truth->estimated_readout->sigma_s);
  const auto& result = inspection.initialization;
  if (!from_board || !result) return "";
  const auto& uncertainty = result->uncertainty;
  const bool rolling = result->row_delay_s || (uncertainty && uncertainty->neglected_row_delay_s);
  if (!rolling || inspection.recording->camera.readout) return "";
  return fmt::format(
      "the tracks show a rolling shutter, but the ground truth from the {} takes all rows as read "
      "at once: the readout time is unknown, and the board does not determine it in this window; "
      "`calibrate` estimates it from the whole recording",
      inspection.truth->source);
}

std::vector<std::string> notes_of(const Inspection& inspection) {
  std::vector<std::string> notes;
  for (const Finding& finding : inspection.findings)
    if (finding.level == Level::note) notes.push_back(text_of(finding));
  return notes;
}

Evidence evidence_of(const Recording& recording) {
  return {.camera = &recording.camera,
          .camera_is_guess = recording.camera_source == CameraSource::guess,
          .pixel_aspect = recording.pixel_aspect,
          .first_field = recording.first_field,
          .gyroscope = recording.gyroscope ? &*recording.gyroscope : nullptr};
}

void add_findings(Inspection& inspection) {
  std::vector<Remark> remarks;
  const auto add = [&](std::string_view key, std::string sentence) {
    if (!sentence.empty()) remarks.push_back({key, std::move(sentence)});
  };
  for (std::string& jump :
       notes_of(truth_jumps(inspection), inspection.recording->timestamps_ns.front()))
    add("truth-jump", std::move(jump));
  add("truth-of-board", board_truth_note(inspection));
  for (const Setting& setting : settings_table())
    if (setting.get(inspection.settings) != setting.get(Settings{}))
      if (const auto why = why_idle(setting, inspection.settings, inspection.recording.get());
          !why.empty())
        add("unused-settings", fmt::format("{} has no effect: {}", setting.key, why));
  if (inspection.measured_scale) add("unknown-scale", inspection.measured_scale->reason);
  if (inspection.chosen_world) add("unknown-scale", inspection.chosen_world->reason);
  const Evidence evidence{.remarks = remarks,
                          .window = inspection.window.get(),
                          .result = inspection.initialization.get(),
                          .truth = inspection.truth.get(),
                          .evaluation = inspection.evaluation ? &*inspection.evaluation : nullptr};
  for (Finding& finding :
       findings_of(evidence, {Of::inspection}, inspection.settings.options.ignore_findings))
    inspection.findings.push_back(std::move(finding));
  sort_by_level(inspection.findings);
}

}  // namespace gpo
