// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/python/bindings.h"
#include "app/recordings/recordings.h"
#include "engine/base/error.h"

#include <limits>

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

namespace gpo {
namespace {

namespace py = pybind11;

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
  py::dict result;
  result["timestamps_ns"] = view_integers(gyro.timestamps_ns, recording);
  result["rates_rad_s"] = vectors(gyro.rates_rad_s);
  result["accelerations_m_s2"] = vectors(gyro.accelerations_m_s2);
  result["R_gyro_camera"] = gyro.R_gyro_camera;
  result["time_offset_ns"] = gyro.time_offset_ns;
  result["bias_rad_s"] = gyro.bias_rad_s;
  result["bias_sigma_rad_s"] = gyro.bias_sigma_rad_s;
  result["bias_known"] = gyro.bias_known;
  result["noise_density"] = gyro.noise_density;
  result["p_gyro_camera_m"] =
      recording->T_body_camera ? py::cast(recording->T_body_camera->p_wc) : py::none();
  return result;
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
  result["R_wc"] = view_rotations(*poses, poses);
  result["p_wc"] = view_vectors<Pose>(*poses, &Pose::p_wc, poses);
  if (recording->plane) {
    result["normal"] = recording->plane->normal;
    result["distance"] = recording->plane->distance;
  }
  return result;
}

}  // namespace

SharedRecording opened(const RecordingOrPath& recording) {
  if (const auto* open = std::get_if<OpenRecording>(&recording)) return open->shared;
  const std::string& path = std::get<std::string>(recording);
  return interruptible([&](const auto&) { return open_given(path); });
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
        return fmt::format("<gpo.Recording {}: {}, {} frames>",
                           r.shared->name,
                           r.shared->layout,
                           r.shared->frame_count());
      });
  module.def(
      "open",
      [](const std::string& path) { return OpenRecording{opened(path)}; },
      py::arg("path"),
      "Opens any recording or recipe that the command line accepts. Raises InputError.");
}

}  // namespace gpo
