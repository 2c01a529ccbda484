// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/python/bindings.h"
#include "engine/base/error.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using Ids = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

Eigen::Matrix3d matrix_of(const Numbers& rows, const char* name) {
  if (rows.ndim() != 2 || rows.shape(0) != 3 || rows.shape(1) != 3)
    throw InputError(fmt::format("expected {} (3, 3)", name));
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

/// Throws InputError with the given message if the object has another type.
template <class T>
T cast(const py::handle& given, const std::string& otherwise) {
  try {
    return given.cast<T>();
  } catch (const py::builtin_exception&) {
    throw InputError(otherwise);
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
    throw InputError(otherwise);
  }
}

constexpr const char* kFrameShape = "expected ids (n,) and pixels (n, 2)";

/// NumPy would also convert texts and complex numbers.
Numbers numbers_of(const py::handle& given, const char* name) {
  const auto any = cast<py::array>(given, fmt::format("{}: expected numbers", name));
  if (std::string_view("iuf").find(any.dtype().kind()) == std::string_view::npos)
    throw InputError(
        fmt::format("{}: expected numbers, found {}", name, std::string(py::str(any.dtype()))));
  return cast<Numbers>(any, fmt::format("{}: expected numbers", name));
}

/// Leaves out the masked items of a masked array.
std::pair<py::object, py::object> unmasked(const py::object& ids, const py::object& pixels) {
  const py::module_ numpy = py::module_::import("numpy");
  const py::object masked = numpy.attr("ma");
  if (!py::isinstance(pixels, masked.attr("MaskedArray"))) return {ids, pixels};
  const auto count = static_cast<py::ssize_t>(py::len(pixels));
  if (count == 0) return {ids, pixels};
  const py::object seen = numpy.attr("logical_not")(
      masked.attr("getmaskarray")(pixels).attr("reshape")(count, -1).attr("any")(1));
  const py::object all = numpy.attr("asarray")(ids);
  if (all.attr("size").cast<py::ssize_t>() != count) throw InputError(kFrameShape);
  return {all[seen], pixels.attr("data")[seen]};
}

std::vector<std::int64_t> ids_of(const py::object& given) {
  const auto any = cast<py::array>(given, kFrameShape);
  if (any.size() == 0) return {};
  const char kind = any.dtype().kind();
  if (kind != 'i' && kind != 'u')
    throw InputError(
        fmt::format("ids: expected integers, found {}", std::string(py::str(any.dtype()))));
  if (any.shape(0) != any.size()) throw InputError(kFrameShape);
  const auto array = cast<Ids>(any, kFrameShape);
  const std::span ids(array.data(), static_cast<std::size_t>(array.size()));
  if (kind == 'u' && std::ranges::any_of(ids, [](std::int64_t id) { return id < 0; }))
    throw InputError("ids: expected integers below 2^63");
  return {ids.begin(), ids.end()};
}

constexpr const char* kLever = "p_gyro_camera_m";
constexpr std::array kGyroscopeKeys{"timestamps_ns",
                                    "rates_rad_s",
                                    "accelerations_m_s2",
                                    "R_gyro_camera",
                                    "time_offset_ns",
                                    "bias_rad_s",
                                    "bias_sigma_rad_s",
                                    "bias_known",
                                    "noise_density",
                                    kLever};

void check_keys(const py::dict& given) {
  for (const auto& [key, value] : given)
    if (const std::string name = py::str(key); std::ranges::count(kGyroscopeKeys, name) == 0)
      throw InputError(fmt::format("gyroscope: unknown key '{}', expected one of {}",
                                   name,
                                   fmt::join(kGyroscopeKeys, ", ")));
}

template <class T>
void take(const py::dict& given, const char* key, T& field) {
  if (given.contains(key))
    field = cast<T>(given[key], fmt::format("gyroscope: {} has another type", key));
}

}  // namespace

Eigen::Map<const Eigen::Matrix2Xd> pixels_of(const Numbers& pixels, const char* expected) {
  const auto last = pixels.ndim() - 1;
  const bool fits = last == 1 || (last == 2 && pixels.shape(1) == 1);
  if (pixels.size() > 0 && !(fits && pixels.shape(last) == 2)) throw InputError(expected);
  return {pixels.data(), 2, pixels.size() / 2};
}

std::vector<Eigen::Vector3d> vectors_of(const Numbers& rows, const char* name) {
  if (rows.ndim() == 0 || (rows.size() > 0 && rows.shape(rows.ndim() - 1) != 3))
    throw InputError(fmt::format("gyroscope: expected {} (3,), or (m, 3)", name));
  std::vector<Eigen::Vector3d> vectors;
  for (const double* row = rows.data(); row < rows.data() + rows.size(); row += 3)
    vectors.emplace_back(row);
  return vectors;
}

Eigen::Vector3d vector_of(const Numbers& row, const char* name) {
  const auto vectors = vectors_of(row, name);
  if (vectors.size() != 1) throw InputError(fmt::format("gyroscope: expected {} (3,)", name));
  return vectors.front();
}

