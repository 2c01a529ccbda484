// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"
#include "engine/methods/methods.h"
#include "engine/pipeline/method_defaults.h"
#include "engine/recording/board/board.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/version.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

using nlohmann::ordered_json;

/// Raised if a key is renamed, removed or gets another meaning, not for additional keys.
constexpr int kResultFormat = 1;

ordered_json vector_json(const auto& v) {
  return ordered_json(std::vector<double>(v.begin(), v.end()));
}

ordered_json array_json(const auto& range, auto&& one) {
  ordered_json array = ordered_json::array();
  for (const auto& element : range) array.push_back(one(element));
  return array;
}

ordered_json plane_json(const Plane& plane) {
  return {{"normal", vector_json(plane.normal)}, {"distance", plane.distance}};
}

ordered_json settings_json(const Inspection& inspection) {
  const Settings used = settings_used(inspection);
  ordered_json json;
  for (const Setting& setting : settings_table()) {
    constexpr std::array kElsewhere{"start", "frames", "method"};
    if (std::ranges::find(kElsewhere, setting.key) != kElsewhere.end()) continue;
    const ordered_json value = value_json(setting.get(used));
    const bool unset = setting.by_hand && setting.get(used) == setting.get(Settings{});
    if (!unset) json[setting.key] = value;
  }
  return json;
}

ordered_json unused_json(const Inspection& inspection) {
  ordered_json unused = ordered_json::array();
  for (const Setting& setting : settings_table())
    if (!why_idle(setting, inspection.settings, inspection.recording.get()).empty())
      unused.push_back(setting.key);
  return unused;
}

ordered_json frames_json(const Inspection& inspection) {
  const Window& window = *inspection.window;
  const bool ok = inspection.initialization->ok;
  const auto& cameras = inspection.initialization->cameras;
  ordered_json frames = ordered_json::array();
  for (int i = 0; i < window.frame_count(); ++i)
    frames.push_back(
        {{"index", window.start + i},
         {"timestamp_ns", window.timestamps_ns[i]},
         {"p_wc", ok ? vector_json(cameras[i].p_wc) : ordered_json(nullptr)},
         {"q_wc_xyzw", ok ? vector_json(quaternion_xyzw(cameras[i].R_wc)) : ordered_json(nullptr)},
         {"inliers", window.inlier_count(i)},
         {"lost", lost_count(window, i)}});
  return frames;
}

ordered_json refused_json(const RefusedSolution& refused, int index) {
  const auto frames = array_json(refused.cameras, [&](const Pose& camera) -> ordered_json {
    return {{"index", index++},
            {"p_wc", vector_json(camera.p_wc)},
            {"q_wc_xyzw", vector_json(quaternion_xyzw(camera.R_wc))}};
  });
  return {{"plane", plane_json(refused.plane)}, {"frames", frames}};
}

ordered_json candidate_json(const HomographyCandidate& candidate, int window_start) {
  const HomographyMotion& motion = candidate.motion;
  return {{"frame", window_start + candidate.frame},
          {"decomposition", "malis_vargas"},
          {"normal", vector_json(motion.normal)},
          {"tau", vector_json(motion.tau)},
          {"q_21_xyzw", vector_json(quaternion_xyzw(motion.R_21))},
          {"score", candidate.score},
          {"rejected", candidate.rejected}};
}

ordered_json matrix_json(const auto& matrix) {
  return array_json(matrix.rowwise(),
                    [](const auto& row) { return vector_json(Eigen::VectorXd(row)); });
}

ordered_json solver_json(const SolverReport& solver) {
  return {{"iterations", solver.iterations},
          {"initial_cost", solver.initial_cost},
          {"final_cost", solver.final_cost},
          {"unknowns", solver.unknowns},
          {"residuals", solver.residuals},
          {"termination", to_string(solver.termination)}};
}

ordered_json timing_json(const Timing& timing) {
  return {{"track", timing.track},
          {"ransac", timing.ransac},
          {"rotations", timing.rotations},
          {"initialize", timing.initialize},
          {"optimize", timing.optimize},
          {"total", timing.total}};
}

