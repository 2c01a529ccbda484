// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

namespace gpo {

/// One command of a script.
struct ScriptLine {
  int number = 0;    ///< in its file, counts from 1
  std::string text;  ///< as `run_line` reads it
};

/// One command a line; empty lines and what follows a # are left out. Throws InputError where the
/// file cannot be read.
std::vector<ScriptLine> read_script(const std::filesystem::path& file);

/// The size of a picture to draw from "WIDTHxHEIGHT", 16 to 8192 pixels each. Throws InputError
/// that begins with who asked: an option, a command.
cv::Size image_size(const std::string& text, const std::string& asked_by);

}  // namespace gpo
