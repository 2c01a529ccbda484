// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The metric scale and the chosen world of `run --json`.
#include "engine/files/text_file.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"

#include <Eigen/Geometry>

namespace gpo {
namespace {

using nlohmann::ordered_json;

ordered_json numbers(const auto& v) {
  return ordered_json(std::vector<double>(v.begin(), v.end()));
}

/// Returns the scale and its source; null with the reason if two points do not determine it.
ordered_json metric_scale_json(const Inspection& inspection) {
  ordered_json json = {{"source", to_string(scale_source(inspection))},
                       {"meters_per_unit", optional_json(known_scale(inspection))},
                       {"sigma", optional_json(scale_log_sigma(inspection))}};
  if (const auto& measured = inspection.measured_scale) json["reason"] = measured->reason;
  return json;
}

ordered_json imported_json(const ImportedResult& imported) {
  return {{"meters_per_unit", optional_json(imported.meters_per_unit)},
          {"time_offset_s", optional_json(imported.time_offset_s)},
          {"time_offset_sigma_s", optional_json(imported.time_offset_sigma_s)},
          {"time_offset_by", imported.clock},
          {"applied_time_offset_s", imported.applied_time_offset_s}};
}

/// Returns the chosen world in the unit of the exports, with the planes in it.
ordered_json world_json(const Inspection& inspection) {
  const ExportWorld world = export_world(inspection, known_scale(inspection).has_value());
  const Similarity& T = world.T_world_reference;
  ordered_json planes = ordered_json::array();
  const auto add = [&](int number, const Plane& plane) {
    const Eigen::Vector3d normal = T.R_ab * plane.normal;
    planes.push_back({{"number", number + 1},
                      {"normal", numbers(normal)},
                      {"distance", T.scale * plane.distance - normal.dot(T.t_ab)}});
  };
  const Initialization& result = *inspection.initialization;
  add(inspection.window->leader, result.plane);
  for (const PlaneEstimate& one : result.planes)
    if (one.number != inspection.window->leader) add(one.number, one.plane);
  return {
      {"T_world_reference",
       {{"scale", T.scale}, {"q_xyzw", numbers(quaternion_xyzw(T.R_ab))}, {"t", numbers(T.t_ab)}}},
      {"unit", world.meters ? "m" : "d"},
      {"up", to_string(inspection.settings.world_up)},
      {"planes", planes}};
}

}  // namespace

Eigen::Vector4d quaternion_xyzw(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return (q.w() < 0 ? -1.0 : 1.0) * q.normalized().coeffs();
}

void add_world(const Inspection& inspection, ordered_json& json) {
  const auto& measured = inspection.measured_scale;
  const auto& chosen = inspection.chosen_world;
  if (inspection.imported) json["imported"] = imported_json(*inspection.imported);
  if (measured || known_scale(inspection)) json["metric_scale"] = metric_scale_json(inspection);
  const bool scaled = !measured || measured->reason.empty();
  if (chosen && chosen->reason.empty() && scaled) json["world"] = world_json(inspection);
}

nlohmann::ordered_json to_json(const Extrapolation& after) {
  ordered_json cameras = ordered_json::array();
  for (const ExtrapolatedCamera& camera : after.cameras)
    cameras.push_back({{"index", camera.frame},
                       {"timestamp_ns", camera.timestamp_ns},
                       {"p_wc", numbers(camera.pose.p_wc)},
                       {"q_wc_xyzw", numbers(quaternion_xyzw(camera.pose.R_wc))},
                       {"points", camera.points},
                       {"median_px", camera.median_px}});
  return {{"frames", cameras}, {"end", after.end}};
}

}  // namespace gpo