ordered_json planes_json(const Inspection& inspection) {
  const Window& window = *inspection.window;
  ordered_json planes = ordered_json::array();
  const auto add = [&](int number, const PlaneEstimate* estimate) {
    std::vector<std::int64_t> ids;
    for (const int j : window.planes[number].tracks) ids.push_back(inspection.tracks->ids[j]);
    ordered_json plane = {{"number", number + 1}, {"normal", nullptr}, {"distance", nullptr}};
    if (estimate != nullptr) {
      plane["normal"] = vector_json(estimate->plane.normal);
      plane["distance"] = estimate->plane.distance;
      const auto& covariance = estimate->normal_covariance;
      plane["normal_covariance_rad2"] = covariance ? matrix_json(*covariance) : nullptr;
      plane["distance_sigma"] = optional_json(estimate->distance_sigma);
    }
    if (const auto name = plane_name(inspection, number)) {
      plane["name"] = name->name;
      plane["tilt_deg"] = name->tilt_deg;
      plane["tilt_sigma_deg"] = optional_json(name->sigma_deg);
    }
    plane["share"] = static_cast<double>(ids.size()) / window.track_count();
    plane["tracks"] = ids;
    planes.push_back(std::move(plane));
  };
  const std::vector<PlaneEstimate>& found = inspection.initialization->planes;
  for (const PlaneEstimate& one : found) add(one.number, &one);
  for (int k = 0; k < static_cast<int>(window.planes.size()); ++k)
    if (std::ranges::find(found, k, &PlaneEstimate::number) == found.end()) add(k, nullptr);
  return planes;
}

/// World = reference camera; `scale` in meters per plane distance, `sigma` of its logarithm.
ordered_json inertial_json(const InertialAlignment& inertial) {
  if (!inertial.ok) return {{"status", "failed"}, {"reason", inertial.reason}};
  const bool determined = std::isfinite(inertial.log_scale_sigma);
  return {{"status", "ok"},
          {"reason", inertial.scale_reason},
          {"gravity", vector_json(inertial.gravity_m_s2)},
          {"gravity_sigma_deg", inertial.gravity_sigma_deg},
          {"direction_covariance_rad2", matrix_json(inertial.direction_covariance)},
          {"scale", inertial.scale},
          {"sigma", determined ? ordered_json(inertial.log_scale_sigma) : ordered_json(nullptr)},
          {"scale_known", inertial.scale_known},
          {"velocities",
           array_json(inertial.velocities_m_s, [](const auto& v) { return vector_json(v); })},
          {"timestamps_ns", inertial.times_ns},
          {"accelerometer_bias", vector_json(inertial.accelerometer_bias_m_s2)},
          {"accelerometer_bias_covariance", matrix_json(inertial.accelerometer_bias_covariance)},
          {"misfit", inertial.misfit},
          {"joint", inertial.joint}};
}

ordered_json metrics_json(const Evaluation& evaluation) {
  ordered_json json = {{"alignment", evaluation.alignment == Alignment::ok ? "ok" : "degenerate"},
                       {"scale", optional_json(evaluation.scale)},
                       {"ate_m", optional_json(evaluation.ate_m)},
                       {"pne_deg", optional_json(evaluation.pne_deg)},
                       {"pne_aligned_deg", optional_json(evaluation.pne_aligned_deg)},
                       {"pde_m", optional_json(evaluation.pde_m)},
                       {"pne_bound_deg", optional_json(evaluation.pne_bound_deg)},
                       {"scale_ratio", optional_json(evaluation.scale_ratio)},
                       {"path_error_m", optional_json(evaluation.path_error_m)},
                       {"path_error_percent", optional_json(evaluation.path_error_percent)}};
  if (evaluation.scale_error_percent) json["scale_error_percent"] = *evaluation.scale_error_percent;
  if (evaluation.gravity_error_deg) json["gravity_error_deg"] = *evaluation.gravity_error_deg;
  return json;
}

