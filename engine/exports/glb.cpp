// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/exports/glb.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <utility>

namespace gpo {
namespace {

using nlohmann::ordered_json;

enum Component { unsigned_byte = 5121, unsigned_short = 5123, floating = 5126 };

std::string little_endian_bytes(std::uint32_t number) {
  std::array<char, sizeof number> stored;
  std::memcpy(stored.data(), &number, sizeof number);
  return {stored.data(), stored.size()};
}

/// Chunks and buffer views begin at multiples of four bytes.
std::string aligned_to_four(std::string bytes, char filler) {
  bytes.resize((bytes.size() + 3) / 4 * 4, filler);
  return bytes;
}

template <class Value>
std::string_view bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

std::size_t components_of(const std::string& type) {
  const std::map<std::string, std::size_t> counts{
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
  return counts.at(type);
}

/// Concatenates vectors of one size.
std::vector<double> flat(const auto& vectors) {
  std::vector<double> values;
  for (const auto& vector : vectors) values.insert(values.end(), vector.begin(), vector.end());
  return values;
}

}  // namespace

int Glb::add(const char* list, ordered_json element) {
  json[list].push_back(std::move(element));
  return static_cast<int>(json[list].size()) - 1;
}

int Glb::add_view(std::string_view bytes) {
  buffer_ = aligned_to_four(std::move(buffer_), '\0');
  const std::size_t begin = buffer_.size();
  buffer_ += bytes;
  return add("bufferViews", {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes.size()}});
}

int Glb::add_accessor(std::string_view bytes, std::size_t count, ordered_json accessor) {
  accessor["bufferView"] = add_view(bytes);
  accessor["count"] = count;
  return add("accessors", std::move(accessor));
}

int Glb::add_floats(const std::vector<double>& values, const char* type, bool bounds) {
  const std::vector<float> stored(values.begin(), values.end());
  const std::size_t step = components_of(type);
  ordered_json accessor{{"componentType", Component::floating}, {"type", type}};
  for (std::size_t k = 0; bounds && k < step; ++k) {
    float least = stored[k], most = stored[k];
    for (std::size_t i = k; i < stored.size(); i += step) {
      least = std::min(least, stored[i]);
      most = std::max(most, stored[i]);
    }
    accessor["min"].push_back(least);
    accessor["max"].push_back(most);
  }
  return add_accessor(bytes_of(stored), stored.size() / step, std::move(accessor));
}

int Glb::add_vectors(const std::vector<Eigen::Vector3d>& vectors, bool bounds) {
  return add_floats(flat(vectors), "VEC3", bounds);
}

int Glb::add_quaternions(const std::vector<Eigen::Vector4d>& xyzw) {
  return add_floats(flat(xyzw), "VEC4", false);
}

int Glb::add_texture_coordinates(const std::vector<Eigen::Vector2d>& coordinates) {
  return add_floats(flat(coordinates), "VEC2", false);
}

int Glb::add_times(const std::vector<double>& seconds) {
  return add_floats(seconds, "SCALAR", true);
}

int Glb::add_colors(const std::vector<std::uint8_t>& rgba) {
  return add_accessor(
      bytes_of(rgba),
      rgba.size() / 4,
      {{"componentType", Component::unsigned_byte}, {"type", "VEC4"}, {"normalized", true}});
}

int Glb::add_indices(const std::vector<std::uint16_t>& indices) {
  return add_accessor(bytes_of(indices),
                      indices.size(),
                      {{"componentType", Component::unsigned_short}, {"type", "SCALAR"}});
}

int Glb::add_png(std::string_view png) {
  const int image = add("images", {{"bufferView", add_view(png)}, {"mimeType", "image/png"}});
  return add("textures", {{"source", image}});
}

std::string Glb::bytes() const {
  constexpr std::uint32_t kVersion = 2, kHeaderBytes = 12, kChunkHeadBytes = 8;
  const std::string binary = aligned_to_four(buffer_, '\0');
  ordered_json whole = json;
  whole["buffers"] = ordered_json::array({{{"byteLength", binary.size()}}});
  const std::string text = aligned_to_four(whole.dump(), ' ');
  const std::size_t length = kHeaderBytes + 2 * kChunkHeadBytes + text.size() + binary.size();
  return "glTF" + little_endian_bytes(kVersion) +
         little_endian_bytes(static_cast<std::uint32_t>(length)) +
         little_endian_bytes(static_cast<std::uint32_t>(text.size())) + "JSON" + text +
         little_endian_bytes(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) +
         binary;
}

}  // namespace gpo
