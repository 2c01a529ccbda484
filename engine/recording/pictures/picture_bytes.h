// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace gpo {

/// Whether a picture's file is there to its end and a PNG's sums agree, before a library decodes
/// half of it or complains on stderr. TIFF and unknown formats pass.
bool is_whole_picture(std::string_view bytes);

/// A PNG's bytes with nothing but its pixels, transparency and orientation: libpng prints a line on
/// stderr for a color profile that it does not like, and programs write many of those. Other
/// formats stay as they are.
std::string without_remarks(std::string_view bytes);

}  // namespace gpo