ordered_json truth_json(const WindowTruth& truth) {
  const auto known = [](const std::optional<Pose>& pose) { return pose.has_value(); };
  ordered_json json = {{"source", truth.source},
                       {"frames", std::ranges::count_if(truth.cameras, known)}};
  if (const auto median = median_uncertainty(truth.uncertainties))
    json.update(pose_uncertainty_json(*median));
  return json;
}

std::string lens_text(const Uncertainty& u) {
  if (!u.typical_lens_sigma_deg) return "as its calibration says";
  return u.includes_typical_lens ? "typical, exact for the normal" : "taken as exact";
}

/// World = reference camera, plane distance 1; one center covariance and distance ratio a frame.
ordered_json uncertainty_json(const Initialization& result) {
  const Uncertainty& u = *result.uncertainty;
  ordered_json ratios = ordered_json::array();
  for (std::size_t i = 0; i < result.cameras.size(); ++i)
    ratios.push_back({{"value", 1 + result.plane.normal.dot(result.cameras[i].p_wc)},
                      {"sigma", u.distance_ratio_sigmas[i]}});
  double noise_square = std::pow(u.normal_sigma_deg, 2);
  ordered_json parts = {{"noise", 0}};
  for (const auto& [name, part_deg] : {std::pair("neighbors", u.neighbors_sigma_deg),
                                       {"bend", u.bend_sigma_deg},
                                       {"clock", u.clock_sigma_deg},
                                       {"shutter", u.shutter_sigma_deg},
                                       {"lens", u.lens_sigma_deg}}) {
    noise_square -= std::pow(part_deg.value_or(0), 2);
    parts[name] = optional_json(part_deg);
  }
  parts["noise"] = std::sqrt(std::max(0.0, noise_square));
  ordered_json json = {{"of", u.own ? "method" : "window"},
                       {"rotations", to_string(u.rotations)},
                       {"sigma_px", u.sigma_px},
                       {"tracks", u.tracks},
                       {"lens", lens_text(u)},
                       {"normal_sigma_deg", u.normal_sigma_deg},
                       {"typical_lens_sigma_deg", optional_json(u.typical_lens_sigma_deg)},
                       {"parts_deg", parts},
                       {"normal_covariance_rad2", matrix_json(u.normal_covariance)},
                       {"distance_ratios", ratios},
                       {"center_covariances", array_json(u.center_covariances, [](const auto& cov) {
                          return matrix_json(cov);
                        })}};
  if (u.bias_covariance) json["bias_covariance_rad2_s2"] = matrix_json(*u.bias_covariance);
  json["bounds_deg"] = {{"known_rotations", optional_json(u.bound_known_rotations_deg)},
                        {"unknown_bias", optional_json(u.bound_unknown_bias_deg)}};
  return json;
}

ordered_json verdict_json(const Verdict& verdict, const Window& window) {
  // A verdict that did not judge the scene reports none of its planes.
  const std::span<const WindowPlane> judged_planes =
      verdict.scene == SceneKind::unknown ? std::span<const WindowPlane>() : window.planes;
  const auto planes = array_json(judged_planes, [&](const WindowPlane& plane) -> ordered_json {
    return {{"track_share", static_cast<double>(plane.tracks.size()) / window.track_count()},
            {"picture_share", plane.image_share},
            {"stability", plane.stability}};
  });
  ordered_json criterion = nullptr;
  if (const auto& c = verdict.criterion)
    criterion = {{"planes", c->planes}, {"free_points", c->free_points}};
  return {{"readiness", to_string(verdict.readiness)},
          {"reason", verdict.reason},
          {"normal_sigma_deg", optional_json(verdict.normal_sigma_deg)},
          {"rotation_rms_px", optional_json(verdict.rotation_rms_px)},
          {"noise_px", optional_json(verdict.noise_px)},
          {"largest_translation", optional_json(verdict.largest_translation)},
          {"scene", to_string(verdict.scene)},
          {"planes", planes},
          {"gric", criterion}};
}

