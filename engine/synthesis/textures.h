// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/random.h"

#include <array>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

/// magazine, letter, postcard, photo, card, map, mousepad, notebook, rug.
std::vector<std::string> print_kinds();

/// A printed sheet of the named kind as CV_8UC4 (blue, green, red, opacity).
cv::Mat draw_print(const std::string& kind, cv::Size size_px, Random random);

/// book, carton, cube, shelf, wooden.
std::vector<std::string> box_kinds();

/// Faces of a box, CV_8UC4, seen from outside with the box' top at the picture's top: front (-y),
/// right (+x), back (+y), left (-x), and the top as seen from above with +y at the picture's top.
struct BoxFaces {
  std::array<cv::Mat, 4> sides;
  cv::Mat top;
};
BoxFaces draw_box(const std::string& kind, cv::Vec3d size_px, Random random);

}  // namespace gpo
