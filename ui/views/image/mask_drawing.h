// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/views/image/image_geometry.h"

namespace gpo {

/// Returns the color of a kind's outline.
std::uint32_t mask_color(MaskKind kind);

/// Draws a mask's outline in dashes and dots, and hatches a mask that leaves out its tracks.
void draw_mask(const ImageCanvas& canvas, const Mask& mask);
void draw_masks(const ImageCanvas& canvas, const Masks& masks);

/// Adds one row for each kind of mask.
void add_mask_rows(const Masks& masks, LegendRows& rows);

}  // namespace gpo
