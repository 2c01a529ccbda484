// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/gui.h"

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

namespace gpo {

/// Something that must be answered before anything else is done.
struct Question {
  std::string title;
  std::vector<std::string> lines;  ///< what it is about, each as it is
  std::string advice;
  std::string yes, no;  ///< what the buttons say
};

/// Draws it, alone, into the framebuffer that is bound; between no other frame's beginning and end.
/// The answer, once a button is clicked; Escape is no.
std::optional<bool> ask(Gui& gui, cv::Size size, const Question& question);

}  // namespace gpo
