// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace gpo {

/// JSON as a file's text, with a line end. Names of files may be no UTF-8; what is not becomes the
/// replacement character.
std::string json_text(const nlohmann::ordered_json& json, int indent);

}  // namespace gpo
