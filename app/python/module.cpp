// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The Python module `gpo`: the engine and views of the program.
#include "app/python/bindings.h"
#include "app/recordings/recordings.h"
#include "app/terminal/terminal.h"
#include "engine/base/error.h"

#include <limits>
#include <optional>

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

namespace gpo {
namespace {

using namespace py::literals;

std::string setting_text_of(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "on" : "off";
  if (!py::isinstance<py::str>(value) && py::isinstance<py::sequence>(value)) {
    std::string list;
    for (const py::handle one : value) list += (list.empty() ? "" : ",") + setting_text_of(one);
    return list;
  }
  return py::str(value);
}

py::array point_tracks_of(const Solved& result) {
  static const MapPoint none{};
  const auto& points = result.initialization->points;
  return view_array(points.empty() ? &none.track : &points.front().track,
                    {std::ssize(points)},
                    {sizeof(MapPoint)},
                    result.initialization);
}

py::array tracks_of(const Solved& result, int number) {
  std::vector<std::int64_t> ids;
  for (const int column : result.window->planes.at(number).tracks)
    ids.push_back((*result.ids)[column]);
  return py::array_t<std::int64_t>(std::ssize(ids), ids.data());
}

py::list planes_of(const Solved& result) {
  py::list planes;
  for (const PlaneEstimate& estimate : result.initialization->planes) {
    planes.append(py::dict("number"_a = estimate.number + 1,
                           "normal"_a = estimate.plane.normal,
                           "distance"_a = estimate.plane.distance,
                           "normal_covariance_rad2"_a = estimate.normal_covariance,
                           "tracks"_a = tracks_of(result, estimate.number)));
  }
  return planes;
}

/// Returns None if no accelerometer was used or gravity was not found.
py::object inertial_of(const Solved& result) {
  if (!result.inertial || !result.inertial->ok) return py::none();
  const InertialAlignment& inertial = *result.inertial;
  return py::dict("gravity_m_s2"_a = inertial.gravity_m_s2,
                  "gravity_sigma_deg"_a = inertial.gravity_sigma_deg,
                  "scale"_a = inertial.scale,
                  "log_scale_sigma"_a = inertial.log_scale_sigma,
                  "scale_known"_a = inertial.scale_known,
                  "reason"_a = inertial.scale_reason,
                  "velocities_m_s"_a = view_vectors(inertial.velocities_m_s, result.inertial),
                  "timestamps_ns"_a = view_integers(inertial.times_ns, result.inertial),
                  "accelerometer_bias_m_s2"_a = inertial.accelerometer_bias_m_s2);
}

std::optional<std::string> readiness_of(const Solved& result) {
  const auto& verdict = result.initialization->verdict;
  return verdict ? std::optional(std::string(to_string(verdict->readiness))) : std::nullopt;
}

using SolvedClass = py::class_<Solved>;

void bind_verdict(SolvedClass& solved) {
  solved.def_property_readonly("ok", [](const Solved& r) { return r->ok; })
      .def_property_readonly(
          "reason", [](const Solved& r) { return r->reason; }, "why it failed, or empty")
      .def_property_readonly(
          "readiness",
          &readiness_of,
          "'ready', 'weak', 'degenerate' or 'no plane'; None if there is no verdict")
      .def_property_readonly(
          "verdict",
          [](const Solved& r) { return r->verdict ? r->verdict->reason : std::string(); },
          "one sentence about the readiness");
}

template <auto member>
py::array poses_of(const Solved& result) {
  return view_members<Pose>(result->cameras, member, result.initialization);
}

void bind_poses_and_points(SolvedClass& solved) {
  solved
      .def_property_readonly("R_wc",
                             &poses_of<&Pose::R_wc>,
                             "(N, 3, 3), camera to world, for each frame of the window")
      .def_property_readonly(
          "p_wc", &poses_of<&Pose::p_wc>, "(N, 3) camera centers [plane distances]")
      .def_property_readonly(
          "points",
          [](const Solved& r) {
            return view_members<MapPoint>(r->points, &MapPoint::position, r.initialization);
          },
          "(M, 3) [plane distances]")
      .def_property_readonly(
          "point_tracks", &point_tracks_of, "(M,) int32: index of each point's track in `ids`")
      .def_property_readonly(
          "ids",
          [](const Solved& r) { return view_integers(*r.ids, r.ids); },
          "(T,) int64, ids of the window's tracks");
}

void bind_planes_and_sensors(SolvedClass& solved) {
  solved
      .def_property_readonly(
          "normal",
          [](const Solved& r) { return r->plane.normal; },
          "(3,) leading plane's normal in the reference camera: normal . x + distance = 0")
      .def_property_readonly(
          "normal_sigma_deg",
          [](const Solved& r) {
            return r->uncertainty ? std::optional(r->uncertainty->normal_sigma_deg) : std::nullopt;
          },
          "standard deviation of the normal [deg], or None; an exact lens if the camera states no "
          "uncertainty")
      .def_property_readonly(
          "typical_lens_sigma_deg",
          [](const Solved& r) {
            return r->uncertainty ? r->uncertainty->typical_lens_sigma_deg : std::nullopt;
          },
          "the same with a typical calibration [deg]; None if the camera states its uncertainty")
      .def_property_readonly(
          "bias_rad_s",
          [](const Solved& r) { return r->bias_rad_s; },
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
          "accelerometer_bias_m_s2 (3,)}");
}

void bind_solved(py::module_& module) {
  SolvedClass solved(module,
                     "Initialization",
                     "The result of every method. World: the window's first camera; unit: the "
                     "distance of the leading plane. Arrays are read-only views.");
  bind_verdict(solved);
  bind_poses_and_points(solved);
  bind_planes_and_sensors(solved);
}

py::array frame_image(const OpenRecording& open, int frame) {
  const SharedRecording& recording = open.shared;
  if (!recording->images) throw InputError(recording->name + " has no images");
  const int count = recording->frame_count();
  if (frame < 0 || frame >= count)
    throw py::index_error(
        fmt::format("frame {} of {}, which has {}", frame, recording->name, count));
  return view_image(interruptible([&](const auto&) { return recording->images->bgr(frame); }));
}

py::object gyroscope_arrays(const OpenRecording& open) {
  const SharedRecording& recording = open.shared;
  if (!recording->gyroscope) return py::none();
  const Gyroscope& gyro = *recording->gyroscope;
  const auto vectors = [&](const std::vector<Eigen::Vector3d>& all) -> py::object {
    if (all.empty()) return py::none();
    return view_vectors(all, recording);
  };
  const auto& body = recording->T_body_camera;
  return py::dict("timestamps_ns"_a = view_integers(gyro.timestamps_ns, recording),
                  "rates_rad_s"_a = vectors(gyro.rates_rad_s),
                  "accelerations_m_s2"_a = vectors(gyro.accelerations_m_s2),
                  "R_gyro_camera"_a = gyro.R_gyro_camera,
                  "time_offset_ns"_a = gyro.time_offset_ns,
                  "bias_rad_s"_a = gyro.bias_rad_s,
                  "bias_sigma_rad_s"_a = gyro.bias_sigma_rad_s,
                  "bias_known"_a = gyro.bias_known,
                  "noise_density"_a = gyro.noise_density,
                  "p_gyro_camera_m"_a = body ? std::optional(body->p_wc) : std::nullopt);
}

/// Returns None or the true poses, NaN for frames without a pose.
py::object truth_of(const OpenRecording& open) {
  const SharedRecording& recording = open.shared;
  if (!recording->truth) return py::none();
  auto poses = std::make_shared<std::vector<Pose>>();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& pose : recording->truth->poses)
    poses->push_back(
        pose.value_or(Pose{Eigen::Matrix3d::Constant(nan), Eigen::Vector3d::Constant(nan)}));
  py::dict result;
  result["R_wc"] = view_members<Pose>(*poses, &Pose::R_wc, poses);
  result["p_wc"] = view_members<Pose>(*poses, &Pose::p_wc, poses);
  if (recording->plane) {
    result["normal"] = recording->plane->normal;
    result["distance"] = recording->plane->distance;
  }
  return result;
}

void bind_recording(py::module_& module) {
  using Open = OpenRecording;
  py::class_<Open>(module, "Recording", "A recorded sequence. Arrays are read-only views.")
      .def_property_readonly("name", [](const Open& r) { return r.shared->name; })
      .def_property_readonly("layout", [](const Open& r) { return r.shared->layout; })
      .def_property_readonly("path", [](const Open& r) { return r.shared->path.string(); })
      .def_property_readonly("notes", [](const Open& r) { return r.shared->notes; })
      .def("__len__", [](const Open& r) { return r.shared->frame_count(); })
      .def_property_readonly(
          "timestamps_ns",
          [](const Open& r) { return view_integers(r.shared->timestamps_ns, r.shared); },
          "(N,) int64 [ns]")
      .def_property_readonly(
          "camera", [](const Open& r) { return r.shared->camera; }, "Camera with K and lens")
      .def_property_readonly(
          "camera_source",
          [](const Open& r) { return std::string(to_string(r.shared->camera_source)); },
          "file, self-calibrated or guess")
      .def("frame", &frame_image, py::arg("frame"), "(H, W, 3) uint8, BGR, read-only")
      .def_property_readonly("gyroscope",
                             &gyroscope_arrays,
                             "None, or {timestamps_ns (M,), rates_rad_s (M, 3), accelerations_m_s2 "
                             "(M, 3) or None, R_gyro_camera (3, 3), time_offset_ns, bias_rad_s "
                             "(3,), bias_sigma_rad_s, "
                             "bias_known, noise_density [rad/s/sqrt(Hz)], p_gyro_camera_m (3,) or "
                             "None}")
      .def_property_readonly(
          "truth",
          &truth_of,
          "None, or {R_wc (N, 3, 3), p_wc (N, 3) [m], normal (3,), distance [m]}; "
          "NaN where a frame has no pose")
      .def("__repr__", [](const Open& r) {
        const Recording& it = *r.shared;
        return fmt::format(
            "<gpo.Recording {}: {}, {} frames>", it.name, it.layout, it.frame_count());
      });
  module.def(
      "open",
      [](const std::string& path) { return OpenRecording{opened(path)}; },
      py::arg("path"),
      "Opens any recording or recipe that the command line accepts. Raises InputError.");
}

}  // namespace

SharedRecording opened(const RecordingOrPath& recording) {
  if (const auto* open = std::get_if<OpenRecording>(&recording)) return open->shared;
  const std::string& path = std::get<std::string>(recording);
  return interruptible([&](const auto&) { return open_given(path); });
}

Settings settings_of(const py::kwargs& given) {
  Settings settings;
  if (given.contains("preset"))
    settings =
        with_preset(std::move(settings), choice<Preset>(std::string(py::str(given["preset"]))));
  for (const auto& [key, value] : given) {
    const std::string name = py::str(key);
    if (name == "preset" || value.is_none()) continue;
    settings = with_setting(std::move(settings), name, setting_text_of(value));
  }
  return settings;
}

}  // namespace gpo

PYBIND11_MODULE(_gpo, module) {
  gpo::silence_libraries();
  pybind11::register_exception<gpo::InputError>(module, "InputError", PyExc_ValueError);
  module.attr("__version__") = GPO_VERSION;
  gpo::bind_solved(module);
  gpo::bind_recording(module);
  gpo::bind_initialize(module);
  gpo::bind_results(module);
}
