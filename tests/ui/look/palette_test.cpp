// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/palette.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(Palette, ThemesTellTextFromItsGround) {
  for (const Theme theme : {Theme::dark, Theme::light})
    for (const Role ground : {Role::background, Role::panel, Role::raised})
      for (const Role text : {Role::text, Role::text_dim, Role::good, Role::bad, Role::warning})
        EXPECT_GT(std::abs(green(color_of(text, theme)) - green(color_of(ground, theme))), 0.1)
            << static_cast<int>(theme) << " " << static_cast<int>(text);
}

TEST(Palette, MeasurementsKeepTheirColorAndTextDoesNot) {
  for (const Role role : {Role::inlier, Role::outlier, Role::residual, Role::cube_base})
    EXPECT_EQ(color_of(role, Theme::dark), color_of(role, Theme::light));
  for (const Role role : {Role::text, Role::panel, Role::selected, Role::truth})
    EXPECT_NE(color_of(role, Theme::dark), color_of(role, Theme::light));
}

TEST(Palette, DearImGuiHasRedInTheLowestByte) {
  EXPECT_EQ(imgui_color(0x112233, 1), 0xFF332211U);
  EXPECT_EQ(imgui_color(0x112233, 0), 0x00332211U);
  EXPECT_EQ(mixed_rgb(0x000000, 0xFF0080, 0.5), 0x800040U);
}

}  // namespace
}  // namespace gpo
