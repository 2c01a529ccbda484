// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/palette.h"

#include <algorithm>
#include <iterator>

namespace gpo {
namespace {

using namespace palette;

struct Pair {
  std::uint32_t dark, light;
};

constexpr Pair kPairs[] = {
    {kSceneBottom, 0xE9ECF0}, {kSceneTop, 0xFAFBFC},  {kBackground, 0xF4F6F8},
    {kPanel, 0xFFFFFF},       {kRaised, 0xE6EAEF},    {kHovered, 0xD8DEE6},
    {kActive, 0xC6CFDA},      {kBorder, 0xCBD2DA},    {kTextDim, 0x5A6472},
    {kText, 0x171B20},        {kAccent, 0x0072B2},    {kGood, 0x00795C},
    {kWarning, 0x9A6400},     {kBad, 0xC4311F},       {kTruth, 0x6E757E},
    {kCubeEdge, 0x3B6B52},    {kReference, 0x2A2F36}, {kUncertain, 0x7A6428},
    {kPoint, 0x5B6470},       {kSelected, 0x000000}};

Theme shown = Theme::dark;

}  // namespace

void set_theme(Theme theme) { shown = theme; }

Theme current_theme() { return shown; }

std::uint32_t themed(std::uint32_t rgb) {
  if (shown == Theme::dark) return rgb;
  const auto* found = std::ranges::find(kPairs, rgb, &Pair::dark);
  return found == std::end(kPairs) ? rgb : found->light;
}

}  // namespace gpo
