// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/normals_zoom.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

const ScreenRect kDiscRect{{100, 50}, {400, 300}};

TEST(NormalsZoom, MappingFitsAndCanBeTurnedRound) {
  const DiscMapping all = map_disc(kDiscRect, {});
  EXPECT_EQ(all.to_screen({0, 0}), Vector2d(300, 200));
  EXPECT_LT(all.radius, 150) << "the rim and its labels are within";
  const DiscMapping zoomed = map_disc(kDiscRect, {20, {0.3, -0.2}});
  EXPECT_LT((zoomed.to_screen({0.3, -0.2}) - Vector2d(300, 200)).norm(), 1e-9);
  EXPECT_LT((zoomed.to_disc(zoomed.to_screen({0.31, -0.25})) - Vector2d(0.31, -0.25)).norm(),
            1e-12);
}

TEST(NormalsZoom, WhatIsUnderThePointerStaysThere) {
  const Vector2d pointer(340, 170);
  const Vector2d before = map_disc(kDiscRect, {}).to_disc(pointer);
  const NormalsZoom zoom = zoom_about({}, kDiscRect, pointer, 8);
  EXPECT_DOUBLE_EQ(zoom.factor, 8);
  EXPECT_LT((map_disc(kDiscRect, zoom).to_disc(pointer) - before).norm(), 1e-9);
  EXPECT_EQ(zoom_about(zoom, kDiscRect, pointer, 1e-9).factor, 1);
  EXPECT_EQ(zoom_about(zoom, kDiscRect, pointer, 1e-9).center, Vector2d(0, 0)) << "all of it";
  EXPECT_EQ(zoom_about(zoom, kDiscRect, pointer, 1e9).factor, kLargestNormalsZoom);
}

TEST(NormalsZoom, PanMovesByScreenPixelsAndKeepsTheDiscInView) {
  const NormalsZoom zoom{10, {0.1, 0.1}};
  const NormalsZoom moved = pan(zoom, kDiscRect, {15, -7});
  const Vector2d place(0.12, 0.1);
  EXPECT_LT((map_disc(kDiscRect, moved).to_screen(place) -
             map_disc(kDiscRect, zoom).to_screen(place) - Vector2d(15, -7))
                .norm(),
            1e-9);
  EXPECT_LE(pan(zoom, kDiscRect, {1e6, 0}).center.norm(), 1 + 1e-12);
}

}  // namespace
}  // namespace gpo
