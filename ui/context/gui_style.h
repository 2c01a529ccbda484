// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gpo {

/// Colors, paddings and corners of the program, in the current Dear ImGui context.
void apply_style(float scale);

/// The fonts of `Font`, in its order, from the bytes that the program carries.
void load_fonts(float scale);

}  // namespace gpo
