// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace gpo {

/// What the header of a picture says that it will be, before any memory is taken for it.
struct PictureHeader {
  std::int64_t width = 0;   ///< [px]
  std::int64_t height = 0;  ///< [px]
  int bits = 8;             ///< a channel, where the format is TIFF, which knows more than 16
};

/// Reads the header of a PNG, JPEG, BMP, PNM, TIFF or WebP; nothing for other bytes and headers
/// that are cut.
std::optional<PictureHeader> read_picture_header(std::string_view bytes);

}  // namespace gpo
