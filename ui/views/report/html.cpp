// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "ui/views/report/report.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

std::string html_class(const std::string& style) {
  return style.empty() ? "" : fmt::format(" class=\"{}\"", style);
}

std::string html_row(const std::vector<HtmlCell>& cells, const std::string& style) {
  std::string row = fmt::format("<tr{}>", html_class(style));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const char* element = i == 0 ? "th" : "td";
    row += fmt::format(
        "<{0}{1}>{2}</{0}>", element, html_class(cells[i].style), html_text(cells[i].text));
  }
  return row + "</tr>\n";
}

}  // namespace

std::string html_text(const std::string& text) {
  // Serializing replaces invalid UTF-8.
  const auto valid = nlohmann::json::parse(json_text(text, -1)).get<std::string>();
  constexpr std::pair<char, const char*> kEscapes[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  std::string made;
  for (const char c : valid) {
    const auto* escape = std::ranges::find(kEscapes, c, &std::pair<char, const char*>::first);
    made += escape != std::end(kEscapes) ? std::string(escape->second) : std::string(1, c);
  }
  return made;
}

std::string data_uri(std::string_view type, std::string_view bytes) {
  return fmt::format("data:{};base64,{}", type, to_base64(bytes));
}

std::string script_json(const nlohmann::ordered_json& json) {
  std::string made;
  // "</script>" and "<!--" would end or change the element.
  for (const char c : json_text(json, -1)) made += c == '<' ? "\\u003c" : std::string(1, c);
  return made;
}

std::string html_table(const std::vector<std::string>& header,
                       std::vector<std::vector<HtmlCell>> rows,
                       const std::vector<std::string>& row_styles) {
  std::vector<bool> used(header.size(), false);
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) used[i] = used[i] || !row[i].text.empty();
  std::string head;
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (!used[i]) continue;
    const bool number = !rows.empty() && i < rows[0].size() && rows[0][i].style == "number";
    head += fmt::format("<th{}>{}</th>", number ? " class=\"number\"" : "", html_text(header[i]));
  }
  std::string body;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::vector<HtmlCell> cells;
    for (std::size_t i = 0; i < rows[r].size(); ++i)
      if (used[i]) cells.push_back(std::move(rows[r][i]));
    body += html_row(cells, r < row_styles.size() ? row_styles[r] : "");
  }
  return fmt::format(
      "<div class=\"wide\"><table><thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
      head,
      body);
}

}  // namespace gpo