Camera pinhole_of(const Numbers& rows) {
  const Eigen::Matrix3d K = matrix_of(rows, "K");
  const Camera camera{.fx = K(0, 0), .fy = K(1, 1), .cx = K(0, 2), .cy = K(1, 2)};
  if (camera.fx > 0 && K != intrinsic_matrix(camera))
    throw InputError("expected K [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]; pixels have no skew");
  return camera;
}

Distortion distortion_of(const std::string& model, std::size_t coefficients) {
  const auto lens = std::ranges::find(lens_models(), model, &LensModel::name);
  if (lens == lens_models().end()) {
    std::vector<std::string> names;
    for (const LensModel& one : lens_models()) names.emplace_back(one.name);
    throw InputError(fmt::format("model: {}, expected {}", model, fmt::join(names, ", ")));
  }
  if (coefficients == 0) return Distortion::none;
  std::vector<std::size_t> counts = lens->counts;
  if (lens->distortion == Distortion::radial_tangential) counts.insert(counts.begin(), 2);
  if (lens->distortion == Distortion::none)
    throw InputError(fmt::format("distortion: found {}, model none has none",
                                 counted(coefficients, "coefficient")));
  if (std::ranges::count(counts, coefficients) == 0)
    throw InputError(fmt::format("distortion: found {} coefficients, {} has {}",
                                 coefficients,
                                 model,
                                 fmt::join(counts, ", ")));
  return lens->distortion;
}

Eigen::MatrixXd covariance_of(const Numbers& rows) {
  if (rows.ndim() != 2 || rows.shape(0) != rows.shape(1))
    throw InputError("expected covariance (n, n)");
  const Eigen::MatrixXd square = Eigen::MatrixXd::Map(rows.data(), rows.shape(0), rows.shape(0));
  if (square != square.transpose()) throw InputError("expected a symmetric covariance");
  return square;
}

Camera camera_of(const CameraOrK& given) {
  if (const auto* camera = std::get_if<Camera>(&given)) return *camera;
  return pinhole_of(std::get<Numbers>(given));
}

Frame frame_of(std::int64_t timestamp_ns,
               const py::object& ids,
               const py::object& pixels,
               const py::object& R_wc) {
  const auto [seen_ids, seen_pixels] = unmasked(ids, pixels);
  Frame frame{.timestamp_ns = timestamp_ns,
              .ids = ids_of(seen_ids),
              .raw_px = pixels_of(numbers_of(seen_pixels, "pixels"), kFrameShape)};
  if (!R_wc.is_none()) frame.R_wc = matrix_of(numbers_of(R_wc, "R_wc"), "R_wc");
  return frame;
}

Frame frame_of(const py::handle& given, std::size_t number) {
  const std::string expected =
      fmt::format("frame {}: expected numbers (timestamp_ns, ids, pixels[, R_wc])", number);
  const auto parts = cast<py::sequence>(given, expected);
  if (parts.size() != 3 && parts.size() != 4) throw InputError(expected);
  const auto time_ns = cast<std::int64_t>(parts[0], expected);
  try {
    const py::object R_wc = parts.size() == 4 ? py::object(parts[3]) : py::none();
    return frame_of(time_ns, parts[1], parts[2], R_wc);
  } catch (const InputError& error) {
    throw InputError(fmt::format("frame {}: {}", number, error.what()));
  }
}

std::pair<int, int> size_of(const py::object& given) {
  return cast<std::pair<int, int>>(given, "size: expected integers (width, height)");
}

std::optional<Gyroscope> gyroscope_of(const std::optional<py::dict>& given) {
  if (!given) return std::nullopt;
  check_keys(*given);
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
  if (Numbers bias; given->contains("bias_rad_s")) {
    take(*given, "bias_rad_s", bias);
    gyroscope.bias_rad_s = vector_of(bias, "bias_rad_s");
  }
  if (Numbers axes; given->contains("R_gyro_camera")) {
    take(*given, "R_gyro_camera", axes);
    gyroscope.R_gyro_camera = matrix_of(axes, "gyroscope: R_gyro_camera");
  }
  return gyroscope;
}

InitializeOptions options_of_keywords(const py::kwargs& given,
                                      const std::optional<py::dict>& gyroscope) {
  for (const auto& [key, value] : given) {
    const std::string name = py::str(key);
    if (name == "preset")
      throw InputError("preset: applies to recordings; expected single settings");
    if (find_setting(name).stage == SettingStage::tracks || find_setting(name).by_hand)
      throw InputError(name + ": applies to recordings; the frames given are the window");
  }
  InitializeOptions options = settings_of(given).options;
  if (gyroscope && gyroscope->contains(kLever) && !(*gyroscope)[kLever].is_none()) {
    Numbers lever;
    take(*gyroscope, kLever, lever);
    options.p_gyro_camera_m = vector_of(lever, kLever);
  }
  return options;
}

}  // namespace gpo
