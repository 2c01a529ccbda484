// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Python bindings of engine/initialize.h and live.h: tracks of any front end.
#include "app/python/bindings.h"
#include "engine/base/error.h"
#include "engine/live.h"

#include <thread>
#include <tuple>

#include <fmt/format.h>

namespace gpo {
namespace {

TrackedWindow initialized(const CameraOrK& camera,
                          const py::iterable& frames,
                          const std::optional<py::dict>& gyroscope,
                          bool camera_is_guess,
                          py::kwargs given) {
  std::optional<Method> own;
  if (given.contains("method") && PyCallable_Check(given["method"].ptr()) != 0)
    own = callable_method(given.attr("pop")("method"), 0);
  std::vector<Frame> window;
  for (const py::handle frame : frames) window.push_back(frame_of(frame, window.size()));
  InitializeOptions options = options_of_keywords(given, gyroscope);
  options.camera_is_guess = camera_is_guess;
  if (own) options.method = MethodChoice(std::make_shared<const Method>(std::move(*own)));
  const auto gyro = gyroscope_of(gyroscope);
  const Camera calibrated = camera_of(camera);
  const auto result = interruptible([=](const std::stop_token& stop) {
    return std::make_shared<const WindowResult>(
        initialize(calibrated, window, gyro ? &*gyro : nullptr, options, stop));
  });
  return {result, calibrated, options};
}

py::array undistorted(const Camera& camera, const Numbers& pixels) {
  const auto raw_px = pixels_of(pixels);
  Numbers result(std::vector<py::ssize_t>{raw_px.cols(), 2});
  for (Eigen::Index i = 0; i < raw_px.cols(); ++i)
    Eigen::Vector2d::Map(result.mutable_data(i, 0)) = undistort(camera, raw_px.col(i));
  return result;
}

/// Returns everything that a camera has, for pickle.
py::tuple state_of(const Camera& c) {
  const auto direction = c.readout_direction;
  return py::make_tuple(
      std::vector<double>{c.fx, c.fy, c.cx, c.cy},
      std::pair(c.width, c.height),
      static_cast<int>(c.distortion),
      c.coefficients,
      c.sigmas,
      c.covariance,
      c.readout ? std::optional(std::pair(c.readout->seconds, c.readout->sigma_s)) : std::nullopt,
      direction ? std::optional(static_cast<int>(*direction)) : std::nullopt);
}

Camera camera_from(const py::tuple& state) {
  using Doubles = std::vector<double>;
  const auto K = state[0].cast<Doubles>();
  Camera c{.fx = K.at(0), .fy = K.at(1), .cx = K.at(2), .cy = K.at(3)};
  std::tie(c.width, c.height) = state[1].cast<std::pair<int, int>>();
  c.distortion = static_cast<Distortion>(state[2].cast<int>());
  c.coefficients = state[3].cast<Doubles>();
  c.sigmas = state[4].cast<Doubles>();
  c.covariance = state[5].cast<Doubles>();
  if (const auto readout = state[6].cast<std::optional<std::pair<double, double>>>())
    c.readout = {.seconds = readout->first, .sigma_s = readout->second};
  if (const auto direction = state[7].cast<std::optional<int>>())
    c.readout_direction = static_cast<ReadoutDirection>(*direction);
  return c;
}

py::class_<Camera> camera_class(py::module_& module) {
  py::class_<Camera> camera(
      module,
      "Camera",
      "A calibrated camera. Pixel centers at integers, also for K of the undistorted image.");
  camera.attr("__module__") = "gpo";
  camera.def(
      py::init([](const Numbers& K,
                  const py::object& size,
                  const Numbers& distortion,
                  const std::string& model,
                  const std::optional<Numbers>& covariance,
                  std::optional<double> readout_s,
                  std::optional<double> readout_sigma_s,
                  const std::optional<std::string>& readout_direction) {
        Camera made = pinhole_of(K);
        std::tie(made.width, made.height) = size_of(size);
        made.distortion = distortion_of(model, static_cast<std::size_t>(distortion.size()));
        made.coefficients.assign(distortion.data(), distortion.data() + distortion.size());
        if (covariance) set_lens_covariance(made, covariance_of(*covariance));
        if (readout_s) made.readout = gpo::readout_of(*readout_s);
        if (readout_s && readout_sigma_s) made.readout->sigma_s = *readout_sigma_s;
        if (readout_direction)
          made.readout_direction = choice<ReadoutDirection>(*readout_direction);
        check_camera(made);
        if (readout_s && (made.width == 0 || made.height == 0))
          throw InputError("readout_s: expected the camera's size, too");
        if (readout_sigma_s && !readout_s)
          throw InputError("readout_sigma_s: expected readout_s, too");
        return made;
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
      "radial-tangential, equidistant, double-sphere, extended-unified, omnidirectional, "
      "field-of-view or thin-prism-fisheye; covariance (n, n) of fx, fy, cx, cy and distortion: "
      "zeros for an exact camera; readout_s: time from the first row to the last, its "
      "standard deviation, and the direction: down, left, up or right");
  return camera;
}

void bind_camera(py::module_& module) {
  camera_class(module)
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
      .def_property_readonly(
          "K", [](const Camera& c) { return frozen(py::cast(intrinsic_matrix(c))); }, "(3, 3) [px]")
      .def_property_readonly(
          "size",
          [](const Camera& c) { return std::pair(c.width, c.height); },
          "(width, height) [px]")
      .def_property_readonly(
          "distortion",
          [](const Camera& c) {
            return frozen(py::array_t<double>(std::ssize(c.coefficients), c.coefficients.data()));
          },
          "in OpenCV's order: k1 k2 p1 p2 (k3 ...), or k1 to k4 of a fisheye")
      .def("undistort",
           &undistorted,
           py::arg("pixels"),
           "(n, 2) pixels of a camera with the same K but no distortion; NaN outside the model")
      .def(py::pickle(&state_of, &camera_from))
      .def("__repr__", [](const Camera& c) {
        return fmt::format("<gpo.Camera {}x{}, fx {:.6g}>", c.width, c.height, c.fx);
      });
}

/// Python's LiveStatus. The answer has the camera and options that `Initialized.json` needs.
struct Status : Saved {
  LiveStatus now;
  std::optional<TrackedWindow> answer;

  const LiveStatus& operator*() const { return now; }
};

/// Python's Initializer.
struct Live {
  Camera camera;
  LiveOptions options;
  LiveInitializer initializer;

  Status status_of(LiveStatus now) const {
    Status status{{}, std::move(now), std::nullopt};
    if (status.now.answer) status.answer.emplace(status.now.answer, camera, options.initialize);
    return status;
  }
};

void bind_status(py::module_& module) {
  py::class_<Status> status(module, "LiveStatus", "State of an Initializer after a frame.");
  const AddField add{status};
  add("ready", &LiveStatus::ready);
  add("metric", &LiveStatus::metric, "whether the metric scale of the answer is known");
  add("reference", &LiveStatus::reference, "index of the window's first frame");
  add("frames", &LiveStatus::frames, "length of the window");
  add("ready_frames",
      &LiveStatus::ready_frames,
      "length of the shortest window that was solved and is ready; wait solves all");
  add("solved_frames", &LiveStatus::solved_frames);
  add("pending", &LiveStatus::pending);
  add("waiting", &LiveStatus::waiting, "frames that wait for samples of the gyroscope");
  add("started_anew", &LiveStatus::started_anew);
  add("reason", &LiveStatus::reason);
  add("answer", &Status::answer, "Initialized or None");
  add_saving(status);
  status.def("__repr__", [](const py::object& s) {
    const bool ready = s.attr("ready").cast<bool>();
    return fmt::format("<gpo.LiveStatus {} frames: {}>",
                       s.attr("frames").cast<int>(),
                       ready ? "ready" : s.attr("reason").cast<std::string>());
  });
}

/// Waits until no window is pending, then solves those that were skipped. Ctrl-C raises.
Status waited(Live& live) {
  using namespace std::chrono_literals;
  while (live.initializer.status().pending > 0) {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const py::gil_scoped_release others_may_run;
    std::this_thread::sleep_for(2ms);
  }
  return live.status_of([&] {
    const py::gil_scoped_release others_may_run;
    return live.initializer.wait();
  }());
}

py::class_<Live> live_class(py::module_& module) {
  const LiveOptions usual;
  py::class_<Live> live(
      module,
      "Initializer",
      "A window that grows with each frame until it is ready. With background (the default), "
      "windows are solved on another thread and add_frame returns at once.");
  live.attr("__module__") = "gpo";
  live.def(py::init([](const CameraOrK& given_camera,
                       const std::optional<py::dict>& gyroscope,
                       bool background,
                       int most_frames,
                       int least_tracks,
                       double least_share,
                       const py::kwargs& given) {
             const InitializeOptions all = options_of_keywords(given, gyroscope);
             const LiveOptions options{.initialize = all,
                                       .background = background,
                                       .most_frames = most_frames,
                                       .least_tracks = least_tracks,
                                       .least_share = least_share};
             const Camera camera = camera_of(given_camera);
             return std::unique_ptr<Live>(new Live{
                 camera, options, LiveInitializer(camera, options, gyroscope_of(gyroscope))});
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
          [](Live& live, std::int64_t timestamp_ns, const Numbers& rate_rad_s) {
            live.initializer.add_gyroscope(timestamp_ns, vector_of(rate_rad_s, "rate_rad_s"));
          },
          py::arg("timestamp_ns"),
          py::arg("rate_rad_s"),
          "Adds one sample, (3,) in the gyroscope's axes, in order of time, before or after its "
          "frame")
      .def(
          "add_imu",
          [](Live& live,
             std::int64_t timestamp_ns,
             const Numbers& rate_rad_s,
             const Numbers& acceleration_m_s2) {
            live.initializer.add_imu(timestamp_ns,
                                     vector_of(rate_rad_s, "rate_rad_s"),
                                     vector_of(acceleration_m_s2, "acceleration_m_s2"));
          },
          py::arg("timestamp_ns"),
          py::arg("rate_rad_s"),
          py::arg("acceleration_m_s2"),
          "Adds one sample with the accelerometer's specific force, (3,) in the same axes")
      .def(
          "add_frame",
          [](Live& live,
             std::int64_t timestamp_ns,
             const py::object& ids,
             const py::object& pixels,
             const py::object& R_wc) {
            const Frame frame = frame_of(timestamp_ns, ids, pixels, R_wc);
            return live.status_of([&] {
              const py::gil_scoped_release others_may_run;
              return live.initializer.add_frame(frame);
            }());
          },
          py::arg("timestamp_ns"),
          py::arg("ids"),
          py::arg("pixels"),
          py::arg("R_wc") = py::none(),
          "Adds ids (n,), raw pixels (n, 2; masked ones are not seen) and, if known, R_wc (3, 3)")
      .def_property_readonly(
          "status", [](const Live& live) { return live.status_of(live.initializer.status()); })
      .def("wait", &waited, "Solves all windows that samples cover, with those that were skipped");
}

}  // namespace

namespace {

py::dict json_of_window(const TrackedWindow& window) {
  return py::module_::import("gpo._recordings").attr("_json_of_tracks")(window);
}

}  // namespace

TrackedWindow::TrackedWindow(const std::shared_ptr<const WindowResult>& result,
                             Camera calibrated,
                             InitializeOptions chosen)
    : Solved{{},
             {result, &result->initialization},
             {result, &result->window},
             {result, &result->ids},
             {result, result->inertial ? &*result->inertial : nullptr}},
      shared(result),
      camera(std::move(calibrated)),
      options(std::move(chosen)) {}

void bind_initialize(py::module_& module) {
  bind_camera(module);
  py::class_<TrackedWindow, Solved> window(
      module, "Initialized", "One initialization of given tracks.");
  const AddField add{window};
  add("is_ready", [](const TrackedWindow& w) { return w.shared->is_ready(); });
  add(
      "why_not_ready",
      [](const TrackedWindow& w) { return w.shared->why_not_ready(); },
      "one sentence; empty if it is");
  add(
      "findings",
      [](const TrackedWindow& w) { return json_of_window(w)["findings"].cast<py::list>(); },
      "what speaks against inputs and result, as in the JSON");
  add(
      "rotations_note",
      [](const TrackedWindow& w) { return w.shared->rotations_note; },
      "why the gyroscope is not used as given, or why another source of rotations was not used");
  add(
      "rotations",
      [](const TrackedWindow& w) { return std::string(to_string(w.shared->rotations)); },
      "source of the rotations");
  add("json", &json_of_window, "the result as a dict like that of `run --json`");
  add_saving(window);
  window.def("__repr__", [](const py::object& w) {
    const bool ok = w.attr("ok").cast<bool>();
    return fmt::format("<gpo.Initialized: {}>", ok ? "ok" : w.attr("reason").cast<std::string>());
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
      "`Recording.gyroscope`. Settings are those of `run`: method (or a callable, as for "
      "`evaluate`), rotations, planes, ... Raises InputError. A failed initialization is not ok "
      "and has the reason.");
  bind_status(module);
  bind_live(module);
}

}  // namespace gpo
