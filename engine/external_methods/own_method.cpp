// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/external_methods/own_method.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <zlib.h>

namespace gpo {
namespace {

/// The colors differ from those of the built-in methods.
std::uint32_t color_of_own(int number) {
  constexpr std::array<std::uint32_t, 6> kColors{
      0x9B30FF, 0xFF4FA3, 0x7FBF00, 0x00B5AD, 0xB22222, 0x5C4BD6};
  return kColors[static_cast<std::size_t>(number) % kColors.size()];
}

std::vector<std::string> texts_in(const nlohmann::ordered_json& json,
                                  const std::filesystem::path& file,
                                  const char* key) {
  if (!json.contains(key)) return {};
  std::vector<std::string> texts;
  const auto& list = json.at(key);
  const auto refuse = [&] {
    throw InputError(fmt::format("{}: {}: expected a list of texts, NAME=...", file.string(), key));
  };
  if (!list.is_array()) refuse();
  for (const auto& one : list) {
    if (!one.is_string()) refuse();
    texts.push_back(one.get<std::string>());
  }
  return texts;
}

}  // namespace

NamedText parse_named(const std::string& text, const char* option, const char* expected) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  constexpr std::size_t kMaxLength = 40;
  const bool fits =
      !name.empty() && name.size() <= kMaxLength && std::ranges::all_of(name, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-';
      });
  const bool has_text =
      equals != std::string::npos && text.find_first_not_of(" \t", equals + 1) != std::string::npos;
  if (!fits || !has_text || name == "all")
    throw InputError(fmt::format(
        "{}: '{}', expected {}, the name of letters, digits, _ and -", option, text, expected));
  return {name, text.substr(equals + 1)};
}

Method own_method(const std::string& name,
                  int number,
                  decltype(Method::initialize_from) initialize_from,
                  std::string identity) {
  Method method{};
  method.key = method.title = name;
  method.rgb = color_of_own(number);
  method.family = MethodFamily::optimization;
  method.needs_plane = false;
  method.inliers = Inliers::planes;
  method.rotations = RotationModel::free;
  method.initialize_from = std::move(initialize_from);
  method.initialize = [from = method.initialize_from](const Window& window,
                                                      const MethodOptions& /*options*/,
                                                      const Watch& watch) {
    return from(window, {}, watch);
  };
  method.identity = std::move(identity);
  method.number = number;
  return method;
}

std::string checksum_of(const std::filesystem::path& path) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return "";
  std::ifstream file(path, std::ios::binary);
  std::array<char, 65'536> buffer{};
  uLong sum = crc32(0, nullptr, 0);
  while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0)
    sum =
        crc32(sum, reinterpret_cast<const Bytef*>(buffer.data()), static_cast<uInt>(file.gcount()));
  return fmt::format("{:08x}", sum);
}

MethodSpecs specs_in(const MethodTable& methods) {
  MethodSpecs specs;
  for (const auto& method : methods.own()) {
    if (!method->command.empty()) specs.commands.push_back(method->command);
    if (!method->result.empty()) specs.results.push_back(method->result);
  }
  return specs;
}

std::string with_whole_paths(const std::string& result) {
  const std::size_t equals = result.find('=');
  std::string whole = result.substr(0, equals);
  char before = '=';
  for (const std::string& part : split(result.substr(equals + 1), ',')) {
    std::error_code none;
    const bool file = !part.empty() && !part.starts_with("frame=");
    whole +=
        std::exchange(before, ',') + (file ? std::filesystem::absolute(part, none).string() : part);
  }
  return whole;
}

MethodSpecs methods_in_session(const std::filesystem::path& file) {
  const auto json = read_json(file);
  if (!json.is_object()) return {};
  return {texts_in(json, file, "method_commands"), texts_in(json, file, "results")};
}

}  // namespace gpo
