// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/made_inspection.h"
#include "ui/views/image/pointing.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(DistanceText, IsInMetersWhereTheAccelerometerTellsThem) {
  Inspection inspection = made_inspection();
  const Eigen::Vector3d a(0.1, 0, 1), b(0.1, 0.6, 1.8);
  EXPECT_EQ(distance_text(inspection, a, b), "1.000 d");
  InertialAlignment inertial;
  inertial.ok = inertial.scale_known = true;
  inertial.scale = 0.25;
  inspection.inertial = inertial;
  EXPECT_EQ(distance_text(inspection, a, b), "250 mm");
}

}  // namespace
}  // namespace gpo
