// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The Python module `gpo` without recordings and views, which `recordings.cpp` and `views.cpp` load
// when they are used.
#include "app/python/bindings.h"
#include "engine/base/error.h"
#include "engine/methods/plane/rolling_shutter.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <opencv2/core/ocl.hpp>
#include <opencv2/core/utils/logger.hpp>

namespace gpo {
namespace {

using namespace py::literals;

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

/// Returns inlier masks of frames and tracks.
py::array inliers_of(const Solved& result) {
  const Window& window = *result.window;
  py::array_t<bool> mask({window.frame_count(), window.track_count()});
  for (int i = 0; i < window.frame_count(); ++i)
    for (int j = 0; j < window.track_count(); ++j) mask.mutable_at(i, j) = window.inlier[i][j];
  return mask;
}

/// Returns undistorted minus projected pixels of frames and tracks; NaN without a point.
py::array residuals_of(const Solved& result) {
  const Window window = as_seen_at_time_stamps(*result.window, *result);
  py::array_t<double> residuals({window.frame_count(), window.track_count(), 2});
  std::fill_n(residuals.mutable_data(), residuals.size(), std::nan(""));
  for (int i = 0; i < std::ssize(result->cameras); ++i) {
    for (const auto& [track, position] : result->points) {
      const Eigen::Vector3d seen = window.K * to_camera(result->cameras[i], position);
      if (seen.z() > 0)
        Eigen::Vector2d::Map(residuals.mutable_data(i, track)) =
            window.points_px[i].col(track) - seen.hnormalized();
    }
  }
  return residuals;
}

/// Returns None without uncertainty.
py::object center_covariances_of(const Solved& result) {
  if (!result->uncertainty) return py::none();
  const auto& covariances = result->uncertainty->center_covariances;
  return view_array(covariances.empty() ? nullptr : covariances.front().data(),
                    {std::ssize(covariances), 3, 3},
                    {sizeof(Eigen::Matrix3d), sizeof(double), 3 * sizeof(double)},
                    result.initialization);
}

using SolvedClass = py::class_<Solved>;

void bind_verdict(SolvedClass& solved) {
  const AddField add{solved};
  add("ok", &Initialization::ok);
  add("reason", &Initialization::reason, "why it failed, or empty");
  add("readiness",
      &readiness_of,
      "'ready', 'weak', 'degenerate' or 'no plane'; None if there is no verdict");
  add(
      "verdict",
      [](const Solved& r) { return r->verdict ? r->verdict->reason : std::string(); },
      "one sentence about the readiness");
}

template <auto member>
py::array poses_of(const Solved& result) {
  return view_members<Pose>(result->cameras, member, result.initialization);
}

void bind_poses_and_points(SolvedClass& solved) {
  const AddField add{solved};
  add("R_wc", &poses_of<&Pose::R_wc>, "(N, 3, 3), camera to world, for each frame of the window");
  add("p_wc", &poses_of<&Pose::p_wc>, "(N, 3) camera centers [plane distances]");
  add("center_covariances",
      &center_covariances_of,
      "(N, 3, 3) of p_wc by the noise of the tracks and the lens, or None");
  add(
      "points",
      [](const Solved& r) {
        return view_members<MapPoint>(r->points, &MapPoint::position, r.initialization);
      },
      "(M, 3) [plane distances]");
  add("point_tracks", &point_tracks_of, "(M,) int32: index of each point's track in `ids`");
  add(
      "ids",
      [](const Solved& r) { return view_integers(*r.ids, r.ids); },
      "(T,) int64, ids of the window's tracks");
  add("inliers", &inliers_of, "(N, T) bool: in which frames each track agrees with its plane");
  add("residuals",
      &residuals_of,
      "(N, T, 2) undistorted minus projected pixels; NaN if not seen or without a point");
}

void bind_planes_and_sensors(SolvedClass& solved) {
  const AddField add{solved};
  add(
      "normal",
      [](const Solved& r) { return r->ok ? std::optional(r->plane.normal) : std::nullopt; },
      "(3,) leading plane's normal in the reference camera: normal . x + distance = 0; None if "
      "it failed");
  add(
      "normal_sigma_deg",
      [](const Solved& r) {
        return r->uncertainty ? std::optional(r->uncertainty->normal_sigma_deg) : std::nullopt;
      },
      "standard deviation of the normal [deg], or None; an exact lens if the camera states no "
      "uncertainty");
  add(
      "typical_lens_sigma_deg",
      [](const Solved& r) {
        return r->uncertainty ? r->uncertainty->typical_lens_sigma_deg : std::nullopt;
      },
      "the same with a typical calibration [deg]; None if the camera states its uncertainty");
  add(
      "rms_px",
      [](const Solved& r) { return r->ok ? std::optional(r->rms_px) : std::nullopt; },
      "root mean square of the method's own errors [px]; None if it failed");
  add("transfer_rms_px",
      &Initialization::transfer_rms_px,
      "root mean square distance to the transferred reference positions [px], or None");
  add("reprojection_rms_px",
      &Initialization::reprojection_rms_px,
      "root mean square distance to the projected map points [px], or None");
  add("bias_rad_s", &Initialization::bias_rad_s, "(3,) gyroscope bias [rad/s], or None");
  add("planes",
      &planes_of,
      "[{number, normal (3,), distance, normal_covariance_rad2 (3, 3), tracks: ids}], "
      "the leading plane first");
  add("inertial",
      &inertial_of,
      "None without an accelerometer, else {gravity_m_s2 (3,): down, in the reference camera, "
      "gravity_sigma_deg, scale [m per plane distance], log_scale_sigma, scale_known, reason: "
      "why the scale is unknown, velocities_m_s (K, 3), timestamps_ns (K,), "
      "accelerometer_bias_m_s2 (3,)}");
}

/// Returns a short table for notebooks.
std::string html_of(const py::object& self) {
  const py::object escape = py::module_::import("html").attr("escape");
  std::string rows;
  const auto add = [&](const char* name, const py::object& value) {
    rows += fmt::format(
        "<tr><th>{}</th><td>{}</td></tr>", name, std::string(py::str(escape(py::str(value)))));
  };
  for (const char* name : {"ok", "reason", "readiness", "verdict", "normal", "normal_sigma_deg"})
    add(name, self.attr(name));
  add("frames", py::int_(py::len(self.attr("R_wc"))));
  add("points", py::int_(py::len(self.attr("points"))));
  add("planes", py::int_(py::len(self.attr("planes"))));
  return "<table>" + rows + "</table>";
}

void bind_solved(py::module_& module) {
  SolvedClass solved(module,
                     "Initialization",
                     "The result of every method. World: the window's first camera; unit: the "
                     "distance of the leading plane. Arrays are read-only.");
  bind_verdict(solved);
  bind_poses_and_points(solved);
  bind_planes_and_sensors(solved);
  solved.attr("__module__") = "gpo";
  solved.def("_repr_html_", &html_of);
}

}  // namespace
}  // namespace gpo

PYBIND11_MODULE(_gpo, module) {
  // OpenCV's log and OpenCL, which the engine does not use.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  cv::ocl::setUseOpenCL(false);
  pybind11::register_exception<gpo::InputError>(module, "InputError", PyExc_ValueError)
      .attr("__module__") = "gpo";
  module.attr("__version__") = GPO_VERSION;
  gpo::bind_solved(module);
  gpo::bind_initialize(module);
}
