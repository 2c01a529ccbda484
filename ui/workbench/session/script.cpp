// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session/script.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"

#include <sstream>

#include <fmt/format.h>

namespace gpo {

std::vector<ScriptLine> read_script(const std::filesystem::path& file) {
  std::istringstream text(read_file(file, kMostBytesByHand));
  std::vector<ScriptLine> lines;
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") != std::string::npos) lines.push_back({number, line});
  }
  return lines;
}

cv::Size image_size(const std::string& text, const std::string& asked_by) {
  constexpr int kLeast = 16;
  constexpr int kMost = 8192;
  const auto possible = [](int side) { return side >= kLeast && side <= kMost; };
  const auto size = parse_size(text);
  if (size && possible(size->first) && possible(size->second)) return {size->first, size->second};
  throw InputError(fmt::format("{}: '{}', expected WIDTHxHEIGHT of {} to {} pixels, e.g. 1280x720",
                               asked_by,
                               text,
                               kLeast,
                               kMost));
}

}  // namespace gpo
