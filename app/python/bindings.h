// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "app/methods/method_commands.h"
#include "engine/base/stop.h"
#include "engine/initialize.h"
#include "engine/inspection/settings/settings_table.h"
#include "engine/recording/recording.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace gpo {

namespace py = pybind11;

using SharedRecording = std::shared_ptr<const Recording>;
/// Python's Recording; pybind11's holders do not support const.
struct OpenRecording {
  SharedRecording shared;
  std::map<std::string, std::string> topics{};  ///< by role, as given to `open`
  std::optional<double> limits{};               ///< factor, as given to `open`
};
/// The recording that `run`, `evaluate` and `snapshot` take: an open one or a path.
using RecordingOrPath = std::variant<OpenRecording, std::filesystem::path>;

/// A Python object that `pickle` restored has only the values of its fields; see `AddField`.
struct Saved {
  py::object fields;  ///< dict; null for an object that was computed
};

/// Base of Python's results. The pointers keep their owners alive.
struct Solved : Saved {
  std::shared_ptr<const Initialization> initialization;
  std::shared_ptr<const Window> window;
  std::shared_ptr<const std::vector<std::int64_t>> ids;  ///< ids of the window's tracks
  std::shared_ptr<const InertialAlignment> inertial;     ///< null if no accelerometer was used

  const Initialization& operator*() const { return *initialization; }
  const Initialization* operator->() const { return initialization.get(); }
};

/// Python's Initialized.
struct TrackedWindow : Solved {
  TrackedWindow() = default;
  TrackedWindow(const std::shared_ptr<const WindowResult>& result,
                Camera calibrated,
                InitializeOptions chosen);
  std::shared_ptr<const WindowResult> shared;
  Camera camera;
  InitializeOptions options;
};

/// Makes the arrays in a value read-only, also those in dicts, lists and tuples. Returns the value.
py::object frozen(py::object value);
/// Returns the value of a setting as the command line writes it; lists with commas.
std::string setting_text_of(py::object value);

/// Reads settings by command-line names with `_`: frames=20, preset="paper". Throws InputError.
Settings settings_of(const py::kwargs& given, const MethodTable& methods = {});

/// Returns a method with the name of a callable, which takes a window as a dict. `number` as for
/// `own_method`. Throws InputError if the name cannot be one of a method.
Method callable_method(const py::object& callable, int number);

/// Settings with the user's own methods, which `method_command`, `result` and callables add.
struct Request {
  OwnMethods own;
  Settings settings;
  std::vector<std::string> given;  ///< keys of the settings

  Settings settings_for(const Recording& recording) const {
    return with_window_within(settings, given, recording.frame_count());
  }
};
/// Throws InputError that begins with `name` unless a number is in a range, ends included.
void check_within(const char* name, double value, double least, double most);

/// Takes the keywords of own methods out of `given`. Throws InputError.
OwnMethods take_methods(py::kwargs& given);
/// Returns methods as the command line writes them. Adds callables to the table by their names.
std::string methods_text(const py::object& methods, MethodTable& table);
Request request_of(py::kwargs given);

void bind_initialize(py::module_& module);
void bind_evaluate(py::module_& module);

SharedRecording opened(const RecordingOrPath& recording);

/// Keeps work that Ctrl-C did not stop in time. Python waits for it when it ends.
void abandon(std::shared_ptr<void> work);

/// Runs `work(stop_token)` on another thread, without the interpreter's lock. Ctrl-C requests a
/// stop and raises at most half a second later, so `work` must own what it uses.
template <class Work>
auto interruptible(Work work) {
  using namespace std::chrono_literals;
  std::stop_source stop;
  const auto run = [work = std::move(work), token = stop.get_token()] {
    const StopWatch watch{.stop = token};
    const StopScope scope(&watch);
    return work(token);
  };
  const auto result =
      std::make_shared<std::future<decltype(run())>>(std::async(std::launch::async, run));
  const auto is_ready_in = [&](std::chrono::milliseconds time) {
    const py::gil_scoped_release others_may_run;
    return result->wait_for(time) == std::future_status::ready;
  };
  while (!is_ready_in(20ms)) {
    if (PyErr_CheckSignals() == 0) continue;
    stop.request_stop();
    const py::error_already_set interrupted;
    if (!is_ready_in(500ms)) abandon(result);
    throw interrupted;
  }
  return result->get();
}

/// Adds read-only properties to a class; `to_dict`, `pickle` and `copy.deepcopy` have them, too.
/// Their arrays are read-only.
template <class Class>
struct AddField {
  Class& owner;

