// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/python/solved.h"

#include "app/python/arrays.h"
#include "app/python/bindings.h"

#include <optional>

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

namespace gpo {
namespace {

namespace py = pybind11;

py::array points_of(const Solved& result) {
  static const MapPoint none{};
  const auto& points = result.initialization->points;
  return seen_by_numpy(points.empty() ? none.position.data() : points.front().position.data(),
                       {std::ssize(points), 3},
                       {sizeof(MapPoint), sizeof(double)},
                       result.initialization);
}

py::array point_tracks_of(const Solved& result) {
  static const MapPoint none{};
  const auto& points = result.initialization->points;
  return seen_by_numpy(points.empty() ? &none.track : &points.front().track,
                       {std::ssize(points)},
                       {sizeof(MapPoint)},
                       result.initialization);
}

py::array ids_of(const Solved& result) {
  const auto& ids = *result.ids;
  return seen_by_numpy(ids.data(), {std::ssize(ids)}, {sizeof(std::int64_t)}, result.ids);
}

/// Of one of the window's planes.
py::array tracks_of(const Solved& result, int number) {
  std::vector<std::int64_t> ids;
  for (const int column : result.window->planes.at(number).tracks)
    ids.push_back((*result.ids)[column]);
  return py::array_t<std::int64_t>(std::ssize(ids), ids.data());
}

py::list planes_of(const Solved& result) {
  py::list planes;
  for (const PlaneEstimate& estimate : result.initialization->planes) {
    py::dict plane;
    plane["number"] = estimate.number + 1;
    plane["normal"] = estimate.plane.normal;
    plane["distance"] = estimate.plane.distance;
    plane["normal_covariance_rad2"] = estimate.normal_covariance;
    plane["tracks"] = tracks_of(result, estimate.number);
    planes.append(std::move(plane));
  }
  return planes;
}

/// None where no accelerometer was used, or gravity was not found with it.
py::object inertial_of(const Solved& result) {
  if (!result.inertial || !result.inertial->ok) return py::none();
  const InertialAlignment& inertial = *result.inertial;
  py::dict told;
  told["gravity_m_s2"] = inertial.gravity_m_s2;
  told["gravity_sigma_deg"] = inertial.gravity_sigma_deg;
  told["scale"] = inertial.scale;
  told["log_scale_sigma"] = inertial.log_scale_sigma;
  told["scale_known"] = inertial.scale_known;
  told["reason"] = inertial.scale_reason;
  told["velocities_m_s"] = seen_by_numpy(inertial.velocities_m_s.front().data(),
                                         {std::ssize(inertial.velocities_m_s), 3},
                                         {sizeof(Eigen::Vector3d), sizeof(double)},
                                         result.inertial);
  told["timestamps_ns"] = seen_by_numpy(inertial.times_ns.data(),
                                        {std::ssize(inertial.times_ns)},
                                        {sizeof(std::int64_t)},
                                        result.inertial);
  told["accelerometer_bias_m_s2"] = inertial.accelerometer_bias_m_s2;
  return told;
}

std::optional<std::string> readiness_of(const Solved& result) {
  const auto& verdict = result.initialization->verdict;
  return verdict ? std::optional(std::string(to_string(verdict->readiness))) : std::nullopt;
}

}  // namespace

void bind_solved(py::module_& module) {
  py::class_<Solved>(module,
                     "Initialization",
                     "What every method delivers. World: the window's first camera; unit: the "
                     "distance of the leading plane. Arrays look at its memory, read-only.")
      .def_property_readonly("ok", [](const Solved& r) { return (*r).ok; })
      .def_property_readonly(
          "reason", [](const Solved& r) { return (*r).reason; }, "why it is not ok, or empty")
      .def_property_readonly(
          "readiness",
          &readiness_of,
          "'ready', 'weak', 'degenerate' or 'no plane'; None where nothing was told")
      .def_property_readonly(
          "verdict",
          [](const Solved& r) { return (*r).verdict ? (*r).verdict->reason : std::string(); },
          "of the readiness, one sentence")
      .def_property_readonly(
          "R_wc",
          [](const Solved& r) { return rotations_of((*r).cameras, r.initialization); },
          "(N, 3, 3), camera to world, one a frame of the window")
      .def_property_readonly(
          "p_wc",
          [](const Solved& r) { return centers_of((*r).cameras, r.initialization); },
          "(N, 3) camera centers [plane distances]")
      .def_property_readonly("points", &points_of, "(M, 3) [plane distances]")
      .def_property_readonly(
          "point_tracks", &point_tracks_of, "(M,) int32: which of `ids` each point is")
      .def_property_readonly(
          "normal",
          [](const Solved& r) { return (*r).plane.normal; },
          "(3,) of the leading plane, in the reference camera: normal . x + distance = 0")
      .def_property_readonly(
          "normal_sigma_deg",
          [](const Solved& r) {
            return (*r).uncertainty ? std::optional((*r).uncertainty->normal_sigma_deg)
                                    : std::nullopt;
          },
          "standard deviation of the normal [deg], or None")
      .def_property_readonly(
          "bias_rad_s",
          [](const Solved& r) { return (*r).bias_rad_s; },
          "(3,) of the gyroscope [rad/s], or None")
      .def_property_readonly(
          "planes",
          &planes_of,
          "[{number, normal (3,), distance, normal_covariance_rad2 (3, 3), tracks: their ids}]: "
          "the leading one first")
      .def_property_readonly(
          "inertial",
          &inertial_of,
          "None without an accelerometer, else {gravity_m_s2 (3,): down, in the reference camera, "
          "gravity_sigma_deg, scale [m per plane distance], log_scale_sigma, scale_known, reason: "
          "why not, velocities_m_s (K, 3), timestamps_ns (K,), accelerometer_bias_m_s2 (3,)}")
      .def_property_readonly("ids", &ids_of, "(T,) int64 of the window's tracks");
}

}  // namespace gpo
