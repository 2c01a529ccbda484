// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/overlay/track_colors.h"

#include "engine/window/tracks.h"
#include "tests/ui/made_inspection.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace gpo {
namespace {

double luminance(std::uint32_t rgb) {
  return 0.2126 * ((rgb >> 16) & 255) + 0.7152 * ((rgb >> 8) & 255) + 0.0722 * (rgb & 255);
}

TEST(TrackColors, GrowBrighterWithTheNumberThatTheyTell) {
  const Inspection inspection = made_inspection();
  EXPECT_EQ(track_colors(inspection, Coloring::plane), nullptr);
  for (const Coloring coloring : {Coloring::residual, Coloring::depth, Coloring::life}) {
    const auto colors = track_colors(inspection, coloring);
    ASSERT_NE(colors, nullptr);
    ASSERT_EQ(std::ssize(colors->values), inspection.tracks->track_count());
    EXPECT_LT(colors->low, colors->high);
    for (int a = 0; a < inspection.tracks->track_count(); ++a) {
      for (int b = 0; b < inspection.tracks->track_count(); ++b) {
        if (!colors->values[a] || !colors->values[b] || *colors->values[a] >= *colors->values[b])
          continue;
        EXPECT_LE(luminance(colors->rgb(a)), luminance(colors->rgb(b)) + 1) << "rounded";
      }
    }
    EXPECT_EQ(legend_rows(*colors).size(), 2U);
  }
}

TEST(TrackColors, TellTheNumberThatTheResultHas) {
  const Inspection inspection = made_inspection();
  const auto depth = track_colors(inspection, Coloring::depth);
  for (const MapPoint& point : inspection.initialization->points)
    EXPECT_NEAR(depth->values[point.track].value(), point.position.z(), 1e-9);
  const auto life = track_colors(inspection, Coloring::life);
  for (int column = 0; column < inspection.tracks->track_count(); ++column) {
    int frames = 0;
    for (int i = 0; i < inspection.window->frame_count(); ++i)
      frames += inspection.tracks->seen(i, column) ? 1 : 0;
    EXPECT_EQ(life->values[column], frames);
  }
}

TEST(TrackColors, OfAFailureAreGrayWhereNothingIsKnown) {
  const auto colors = track_colors(made_inspection({.ok = false}), Coloring::residual);
  EXPECT_EQ(colors->rgb(0), color_of(Role::text_dim));
  ASSERT_EQ(legend_rows(*colors).size(), 1U);
  EXPECT_EQ(legend_rows(*colors)[0].text, "residual not known");
}

}  // namespace
}  // namespace gpo
