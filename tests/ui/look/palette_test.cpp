// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/palette.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace gpo {
namespace {

/// Returns the relative luminance (WCAG 2).
double luminance(std::uint32_t rgb) {
  const auto linear = [](double c) {
    return c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(red(rgb)) + 0.7152 * linear(green(rgb)) + 0.0722 * linear(blue(rgb));
}

double contrast(std::uint32_t a, std::uint32_t b) {
  const double x = luminance(a), y = luminance(b);
  return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

TEST(Palette, TextHasEnoughContrast) {
  for (const Theme theme : {Theme::dark, Theme::light})
    for (const Role ground : {Role::background, Role::panel, Role::raised})
      for (const Role text :
           {Role::text, Role::text_dim, Role::accent, Role::good, Role::bad, Role::warning})
        EXPECT_GE(contrast(color_of(text, theme), color_of(ground, theme)), 4.5)
            << static_cast<int>(theme) << " " << static_cast<int>(text) << " on "
            << static_cast<int>(ground);
}

TEST(Palette, OnlyDataKeepTheirColorInBothThemes) {
  for (const Role role : {Role::inlier, Role::outlier, Role::residual, Role::cube_base})
    EXPECT_EQ(color_of(role, Theme::dark), color_of(role, Theme::light));
  for (const Role role : {Role::text, Role::panel, Role::selected, Role::truth})
    EXPECT_NE(color_of(role, Theme::dark), color_of(role, Theme::light));
}

TEST(Palette, PacksRedIntoTheLowestByteForDearImGui) {
  EXPECT_EQ(imgui_color(0x112233, 1), 0xFF332211U);
  EXPECT_EQ(imgui_color(0x112233, 0), 0x00332211U);
  EXPECT_EQ(mixed_rgb(0x000000, 0xFF0080, 0.5), 0x800040U);
}

}  // namespace
}  // namespace gpo
