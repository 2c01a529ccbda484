// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/overlay/overlay.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

// Right by 5, then up by 5.
const std::vector<Vector2d> kBent = {{0, 0}, {5, 0}, {5, 5}};

TEST(DashPattern, DashesBendWithTheLine) {
  const std::vector<double> pattern = {3, 1};
  EXPECT_THAT(dashes_along(kBent, pattern),
              ElementsAre(Pair(Vector2d(0, 0), Vector2d(3, 0)),
                          Pair(Vector2d(4, 0), Vector2d(5, 0)),
                          Pair(Vector2d(5, 0), Vector2d(5, 2)),
                          Pair(Vector2d(5, 3), Vector2d(5, 5))));
}

TEST(DashPattern, RoundingNeverStopsIt) {
  std::vector<Vector2d> line;
  for (int i = 0; i < 2000; ++i) line.emplace_back(0.1 * i, 0.1 * (i % 7));
  EXPECT_LT(dashes_along(line, std::vector<double>{0.1, 0.3}).size(), 10000U);
}

TEST(DashPattern, OnePointHasNoLength) {
  const std::vector<Vector2d> point = {{1, 1}, {1, 1}};
  EXPECT_THAT(dashes_along(point, std::vector<double>{3, 1}), IsEmpty());
}

}  // namespace
}  // namespace gpo
