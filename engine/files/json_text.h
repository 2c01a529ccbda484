// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace gpo {

/// Returns JSON as the text of a file, with a line break. Invalid UTF-8, e.g. in file names,
/// becomes the replacement character.
std::string json_text(const nlohmann::ordered_json& json, int indent);

/// Returns null for nullopt.
nlohmann::ordered_json optional_json(const std::optional<double>& value);

/// Parses JSON. Returns a discarded value (`is_discarded`) if it is invalid or deeper than 16
/// levels.
nlohmann::ordered_json parse_json(std::string_view text);

/// The same for a file. Throws InputError if it cannot be read or is too large.
nlohmann::ordered_json read_json(const std::filesystem::path& file);

}  // namespace gpo
