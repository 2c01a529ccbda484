// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session/script.h"

#include "engine/files/text_file.h"

#include <sstream>

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

}  // namespace gpo
