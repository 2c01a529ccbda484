// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/inspection/settings/settings_table.h"
#include "engine/methods/common/initialization.h"
#include "engine/recording/recording.h"
#include "engine/window/window.h"

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace gpo {

namespace py = pybind11;

using SharedRecording = std::shared_ptr<const Recording>;
/// Python's Recording. (pybind11's holders do not support const.)
struct OpenRecording {
  SharedRecording shared;
};
/// The recording that `run`, `evaluate` and `snapshot` take: an open one or a path.
using RecordingOrPath = std::variant<OpenRecording, std::string>;

/// Base of Python's results. The pointers keep their owners alive.
struct Solved {
  std::shared_ptr<const Initialization> initialization;
  std::shared_ptr<const Window> window;
  std::shared_ptr<const std::vector<std::int64_t>> ids;  ///< ids of the window's tracks
  std::shared_ptr<const InertialAlignment> inertial;     ///< null if no accelerometer was used

  const Initialization* operator->() const { return initialization.get(); }
};

SharedRecording opened(const RecordingOrPath& recording);

/// Reads settings by command-line names with `_`: frames=20, preset="paper". Throws InputError.
Settings settings_of(const py::kwargs& given);

void bind_initialize(py::module_& module);
void bind_results(py::module_& module);

/// Runs `work(stop_token)` on another thread, without the interpreter's lock. Ctrl-C stops it.
template <class Work>
auto interruptible(Work work) {
  std::stop_source stop;
  auto result =
      std::async(std::launch::async, [&work, token = stop.get_token()] { return work(token); });
  const auto is_ready_soon = [&] {
    const py::gil_scoped_release others_may_run;
    return result.wait_for(std::chrono::milliseconds(20)) == std::future_status::ready;
  };
  while (!is_ready_soon()) {
    if (!stop.stop_requested() && PyErr_CheckSignals() != 0) stop.request_stop();
  }
  if (stop.stop_requested()) throw py::error_already_set();
  return result.get();
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

}  // namespace gpo
