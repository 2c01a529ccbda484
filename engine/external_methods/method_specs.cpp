// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/external_methods/method_specs.h"

#include "engine/base/error.h"
#include "engine/files/json_text.h"

#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

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

std::vector<std::string> names_of(const MethodSpecs& spelled) {
  std::vector<std::string> names;
  for (const auto* list : {&spelled.commands, &spelled.results})
    for (const std::string& one : *list) names.push_back(one.substr(0, one.find('=')));
  return names;
}

MethodSpecs specs_in(const MethodTable& methods) {
  MethodSpecs spelled;
  for (const auto& method : methods.own()) {
    if (!method->command.empty()) spelled.commands.push_back(method->command);
    if (!method->result.empty()) spelled.results.push_back(method->result);
  }
  return spelled;
}

std::string with_whole_paths(const std::string& result) {
  const std::size_t equals = result.find('=');
  std::string whole = result.substr(0, equals);
  std::istringstream parts(result.substr(equals + 1));
  char before = '=';
  for (std::string part; std::getline(parts, part, ','); before = ',') {
    std::error_code none;
    const bool file = !part.empty() && !part.starts_with("frame=");
    whole += before + (file ? std::filesystem::absolute(part, none).string() : part);
  }
  return whole;
}

MethodSpecs methods_in_session(const std::filesystem::path& file) {
  const auto json = read_json(file);
  if (!json.is_object()) return {};
  return {texts_in(json, file, "method_commands"), texts_in(json, file, "results")};
}

}  // namespace gpo
