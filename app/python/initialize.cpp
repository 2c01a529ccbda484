// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Python bindings of engine/initialize.h and live.h: tracks of any front end.
#include "engine/initialize.h"

#include "app/python/bindings.h"
#include "engine/base/error.h"
#include "engine/live.h"

#include <map>

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

namespace gpo {
namespace {

/// Python's WindowResult.
struct TrackedWindow : Solved {
  explicit TrackedWindow(std::shared_ptr<const WindowResult> window)
      : Solved{{window, &window->initialization},
               {window, &window->window},
               {window, &window->ids},
               {window, window->inertial ? &*window->inertial : nullptr}},
        shared(std::move(window)) {}
  std::shared_ptr<const WindowResult> shared;
};

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Ids = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
/// K alone is a camera without distortion.
using CameraOrK = std::variant<Camera, Numbers>;

Eigen::Matrix3d matrix_of(const Numbers& rows, const char* name) {
  if (rows.ndim() != 2 || rows.shape(0) != 3 || rows.shape(1) != 3)
    throw InputError(fmt::format("expected {} (3, 3)", name));
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

Eigen::MatrixXd square_of(const Numbers& rows) {
  if (rows.ndim() != 2 || rows.shape(0) != rows.shape(1))
    throw InputError("expected covariance (n, n)");
  const Eigen::MatrixXd square = Eigen::MatrixXd::Map(rows.data(), rows.shape(0), rows.shape(0));
  if (square != square.transpose()) throw InputError("expected a symmetric covariance");
  return square;
}

/// Returns the rows of (m, 3), or the one of (3,). Throws InputError.
std::vector<Eigen::Vector3d> vectors_of(const Numbers& rows, const char* name) {
  if (rows.ndim() == 0 || rows.shape(rows.ndim() - 1) != 3)
    throw InputError(fmt::format("gyroscope: expected {} (3,), or (m, 3)", name));
  std::vector<Eigen::Vector3d> vectors;
  for (const double* row = rows.data(); row < rows.data() + rows.size(); row += 3)
    vectors.emplace_back(row);
  return vectors;
}

const std::map<std::string, Distortion> kLenses = {
    {"none", Distortion::none},
    {"radial-tangential", Distortion::radial_tangential},
    {"equidistant", Distortion::equidistant},
};

Camera camera_of(const Eigen::Matrix3d& K,
                 std::pair<int, int> size,
                 std::vector<double> distortion,
                 const std::string& model) {
  const auto lens = kLenses.find(model);
  if (lens == kLenses.end())
    throw InputError(
        fmt::format("model: {}, expected none, radial-tangential or equidistant", model));
  const Distortion kind = distortion.empty() ? Distortion::none : lens->second;
  const auto [width, height] = size;
  return {width, height, K(0, 0), K(1, 1), K(0, 2), K(1, 2), kind, std::move(distortion)};
}

Camera camera_of(const CameraOrK& given) {
  if (const auto* camera = std::get_if<Camera>(&given)) return *camera;
  return camera_of(matrix_of(std::get<Numbers>(given), "K"), {0, 0}, {}, "none");
}

Frame frame_of(std::int64_t timestamp_ns,
               const Ids& ids,
               const Numbers& pixels,
               const std::optional<Numbers>& R_wc) {
  if (ids.ndim() != 1 || pixels.ndim() != 2 || pixels.shape(1) != 2)
    throw InputError("expected ids (n,) and pixels (n, 2)");
  return {.timestamp_ns = timestamp_ns,
          .ids = {ids.data(), ids.data() + ids.size()},
          .raw_px = Eigen::Map<const Eigen::Matrix2Xd>(pixels.data(), 2, pixels.shape(0)),
          .R_wc = R_wc ? std::optional(matrix_of(*R_wc, "R_wc")) : std::nullopt};
}

/// Throws InputError with the given message if the object has another type.
template <class T>
T cast(const py::handle& given, const std::string& otherwise) {
  try {
    return given.cast<T>();
  } catch (const py::cast_error&) {
    throw InputError(otherwise);
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
    throw InputError(otherwise);
  }
}

Frame frame_of(const py::handle& given, std::size_t number) {
  const std::string expected =
      fmt::format("frame {}: expected numbers (timestamp_ns, ids, pixels[, R_wc])", number);
  const auto parts = cast<py::sequence>(given, expected);
  if (parts.size() != 3 && parts.size() != 4) throw InputError(expected);
  const auto time_ns = cast<std::int64_t>(parts[0], expected);
  const auto ids = cast<Ids>(parts[1], expected);
  const auto pixels = cast<Numbers>(parts[2], expected);
  using Rotation = std::optional<Numbers>;
  const auto R_wc = parts.size() == 4 ? cast<Rotation>(parts[3], expected) : Rotation();
  try {
    return frame_of(time_ns, ids, pixels, R_wc);
  } catch (const InputError& error) {
    throw InputError(fmt::format("frame {}: {}", number, error.what()));
  }
}

template <class T>
void take(const py::dict& given, const char* key, T& field) {
  if (given.contains(key))
    field = cast<T>(given[key], fmt::format("gyroscope: {} has another type", key));
}

/// Converts a dict with the keys of `Recording.gyroscope`; defaults are those of a phone.
std::optional<Gyroscope> gyroscope_of(const std::optional<py::dict>& given) {
  if (!given) return std::nullopt;
  const auto vectors = [&](const char* key) {
    Numbers rows(std::vector<py::ssize_t>{0, 3});
    take(*given, key, rows);
    return vectors_of(rows, key);
  };
  Gyroscope gyroscope;
  take(*given, "timestamps_ns", gyroscope.timestamps_ns);
  take(*given, "time_offset_ns", gyroscope.time_offset_ns);
  take(*given, "bias_sigma_rad_s", gyroscope.bias_sigma_rad_s);
  take(*given, "bias_known", gyroscope.bias_known);
  take(*given, "noise_density", gyroscope.noise_density);
  gyroscope.rates_rad_s = vectors("rates_rad_s");
  const char* accelerations = "accelerations_m_s2";
  const bool sampled = given->contains("timestamps_ns") && given->contains(accelerations);
  if (sampled && !(*given)[accelerations].is_none())
    gyroscope.accelerations_m_s2 = vectors(accelerations);
  if (given->contains("bias_rad_s")) gyroscope.bias_rad_s = vectors("bias_rad_s").front();
  if (Numbers axes; given->contains("R_gyro_camera")) {
    take(*given, "R_gyro_camera", axes);
    gyroscope.R_gyro_camera = matrix_of(axes, "gyroscope: R_gyro_camera");
  }
  return gyroscope;
}

/// Returns the settings with the gyroscope's lever arm. Throws InputError for those of tracking.
InitializeOptions options_of_keywords(const py::kwargs& given,
                                      const std::optional<py::dict>& gyroscope) {
  for (const auto& [key, value] : given) {
    const std::string name = py::str(key);
    if (name == "preset")
      throw InputError("preset: applies to recordings; expected single settings");
    if (find_setting(name).stage == SettingStage::tracks || name == "exclude")
      throw InputError(name + ": applies to recordings; the frames given are the window");
  }
  InitializeOptions options = settings_of(given).options;
  constexpr const char* kLever = "p_gyro_camera_m";
  if (gyroscope && gyroscope->contains(kLever) && !(*gyroscope)[kLever].is_none()) {
    Numbers lever;
    take(*gyroscope, kLever, lever);
    options.p_gyro_camera_m = vectors_of(lever, kLever).front();
  }
  return options;
}

TrackedWindow initialized(const CameraOrK& camera,
                          const py::iterable& frames,
                          const std::optional<py::dict>& gyroscope,
                          bool camera_is_guess,
                          const py::kwargs& given) {
  std::vector<Frame> window;
  for (const py::handle frame : frames) window.push_back(frame_of(frame, window.size()));
  InitializeOptions options = options_of_keywords(given, gyroscope);
  options.camera_is_guess = camera_is_guess;
  const auto gyro = gyroscope_of(gyroscope);
  const Camera calibrated = camera_of(camera);
  return TrackedWindow(interruptible([&](const std::stop_token& stop) {
    return std::make_shared<const WindowResult>(
        initialize(calibrated, window, gyro ? &*gyro : nullptr, options, stop));
  }));
}

py::array undistorted(const Camera& camera, const Numbers& pixels) {
  if (pixels.ndim() != 2 || pixels.shape(1) != 2) throw InputError("expected pixels (n, 2)");
  Numbers result(std::vector<py::ssize_t>{pixels.shape(0), 2});
  for (py::ssize_t i = 0; i < pixels.shape(0); ++i)
    Eigen::Vector2d::Map(result.mutable_data(i, 0)) =
        undistort(camera, Eigen::Vector2d::Map(pixels.data(i, 0)));
  return result;
}

void bind_camera(py::module_& module) {
  py::class_<Camera>(
      module,
      "Camera",
      "A calibrated camera. Pixel centers at integers, also for K of the undistorted image.")
      .def(py::init([](const Numbers& K,
                       std::pair<int, int> size,
                       std::vector<double> distortion,
                       const std::string& model,
                       const std::optional<Numbers>& covariance,
                       std::optional<double> readout_s,
                       std::optional<double> readout_sigma_s,
                       const std::optional<std::string>& readout_direction) {
             Camera camera = camera_of(matrix_of(K, "K"), size, std::move(distortion), model);
             if (covariance) set_lens_covariance(camera, square_of(*covariance));
             if (readout_s) camera.readout = gpo::readout_of(*readout_s);
             if (readout_s && readout_sigma_s) camera.readout->sigma_s = *readout_sigma_s;
             if (readout_direction)
               camera.readout_direction = choice<ReadoutDirection>(*readout_direction);
             if (covariance) check_camera(camera);
             return camera;
           }),
           py::arg("K"),
           py::arg("size") = std::pair(0, 0),
           py::arg("distortion") = std::vector<double>(),
           py::arg("model") = "radial-tangential",
           py::arg("covariance") = py::none(),
           py::arg("readout_s") = py::none(),
           py::arg("readout_sigma_s") = py::none(),
           py::arg("readout_direction") = py::none(),
           "K (3, 3) [px], size (width, height) [px], distortion in OpenCV's order, model: none, "
           "radial-tangential or equidistant; covariance (n, n) of fx, fy, cx, cy and distortion: "
           "zeros for an exact camera; readout_s: time from the first row to the last, its "
           "standard deviation, and the direction: down, left, up or right")
      .def_property_readonly(
          "readout_s",
          [](const Camera& c) {
            return c.readout ? std::optional(c.readout->seconds) : std::nullopt;
          },
          "time from the first row to the last [s]; None if unknown")
      .def_property_readonly(
          "readout_sigma_s",
          [](const Camera& c) {
            return c.readout ? std::optional(c.readout->sigma_s) : std::nullopt;
          },
          "its standard deviation [s]")
      .def_property_readonly("K", &intrinsic_matrix, "(3, 3) [px]")
      .def_property_readonly(
          "size",
          [](const Camera& c) { return std::pair(c.width, c.height); },
          "(width, height) [px]")
      .def_property_readonly(
          "distortion",
          [](const Camera& c) { return py::array(py::cast(c.coefficients)); },
          "in OpenCV's order: k1 k2 p1 p2 (k3 ...), or k1 to k4 of a fisheye")
      .def("undistort",
           &undistorted,
           py::arg("pixels"),
           "(n, 2) pixels of a camera with the same K but no distortion; NaN outside the model");
}

void bind_status(py::module_& module) {
  py::class_<LiveStatus>(module, "LiveStatus", "State of an Initializer after a frame.")
      .def_readonly("ready", &LiveStatus::ready)
      .def_readonly(
          "metric", &LiveStatus::metric, "whether the metric scale of the answer is known")
      .def_readonly("reference", &LiveStatus::reference, "index of the window's first frame")
      .def_readonly("frames", &LiveStatus::frames, "length of the window")
      .def_readonly("ready_frames",
                    &LiveStatus::ready_frames,
                    "length of the shortest window that was solved and is ready; wait solves all")
      .def_readonly("solved_frames", &LiveStatus::solved_frames)
      .def_readonly("pending", &LiveStatus::pending)
      .def_readonly(
          "waiting", &LiveStatus::waiting, "frames that wait for samples of the gyroscope")
      .def_readonly("started_anew", &LiveStatus::started_anew)
      .def_readonly("reason", &LiveStatus::reason)
      .def_property_readonly(
          "answer",
          [](const LiveStatus& s) {
            return s.answer ? std::optional(TrackedWindow(s.answer)) : std::nullopt;
          },
          "Initialized or None")
      .def("__repr__", [](const LiveStatus& s) {
        return fmt::format(
            "<gpo.LiveStatus {} frames: {}>", s.frames, s.ready ? "ready" : s.reason);
      });
}

py::class_<LiveInitializer> live_class(py::module_& module) {
  const LiveOptions usual;
  py::class_<LiveInitializer> live(
      module,
      "Initializer",
      "A window that grows with each frame until it is ready. With background (the default), "
      "windows are solved on another thread and add_frame returns at once.");
  live.def(py::init([](const CameraOrK& camera,
                       const std::optional<py::dict>& gyroscope,
                       bool background,
                       int most_frames,
                       int least_tracks,
                       double least_share,
                       const py::kwargs& given) {
             const InitializeOptions all = options_of_keywords(given, gyroscope);
             const LiveOptions options{all, background, most_frames, least_tracks, least_share};
             return std::make_unique<LiveInitializer>(
                 camera_of(camera), options, gyroscope_of(gyroscope));
           }),
           py::arg("camera"),
           py::arg("gyroscope") = py::none(),
           py::arg("background") = usual.background,
           py::arg("most_frames") = usual.most_frames,
           py::arg("least_tracks") = usual.least_tracks,
           py::arg("least_share") = usual.least_share);
  return live;
}

void bind_live(py::module_& module) {
  live_class(module)
      .def(
          "add_gyroscope",
          [](LiveInitializer& live, std::int64_t timestamp_ns, const Numbers& rate_rad_s) {
            live.add_gyroscope(timestamp_ns, vectors_of(rate_rad_s, "rate_rad_s").front());
          },
          py::arg("timestamp_ns"),
          py::arg("rate_rad_s"),
          "Adds one sample, (3,) in the gyroscope's axes, in order of time, before or after its "
          "frame")
      .def(
          "add_imu",
          [](LiveInitializer& live,
             std::int64_t timestamp_ns,
             const Numbers& rate_rad_s,
             const Numbers& acceleration_m_s2) {
            live.add_imu(timestamp_ns,
                         vectors_of(rate_rad_s, "rate_rad_s").front(),
                         vectors_of(acceleration_m_s2, "acceleration_m_s2").front());
          },
          py::arg("timestamp_ns"),
          py::arg("rate_rad_s"),
          py::arg("acceleration_m_s2"),
          "Adds one sample with the accelerometer's specific force, (3,) in the same axes")
      .def(
          "add_frame",
          [](LiveInitializer& live,
             std::int64_t timestamp_ns,
             const Ids& ids,
             const Numbers& pixels,
             const std::optional<Numbers>& R_wc) {
            const Frame frame = frame_of(timestamp_ns, ids, pixels, R_wc);
            const py::gil_scoped_release others_may_run;
            return live.add_frame(frame);
          },
          py::arg("timestamp_ns"),
          py::arg("ids"),
          py::arg("pixels"),
          py::arg("R_wc") = py::none(),
          "Adds ids (n,), raw pixels (n, 2) and, if known, R_wc (3, 3)")
      .def_property_readonly("status", &LiveInitializer::status)
      .def("wait",
           &LiveInitializer::wait,
           py::call_guard<py::gil_scoped_release>(),
           "Solves all windows that samples cover, with those that were skipped");
}

}  // namespace

void bind_initialize(py::module_& module) {
  bind_camera(module);
  py::class_<TrackedWindow, Solved>(module, "Initialized", "One initialization of given tracks.")
      .def_property_readonly("is_ready",
                             [](const TrackedWindow& w) { return w.shared->is_ready(); })
      .def_property_readonly(
          "why_not_ready",
          [](const TrackedWindow& w) { return w.shared->why_not_ready(); },
          "one sentence; empty if it is")
      .def_property_readonly(
          "rotations_note",
          [](const TrackedWindow& w) { return w.shared->rotations_note; },
          "why another source of rotations was not used")
      .def_property_readonly(
          "rotations",
          [](const TrackedWindow& w) { return std::string(to_string(w.shared->rotations)); },
          "source of the rotations")
      .def("__repr__", [](const TrackedWindow& w) {
        return fmt::format("<gpo.Initialized: {}>",
                           w.initialization->ok ? "ok" : w.initialization->reason);
      });
  module.def(
      "initialize",
      &initialized,
      py::arg("camera"),
      py::arg("frames"),
      py::arg("gyroscope") = py::none(),
      py::arg("camera_is_guess") = false,
      "Estimates cameras, points and planes from tracks of any front end, bit for bit like `run` "
      "from the same tracks. camera: Camera, or K (3, 3) of undistorted pixels. frames: "
      "(timestamp_ns, ids (n,), pixels (n, 2)[, R_wc (3, 3)]) each. gyroscope: a dict like "
      "`Recording.gyroscope`. Settings are those of `run`: method, rotations, planes, ... "
      "Raises InputError. A failed initialization is not ok and has the reason.");
  bind_status(module);
  bind_live(module);
}

}  // namespace gpo
