// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/rotation_averaging.h"

#include "tests/engine/rotation_error.h"

#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using test::rotation_error_deg;

std::vector<Matrix3d> random_rotations(int count) {
  std::vector<Matrix3d> R{Matrix3d::Identity()};
  for (int i = 1; i < count; ++i) R.push_back(so3_exp(0.5 * Eigen::Vector3d::Random()));
  return R;
}

TEST(RotationAveraging, SurvivesAThirdOfGrossOutliers) {
  std::srand(5);
  std::mt19937_64 random(5);
  const auto truth = random_rotations(20);
  std::vector<RelativeRotation> relative;
  for (int i = 0; i < 20; ++i) {
    for (int j = i + 1; j < 20; ++j) {
      const double size = random() % 3 == 0 && i > 0 ? 0.8 : 0.001;
      relative.push_back(
          {i, j, truth[i].transpose() * truth[j] * so3_exp(size * Eigen::Vector3d::Random())});
    }
  }
  std::vector<Matrix3d> start{Matrix3d::Identity()};
  for (int j = 1; j < 20; ++j) start.push_back(truth[j] * so3_exp(0.1 * Eigen::Vector3d::Random()));
  const auto R = average_rotations(relative, start);
  for (int i = 0; i < 20; ++i) EXPECT_LT(rotation_error_deg(R[i], truth[i]), 0.1);
}

}  // namespace
}  // namespace gpo