/// World = reference camera, unit = distance of the plane; null if the initialization failed.
ordered_json cube_json(const Inspection& inspection) {
  if (!inspection.cube) return nullptr;
  const double side =
      default_cube_side(*inspection.cube, inspection.initialization->plane.distance);
  return array_json(cube_corners(*inspection.cube, side),
                    [](const auto& corner) { return vector_json(corner); });
}

ordered_json growth_json(const std::vector<Verdict>& growth) {
  int frames = 2;
  return array_json(growth, [&](const Verdict& verdict) -> ordered_json {
    return {{"frames", frames++},
            {"readiness", to_string(verdict.readiness)},
            {"normal_sigma_deg", optional_json(verdict.normal_sigma_deg)}};
  });
}

ordered_json camera_json(const Recording& recording) {
  const Camera& camera = recording.camera;
  return {{"source", to_string(recording.camera_source)},
          {"image_size_px", {camera.width, camera.height}},
          {"lens_model", distortion_name(camera.distortion)},
          {"intrinsics", {camera.fx, camera.fy, camera.cx, camera.cy}},
          {"distortion_coefficients", camera.coefficients}};
}

/// Adds what the method estimates of gyroscope and shutter.
void add_sensors(const Initialization& result, ordered_json& json) {
  if (result.bias_rad_s) json["bias_rad_s"] = vector_json(*result.bias_rad_s);
  const Uncertainty u = result.uncertainty.value_or(Uncertainty{});
  if (result.time_offset_s) json["time_offset_s"] = *result.time_offset_s;
  if (result.time_offset_correction_s)
    json["time_offset_correction_s"] = *result.time_offset_correction_s;
  if (u.time_offset_sigma_s) json["time_offset_sigma_s"] = *u.time_offset_sigma_s;
  if (result.row_delay_s) json["row_delay_s"] = *result.row_delay_s;
  if (result.row_delay_s && u.row_delay_sigma_s) json["row_delay_sigma_s"] = *u.row_delay_sigma_s;
  if (const auto& lens = result.lens_residual)
    json["lens_residual"] = {{"corner_px", lens->corner_px},
                             {"x_px", vector_json(lens->coefficients_px.col(0))},
                             {"y_px", vector_json(lens->coefficients_px.col(1))}};
}

/// Adds decompositions, a refused solution and dropped tracks, if there are any.
void add_rejected(const Inspection& inspection, ordered_json& json) {
  const Initialization& result = *inspection.initialization;
  const auto& ids = inspection.tracks->ids;
  const int start = inspection.window->start;
  if (!result.candidates.empty())
    json["candidates"] =
        array_json(result.candidates, [&](const auto& one) { return candidate_json(one, start); });
  if (result.refused) json["refused"] = refused_json(*result.refused, start);
  if (result.ambiguity && !result.ambiguity->undecided.empty())
    json["alternatives"] = array_json(result.ambiguity->undecided,
                                      [&](const auto& one) { return refused_json(one, start); });
  if (!result.dropped.empty())
    json["dropped"] = array_json(result.dropped, [&](int j) -> ordered_json {
      return {{"track", ids[j]}, {"reason", "beyond the plane's horizon"}};
    });
}

}  // namespace

Settings settings_used(const Inspection& inspection) {
  Settings used = inspection.settings;
  used.options.rotations = inspection.rotations_used;
  used.options.ransac = uses_ransac(used.options);
  used.options.ransac_threshold_px = inspection.window->threshold_px;
  used.options.inliers = inspection.window->inliers;
  used.options.gravity = gravity_used(used.options);
  return used;
}

ordered_json pose_uncertainty_json(const PoseUncertainty& uncertainty) {
  return {{"rms_px", uncertainty.rms_px},
          {"position_sigma_m", uncertainty.position_sigma_m},
          {"rotation_sigma_deg", uncertainty.rotation_sigma_deg},
          {"normal_sigma_deg", uncertainty.normal_sigma_deg}};
}

ordered_json masks_json(const Masks& masks) {
  return array_json(masks.areas, [](const Mask& mask) -> ordered_json {
    const auto corners =
        array_json(mask.corners_raw_px, [](const auto& corner) { return vector_json(corner); });
    return {{"kind", to_string(mask.kind)}, {"corners_raw_px", corners}};
  });
}

