// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/gravity_facts.h"

#include "engine/inspection/plane_names.h"
#include "ui/look/numbers.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

void add_meters(ResultGroup& group, const Inspection& inspection, double scale, double cube_side) {
  const double percent = 100 * inspection.inertial->log_scale_sigma;
  group.rows.push_back(
      {"Scale",
       "\u00b1" + number_text(percent, 1) + " %",
       inspection.scale_known_at
           ? fmt::format("from frame {} on", inspection.window->start + *inspection.scale_known_at)
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

}  // namespace

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

}  // namespace gpo
