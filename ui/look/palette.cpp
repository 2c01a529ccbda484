// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/palette.h"

#include <cstddef>

namespace gpo {
namespace {

struct Colors {
  Role role;
  std::uint32_t dark, light;
};

// clang-format off
constexpr Colors kRoleColors[] = {
    {Role::inlier, 0x1FCB93, 0x1FCB93}, {Role::outlier, 0xF0503C, 0xF0503C},
    {Role::residual, 0xF0E442, 0xF0E442}, {Role::truth, 0xA9AEB6, 0x6E757E},
    {Role::cube_base, 0x2BD67B, 0x2BD67B}, {Role::cube_edge, 0xE4F3EA, 0x3B6B52},
    {Role::cube_face, 0x9FE8C4, 0x9FE8C4}, {Role::reference, 0xF0F2F5, 0x2A2F36},
    {Role::plane, 0x56B4E9, 0x56B4E9}, {Role::uncertain, 0xFFF3D6, 0x7A6428},
    {Role::map_point, 0xC9D2DC, 0x5B6470}, {Role::selected, 0xFFFFFF, 0x000000},
    {Role::pointed_at, 0x56B4E9, 0x56B4E9}, {Role::rotation, 0xCC79A7, 0xCC79A7},
    {Role::axis_x, 0xEF5B50, 0xEF5B50}, {Role::axis_y, 0x4CC26B, 0x4CC26B},
    {Role::axis_z, 0x4A90F0, 0x4A90F0}, {Role::gravity, 0xFFB3E6, 0x9A2A77},
    {Role::tracking, 0x56B4E9, 0x56B4E9}, {Role::ransac, 0xE69F00, 0xE69F00},
    {Role::rotations, 0xCC79A7, 0xCC79A7}, {Role::initialization, 0x009E73, 0x009E73},
    {Role::optimization, 0xF0E442, 0xF0E442}, {Role::scene_bottom, 0x15181D, 0xE9ECF0},
    {Role::scene_top, 0x262B33, 0xFAFBFC}, {Role::background, 0x14171B, 0xF4F6F8},
    {Role::panel, 0x1B1F25, 0xFFFFFF}, {Role::raised, 0x272D36, 0xE6EAEF},
    {Role::hovered, 0x343C48, 0xD8DEE6}, {Role::active, 0x3F4958, 0xC6CFDA},
    {Role::border, 0x323944, 0xCBD2DA}, {Role::text_dim, 0x98A2B0, 0x5A6472},
    {Role::text, 0xE6EAF0, 0x171B20}, {Role::accent, 0x5AB6EA, 0x006DAA},
    {Role::good, 0x1FCB94, 0x00775A}, {Role::warning, 0xE69F01, 0x925E00},
    {Role::bad, 0xF26A58, 0xC4311F},
};
// clang-format on
static_assert([] {
  for (std::size_t i = 0; i < std::size(kRoleColors); ++i)
    if (static_cast<std::size_t>(kRoleColors[i].role) != i) return false;
  return std::size(kRoleColors) == static_cast<std::size_t>(Role::bad) + 1;
}());

}  // namespace

std::uint32_t color_of(Role role, Theme theme) {
  const Colors& colors = kRoleColors[static_cast<std::size_t>(role)];
  return theme == Theme::dark ? colors.dark : colors.light;
}

}  // namespace gpo
