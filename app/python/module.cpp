// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The Python module `gpo`: the engine and views of the program.
#include "app/python/bindings.h"
#include "app/terminal/output.h"
#include "engine/base/error.h"
#include "engine/inspection/settings/settings_table.h"

#include <optional>

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

namespace gpo {
namespace {

namespace py = pybind11;

std::string setting_text_of(const std::string& name, const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "on" : "off";
  if (!py::isinstance<py::str>(value) && py::isinstance<py::sequence>(value)) {
    std::string list;
    for (const py::handle one : value)
      list += (list.empty() ? "" : ",") + setting_text_of(name, one);
    return list;
  }
  return py::str(value);
}

py::array points_of(const Solved& result) {
  return view_vectors<MapPoint>(
      result.initialization->points, &MapPoint::position, result.initialization);
}

py::array point_tracks_of(const Solved& result) {
  static const MapPoint none{};
  const auto& points = result.initialization->points;
  return view_array(points.empty() ? &none.track : &points.front().track,
                    {std::ssize(points)},
                    {sizeof(MapPoint)},
                    result.initialization);
}

py::array ids_of(const Solved& result) { return view_integers(*result.ids, result.ids); }

/// Returns the ids of the tracks on one of the window's planes.
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

/// Returns None if no accelerometer was used or gravity was not found.
py::object inertial_of(const Solved& result) {
  if (!result.inertial || !result.inertial->ok) return py::none();
  const InertialAlignment& inertial = *result.inertial;
  py::dict fields;
  fields["gravity_m_s2"] = inertial.gravity_m_s2;
  fields["gravity_sigma_deg"] = inertial.gravity_sigma_deg;
  fields["scale"] = inertial.scale;
  fields["log_scale_sigma"] = inertial.log_scale_sigma;
  fields["scale_known"] = inertial.scale_known;
  fields["reason"] = inertial.scale_reason;
  fields["velocities_m_s"] = view_vectors(inertial.velocities_m_s, result.inertial);
  fields["timestamps_ns"] = view_integers(inertial.times_ns, result.inertial);
  fields["accelerometer_bias_m_s2"] = inertial.accelerometer_bias_m_s2;
  return fields;
}

std::optional<std::string> readiness_of(const Solved& result) {
  const auto& verdict = result.initialization->verdict;
  return verdict ? std::optional(std::string(to_string(verdict->readiness))) : std::nullopt;
}

void bind_solved(py::module_& module) {
  py::class_<Solved>(module,
                     "Initialization",
                     "The result of every method. World: the window's first camera; unit: the "
                     "distance of the leading plane. Arrays are read-only views.")
      .def_property_readonly("ok", [](const Solved& r) { return (*r).ok; })
      .def_property_readonly(
          "reason", [](const Solved& r) { return (*r).reason; }, "why it failed, or empty")
      .def_property_readonly(
          "readiness",
          &readiness_of,
          "'ready', 'weak', 'degenerate' or 'no plane'; None if there is no verdict")
      .def_property_readonly(
          "verdict",
          [](const Solved& r) { return (*r).verdict ? (*r).verdict->reason : std::string(); },
          "one sentence about the readiness")
      .def_property_readonly(
          "R_wc",
          [](const Solved& r) { return view_rotations((*r).cameras, r.initialization); },
          "(N, 3, 3), camera to world, for each frame of the window")
      .def_property_readonly(
          "p_wc",
          [](const Solved& r) {
            return view_vectors<Pose>((*r).cameras, &Pose::p_wc, r.initialization);
          },
          "(N, 3) camera centers [plane distances]")
      .def_property_readonly("points", &points_of, "(M, 3) [plane distances]")
      .def_property_readonly(
          "point_tracks", &point_tracks_of, "(M,) int32: index of each point's track in `ids`")
      .def_property_readonly(
          "normal",
          [](const Solved& r) { return (*r).plane.normal; },
          "(3,) leading plane's normal in the reference camera: normal . x + distance = 0")
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
          "(3,) gyroscope bias [rad/s], or None")
      .def_property_readonly(
          "planes",
          &planes_of,
          "[{number, normal (3,), distance, normal_covariance_rad2 (3, 3), tracks: ids}], "
          "the leading plane first")
      .def_property_readonly(
          "inertial",
          &inertial_of,
          "None without an accelerometer, else {gravity_m_s2 (3,): down, in the reference camera, "
          "gravity_sigma_deg, scale [m per plane distance], log_scale_sigma, scale_known, reason: "
          "why the scale is unknown, velocities_m_s (K, 3), timestamps_ns (K,), "
          "accelerometer_bias_m_s2 (3,)}")
      .def_property_readonly("ids", &ids_of, "(T,) int64, ids of the window's tracks");
}

}  // namespace

Settings settings_of(const py::kwargs& given) {
  Settings settings;
  if (given.contains("preset"))
    settings =
        with_preset(std::move(settings), choice<Preset>(std::string(py::str(given["preset"]))));
  for (const auto& [key, value] : given) {
    const std::string name = py::str(key);
    if (name == "preset" || value.is_none()) continue;
    settings = with_setting(std::move(settings), name, setting_text_of(name, value));
  }
  return settings;
}

}  // namespace gpo

PYBIND11_MODULE(_gpo, module) {
  namespace py = pybind11;
  gpo::silence_libraries();
  py::register_exception<gpo::InputError>(module, "InputError", PyExc_ValueError);
  module.attr("__version__") = GPO_VERSION;
  gpo::bind_solved(module);
  gpo::bind_recording(module);
  gpo::bind_initialize(module);
  gpo::bind_results(module);
}
