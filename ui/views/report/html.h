// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace gpo {

/// Returns a text for the content and the attributes of HTML. Invalid UTF-8, e.g. in file names,
/// becomes the replacement character.
std::string html_text(const std::string& text);

/// Returns "data:TYPE;base64,...".
std::string data_uri(std::string_view type, std::string_view bytes);

/// Returns JSON that can be the content of a `script` element: without "<".
std::string script_json(const nlohmann::ordered_json& json);

/// A cell of a table: its text, not escaped, and the classes of its element.
struct HtmlCell {
  std::string text;
  std::string style = {};  ///< CSS classes; "number" aligns right
};

/// Returns a table. Columns whose cells are all empty are dropped; the first cell of a row is its
/// header. `row_styles`: CSS classes by row; may be empty.
std::string html_table(const std::vector<std::string>& header,
                       std::vector<std::vector<HtmlCell>> rows,
                       const std::vector<std::string>& row_styles = {});

}  // namespace gpo
