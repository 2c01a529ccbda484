// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "app/python/bindings.h"

namespace gpo {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
/// K alone is a camera without distortion.
using CameraOrK = std::variant<Camera, Numbers>;

// All functions throw InputError for arrays of another shape, type or value.

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

Frame frame_of(std::int64_t timestamp_ns,
               const py::object& ids,
               const Numbers& pixels,
               const std::optional<Numbers>& R_wc);
/// Converts (timestamp_ns, ids, pixels[, R_wc]); `number` is for messages.
Frame frame_of(const py::handle& given, std::size_t number);

/// Converts a dict with the keys of `Recording.gyroscope`; defaults are those of a phone.
std::optional<Gyroscope> gyroscope_of(const std::optional<py::dict>& given);

/// Returns the settings with the gyroscope's lever arm; refuses those of tracking.
InitializeOptions options_of_keywords(const py::kwargs& given,
                                      const std::optional<py::dict>& gyroscope);

}  // namespace gpo
