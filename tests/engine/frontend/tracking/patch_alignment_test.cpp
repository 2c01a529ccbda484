// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/patch_alignment.h"

#include "engine/frontend/tracking/smoothed_image.h"
#include "tests/engine/frontend/texture.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

const cv::Size kSize(160, 120);
const cv::Point kMiddle(70, 60);

PatchTemplate template_in_texture() {
  return make_patch_template(
      make_patch(smoothed(image_of(kSize, [](const Vector2d& p) { return p; })), kMiddle, 10));
}

/// The texture's picture where its places have gone as `warp` takes those around kMiddle.
cv::Mat warped(const Warp& warp, double gain = 1, double offset = 0) {
  const Matrix2d inverse = warp.linear.inverse();
  return smoothed(image_of(
      kSize,
      [&](const Vector2d& p) {
        return Vector2d(Vector2d(kMiddle.x, kMiddle.y) + inverse * (p - warp.center));
      },
      gain,
      offset));
}

TEST(PatchAlignment, FindsAnAffineWarpWithAnotherExposure) {
  Warp truth{{78.37, 55.18}};
  truth.linear << 1.08, -0.07, 0.11, 0.94;
  const Warp start{truth.center + Vector2d(1.1, -0.8)};
  const Found found = search(warped(truth, 0.6, 25), template_in_texture(), start, MotionModel::affine);
  ASSERT_FALSE(found.end);
  EXPECT_LT((found.warp.center - truth.center).norm(), 0.02);
  EXPECT_LT((found.warp.linear - truth.linear).norm(), 0.01);
}

TEST(PatchAlignment, LeavesTheShapeAsItIsWhereItSearchesForAShift) {
  Warp truth{{78.37, 55.18}};
  truth.linear << 1.08, -0.07, 0.11, 0.94;
  Warp start = truth;
  start.center += Vector2d(-0.9, 1);
  const Found found = search(warped(truth, 1.2, -20), template_in_texture(), start, MotionModel::shift);
  ASSERT_FALSE(found.end);
  EXPECT_LT((found.warp.center - truth.center).norm(), 0.02);
  EXPECT_EQ(found.warp.linear, truth.linear);
}

TEST(PatchAlignment, FindsALookOfWhichAPartHasLeftTheImage) {
  const Warp truth{{4.3, 57.6}};
  const Found found = search(warped(truth), template_in_texture(), {{5.2, 57}}, MotionModel::affine);
  ASSERT_FALSE(found.end);
  EXPECT_LT((found.warp.center - truth.center).norm(), 0.03);
}

TEST(PatchAlignment, TellsWhyItFindsNothing) {
  const PatchTemplate patch_template = template_in_texture();
  const cv::Mat other = smoothed(image_of(
      kSize, [](const Vector2d& p) { return Vector2d(300 + 2.1 * p.y(), 1.7 * p.x()); }));
  const Found unlike = search(other, patch_template, {{60, 60}}, MotionModel::shift);
  ASSERT_TRUE(unlike.end);
  EXPECT_TRUE(unlike.end->reason != LossReason::left_image);
  const Found outside = search(warped({{70, 60}}), patch_template, {{-3, 60}}, MotionModel::shift);
  ASSERT_TRUE(outside.end);
  EXPECT_EQ(outside.end->reason, LossReason::left_image);
  SearchOptions near;
  near.farthest_px = 0.5;
  const Found far = search(warped({{71.5, 60}}), patch_template, {{70, 60}}, MotionModel::shift, near);
  ASSERT_TRUE(far.end);
  EXPECT_EQ(far.end->reason, LossReason::far_from_prediction);
  EXPECT_GT(far.end->value, far.end->limit);
  SearchOptions strict;
  strict.least_correlation = 0.99999;
  cv::Mat noisy = image_of(kSize, [](const Vector2d& p) { return p; });
  cv::RNG random(7);
  cv::Mat noise(kSize, CV_8UC1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 40);
  noisy += noise;
  const Found noisily = search(smoothed(noisy), patch_template, {{70, 60}}, MotionModel::shift, strict);
  ASSERT_TRUE(noisily.end);
  EXPECT_EQ(noisily.end->reason, LossReason::low_correlation);
  EXPECT_LT(noisily.end->value, noisily.end->limit);
}

/// A step of brightness with noise of its own in every picture.
cv::Mat edge(std::uint64_t seed) {
  cv::Mat image(kSize, CV_32F);
  for (int v = 0; v < kSize.height; ++v)
    for (int u = 0; u < kSize.width; ++u)
      image.at<float>(v, u) =
          static_cast<float>(120 + 60 * std::tanh((u - 70.0 + 0.3 * v - 18) / 2));
  cv::RNG random(seed);
  cv::Mat noise(kSize, CV_32F);
  random.fill(noise, cv::RNG::NORMAL, 0, 3);
  cv::Mat gray;
  cv::Mat(image + noise).convertTo(gray, CV_8U);
  return smoothed(gray);
}

TEST(PatchAlignment, TellsAnEdgeFromWhatHasDetailAlongIt) {
  const PatchTemplate line = make_patch_template(make_patch(edge(1), kMiddle, 10));
  EXPECT_LT(line.edge, SearchOptions{}.edge);
  EXPECT_GT(std::abs(line.along_edge.dot(Vector2d(0.3, -1).normalized())), 0.99);
  const auto none = detail_along_edge(edge(2), line, {{70, 60}});
  ASSERT_TRUE(none);
  EXPECT_LT(*none, 0.5 * SearchOptions{}.least_detail);
  const PatchTemplate patch_template = template_in_texture();
  const Warp truth{{78.37, 55.18}};
  const auto all = detail_along_edge(warped(truth, 0.7, 10), patch_template, truth);
  ASSERT_TRUE(all);
  EXPECT_NEAR(*all, 1, 0.1);
  EXPECT_FALSE(detail_along_edge(warped(truth), patch_template, {{5, 60}}));
}

}  // namespace
}  // namespace gpo::test
