// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

class vtkTextProperty;

namespace gpo {

enum class Weight { regular, bold };

/// The program's own font for VTK, as Dear ImGui draws it. `size_px`: of the em.
void set_font(vtkTextProperty& property, Weight weight, double size_px, std::uint32_t rgb);

}  // namespace gpo
