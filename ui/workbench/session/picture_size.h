// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core/types.hpp>

namespace gpo {

/// The size of a picture to draw from "WIDTHxHEIGHT", 16 to 8192 pixels each. Throws InputError
/// that begins with who asked: an option, a command.
cv::Size picture_size(const std::string& text, const std::string& asked_by);

}  // namespace gpo
