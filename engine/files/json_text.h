// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace gpo {

/// JSON as a file's text, with a line end. Names of files may be no UTF-8; what is not becomes the
/// replacement character.
std::string json_text(const nlohmann::ordered_json& json, int indent);

/// What is unknown is null.
nlohmann::ordered_json optional_json(const std::optional<double>& value);

/// Discarded (`is_discarded`) where it is no JSON, or so deep that libraries run out of stack.
nlohmann::ordered_json parse_json(std::string_view text);

/// The same of a file. Throws InputError where it cannot be read or is too large.
nlohmann::ordered_json read_json(const std::filesystem::path& file);

}  // namespace gpo
