// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace gpo {

/// NumPy arrays that look at our memory and keep its owner alive; nothing is copied, and none of
/// them can be written to: results are shared.
template <class T>
pybind11::array seen_by_numpy(const T* data,
                              std::vector<pybind11::ssize_t> shape,
                              std::vector<pybind11::ssize_t> strides_bytes,
                              std::shared_ptr<const void> owner) {
  namespace py = pybind11;
  auto* kept = new std::shared_ptr<const void>(std::move(owner));
  const py::capsule base(kept,
                         [](void* p) { delete static_cast<std::shared_ptr<const void>*>(p); });
  py::array_t<T> array(std::move(shape), std::move(strides_bytes), data, base);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// Rotations of poses, N x 3 x 3, and centers, N x 3. Eigen's matrices are column by column.
inline pybind11::array rotations_of(std::span<const Pose> poses,
                                    std::shared_ptr<const void> owner) {
  static const Pose none;
  const double* first = poses.empty() ? none.R_wc.data() : poses.front().R_wc.data();
  return seen_by_numpy(first,
                       {static_cast<pybind11::ssize_t>(poses.size()), 3, 3},
                       {sizeof(Pose), sizeof(double), 3 * sizeof(double)},
                       std::move(owner));
}
inline pybind11::array centers_of(std::span<const Pose> poses, std::shared_ptr<const void> owner) {
  static const Pose none;
  const double* first = poses.empty() ? none.p_wc.data() : poses.front().p_wc.data();
  return seen_by_numpy(first,
                       {static_cast<pybind11::ssize_t>(poses.size()), 3},
                       {sizeof(Pose), sizeof(double)},
                       std::move(owner));
}

/// A picture of 8 bits: H x W x channels, or H x W of one channel.
inline pybind11::array image_array(const cv::Mat& image) {
  const auto owner = std::make_shared<const cv::Mat>(image);
  const auto row = static_cast<pybind11::ssize_t>(image.step[0]);
  const auto channels = static_cast<pybind11::ssize_t>(image.channels());
  std::vector<pybind11::ssize_t> shape{image.rows, image.cols};
  std::vector<pybind11::ssize_t> strides{row, channels};
  if (channels > 1) {
    shape.push_back(channels);
    strides.push_back(1);
  }
  return seen_by_numpy(image.data, std::move(shape), std::move(strides), owner);
}

}  // namespace gpo
