// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/gui.h"
#include "ui/context/theme.h"

#include <cstdint>
#include <initializer_list>
#include <string>

#include <Eigen/Core>

struct ImDrawList;

namespace gpo {

/// One line from its upper left corner on, on whole pixels.
void write_text(ImDrawList& list,
                Font which,
                const Eigen::Vector2d& at,
                const std::string& text,
                std::uint32_t rgb = color_of(Role::text));

/// [px]
double text_width(Font which, const std::string& text);

/// The first of the texts that is not wider; else the last one, cut.
std::string fitting_text(Font which, std::initializer_list<std::string> texts, double width);

}  // namespace gpo
