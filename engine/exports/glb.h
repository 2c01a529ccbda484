// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace gpo {

/// A glTF 2.0 file in the making: JSON and one binary buffer
/// (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html). Indices are those of its lists.
class Glb {
 public:
  nlohmann::ordered_json json;

  /// Appends an element to a list of the file. Returns its index.
  int add(const char* list, nlohmann::ordered_json element);

  /// `bounds`: adds smallest and largest values, which positions and times need.
  int add_vectors(const std::vector<Eigen::Vector3d>& vectors, bool bounds);
  int add_quaternions(const std::vector<Eigen::Vector4d>& xyzw);
  int add_texture_coordinates(const std::vector<Eigen::Vector2d>& coordinates);
  int add_times(const std::vector<double>& seconds);
  int add_colors(const std::vector<std::uint8_t>& rgba);  ///< four values per color
  int add_indices(const std::vector<std::uint16_t>& indices);
  int add_png(std::string_view png);  ///< returns the index of a texture

  /// Returns the bytes of the file.
  std::string bytes() const;

 private:
  int add_view(std::string_view bytes);
  int add_floats(const std::vector<double>& values, const char* type, bool bounds);
  int add_accessor(std::string_view bytes, std::size_t count, nlohmann::ordered_json accessor);

  std::string buffer_;
};

}  // namespace gpo