ordered_json value_json(const SettingValue& value) {
  return std::visit(
      [](const auto& plain) {
        using Plain = std::decay_t<decltype(plain)>;
        if constexpr (std::is_same_v<Plain, std::monostate>)
          return ordered_json(nullptr);
        else if constexpr (std::is_same_v<Plain, PointPair>)
          return ordered_json(plain.numbers);
        else if constexpr (std::is_same_v<Plain, Masks>)
          return masks_json(plain);
        else
          return ordered_json(plain);
      },
      value);
}

ordered_json to_json(std::span<const Finding> findings) {
  return array_json(findings, [](const Finding& finding) -> ordered_json {
    return {{"key", finding.key},
            {"level", to_string(finding.level)},
            {"sentence", finding.sentence},
            {"advice", finding.advice},
            {"command", finding.command},
            {"tracks", finding.tracks},
            {"frames", finding.frames},
            {"view", finding.view},
            {"ignored", finding.ignored}};
  });
}

ordered_json to_json(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  const Window& window = *inspection.window;
  ordered_json json;
  json["format_version"] = kResultFormat;
  json["program_version"] =
      fmt::format("{}.{}.{}", GPO_VERSION_MAJOR, GPO_VERSION_MINOR, GPO_VERSION_PATCH);
  json["recording"] = inspection.recording->path.string();
  json["camera"] = camera_json(*inspection.recording);
  json["method"] = inspection.settings.options.method.key();
  json["status"] = result.ok ? "ok" : "failed";
  json["reason"] = result.reason;
  json["window"] = {{"start", window.start},
                    {"frames", window.frame_count()},
                    {"tracks", window.track_count()},
                    {"inliers", window.inlier_count(0)},
                    {"lost", lost_count(window, window.frame_count() - 1)}};
  json["settings"] = settings_json(inspection);
  json["unused_settings"] = unused_json(inspection);
  if (!inspection.rotations_note.empty()) json["rotations_note"] = inspection.rotations_note;
  if (const auto notes = notes_of(inspection); !notes.empty()) json["notes"] = notes;
  json["findings"] = to_json(inspection.findings);
  if (inspection.gyroscope_bias_rad_s)
    json["gyroscope_bias_rad_s"] = vector_json(*inspection.gyroscope_bias_rad_s);
  json["planes"] = planes_json(inspection);
  json["plane"] = result.ok ? plane_json(result.plane) : ordered_json();
  json["frames"] = frames_json(inspection);
  const auto& ids = inspection.tracks->ids;
  json["points"] = array_json(result.points, [&](const MapPoint& point) -> ordered_json {
    return {{"track", ids[point.track]}, {"position", vector_json(point.position)}};
  });
  json["cube_corners"] = cube_json(inspection);
  json["transfer_rms_px"] = optional_json(result.transfer_rms_px);
  json["reprojection_rms_px"] = optional_json(result.reprojection_rms_px);
  add_sensors(result, json);
  if (result.uncertainty) {
    json["uncertainty"] = uncertainty_json(result);
    if (inspection.recording->camera_source == CameraSource::guess)
      json["uncertainty"]["lens"] = "a guess, " + lens_text(*result.uncertainty);
  }
  if (inspection.inertial) json["inertial"] = inertial_json(*inspection.inertial);
  if (inspection.metric_scale_from)
    json["inertial"]["scale_known_at_frame"] = window.start + *inspection.metric_scale_from;
  add_world(inspection, json);
  if (result.verdict || !result.ok)
    json["verdict"] =
        verdict_json(result.verdict.value_or(Verdict{.reason = result.reason}), window);
  if (!inspection.growth.empty()) json["growth"] = growth_json(inspection.growth);
  add_rejected(inspection, json);
  json["solver"] = solver_json(result.solver);
  json["timing_ms"] = timing_json(inspection.timing);
  if (inspection.truth) json["truth"] = truth_json(*inspection.truth);
  if (inspection.evaluation) json["metrics"] = metrics_json(*inspection.evaluation);
  return json;
}

}  // namespace gpo
