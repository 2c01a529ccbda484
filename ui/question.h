// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/gui.h"

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

namespace gpo {

/// A question that must be answered first.
struct Question {
  std::string title;
  std::vector<std::string> lines;  ///< the subject, line by line
  std::string advice;
  std::string yes, no;  ///< texts of the buttons
};

/// Draws one frame with the question alone into the bound framebuffer. Returns the answer; nullopt
/// until a button is clicked. Escape means no.
std::optional<bool> ask(Gui& gui, cv::Size size, const Question& question);

}  // namespace gpo
