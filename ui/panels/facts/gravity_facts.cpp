// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/facts.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

ResultRow up_row(const InertialAlignment& inertial) {
  if (!inertial.ok) return dash("Up", "Unknown: " + inertial.reason);
  return {.label = "Up",
          .value = sigma_text(inertial.gravity_sigma_deg),
          .tooltip = "Standard deviation of the direction of gravity"};
}

/// By the source of the scale.
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

}  // namespace

ResultGroup gravity_group(const Inspection& inspection, double cube_side) {
  ResultGroup group{"GRAVITY AND METRIC SCALE", {}};
  if (const auto& note = inspection.gyroscope_note; !note.empty())
    group.rows.push_back(dash("Gyroscope", note));
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

}  // namespace gpo