  /// `get`: a function or member of the class, or a member of what the class refers to.
  template <class Get>
  void operator()(const char* name, Get get, const char* doc = "") const {
    using T = typename Class::type;
    const auto value = [name, get](const T& self) -> py::object {
      if (self.fields) return self.fields[name];
      using Value = std::decay_t<decltype(std::invoke(get, self))>;
      if constexpr (std::is_base_of_v<py::object, Value>)
        return frozen(std::invoke(get, self));
      else
        return frozen(py::cast(std::invoke(get, self)));
    };
    owner.def_property_readonly(name, value, doc);
    owner.attr("_fields") =
        py::getattr(owner, "_fields", py::tuple()) + py::tuple(py::make_tuple(name));
  }
};
template <class Class>
AddField(Class&) -> AddField<Class>;

/// Returns all fields of an object by their names.
py::dict dict_of(const py::object& self);

/// Adds what all objects with fields have. Call it after the last field is added.
template <class Class>
void add_saving(Class& owner) {
  using T = typename Class::type;
  owner.attr("__module__") = "gpo";
  owner.def("to_dict", &dict_of, "All properties by their names")
      .def(py::pickle(&dict_of, [](const py::dict& fields) {
        T restored;
        restored.fields = frozen(fields);
        return restored;
      }));
}

/// Returns a read-only NumPy array that views our memory and keeps its owner alive.
template <class T>
py::array view_array(const T* data,
                     std::vector<py::ssize_t> shape,
                     std::vector<py::ssize_t> strides_bytes,
                     std::shared_ptr<const void> owner) {
  auto* kept = new std::shared_ptr<const void>(std::move(owner));
  const py::capsule base(kept,
                         [](void* p) { delete static_cast<std::shared_ptr<const void>*>(p); });
  py::array_t<T> array(std::move(shape), std::move(strides_bytes), data, base);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// Returns (N, 3) of one vector in each item, or (N, 3, 3) of one column-major matrix.
template <class T, int columns>
py::array view_members(std::span<const T> items,
                       Eigen::Matrix<double, 3, columns> T::*member,
                       std::shared_ptr<const void> owner) {
  static const T none{};
  std::vector<py::ssize_t> shape{std::ssize(items), 3}, strides{sizeof(T), sizeof(double)};
  if (columns > 1) {
    shape.push_back(columns);
    strides.push_back(3 * sizeof(double));
  }
  const T& first = items.empty() ? none : items.front();
  return view_array((first.*member).data(), shape, strides, std::move(owner));
}

inline py::array view_vectors(std::span<const Eigen::Vector3d> vectors,
                              std::shared_ptr<const void> owner) {
  return view_array(reinterpret_cast<const double*>(vectors.data()),
                    {std::ssize(vectors), 3},
                    {sizeof(Eigen::Vector3d), sizeof(double)},
                    std::move(owner));
}

inline py::array view_integers(const std::vector<std::int64_t>& values,
                               std::shared_ptr<const void> owner) {
  return view_array(values.data(), {std::ssize(values)}, {sizeof(std::int64_t)}, std::move(owner));
}

/// Returns a CV_8UC3 image as (H, W, 3).
inline py::array view_image(const cv::Mat& image) {
  return view_array(image.data,
                    {image.rows, image.cols, 3},
                    {static_cast<py::ssize_t>(image.step[0]), 3, 1},
                    std::make_shared<const cv::Mat>(image));
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
/// K alone is a camera without distortion.
using CameraOrK = std::variant<Camera, Numbers>;

// These functions of inputs.cpp throw InputError for arrays of another shape, type or value.

/// Returns the items of (n, 2), or of OpenCV's (n, 1, 2); an empty list has none.
Eigen::Map<const Eigen::Matrix2Xd> pixels_of(const Numbers& pixels,
                                             const char* expected = "expected pixels (n, 2)");

/// Returns the rows of (m, 3), or the one of (3,); an empty list has none.
std::vector<Eigen::Vector3d> vectors_of(const Numbers& rows, const char* name);
Eigen::Vector3d vector_of(const Numbers& row, const char* name);

/// Returns a camera without distortion.
Camera pinhole_of(const Numbers& K);
/// Returns the kind of a lens with this number of coefficients.
Distortion distortion_of(const std::string& model, std::size_t coefficients);
Camera camera_of(const CameraOrK& given);

Eigen::MatrixXd covariance_of(const Numbers& rows);

/// Masked pixels are not seen. `R_wc` may be None.
Frame frame_of(std::int64_t timestamp_ns,
               const py::object& ids,
               const py::object& pixels,
               const py::object& R_wc);
/// Converts (timestamp_ns, ids, pixels[, R_wc]); `number` is for messages.
Frame frame_of(const py::handle& given, std::size_t number);
std::pair<int, int> size_of(const py::object& given);

/// Converts a dict with the keys of `Recording.gyroscope`; defaults are those of a phone.
std::optional<Gyroscope> gyroscope_of(const std::optional<py::dict>& given);

/// Returns the settings with the gyroscope's lever arm; refuses those of tracking.
InitializeOptions options_of_keywords(const py::kwargs& given,
                                      const std::optional<py::dict>& gyroscope);

}  // namespace gpo
