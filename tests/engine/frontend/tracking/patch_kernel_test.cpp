// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/processor.h"
#include "engine/frontend/tracking/patch.h"
#include "engine/frontend/tracking/smoothed_image.h"
#include "tests/engine/frontend/texture.h"

#include <cstdint>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Vector8d = Eigen::Matrix<double, 8, 1>;

cv::Mat soft_texture() {
  return smoothed(image_of({120, 90}, [](const Eigen::Vector2d& p) { return p; }));
}

/// Turned, sheared and bent.
Warp some_warp() {
  Warp warp{{61.37, 43.81}};
  warp.linear << 1.1, 0.2, -0.15, 0.9;
  warp.quadratic << 1e-3, -2e-3, 5e-4, 7e-4, 1e-3, -1e-3;
  return warp;
}

double between(const cv::Mat& smoothed, const Eigen::Vector2d& px) {
  const auto u = static_cast<int>(px.x());
  const auto v = static_cast<int>(px.y());
  const double a = px.x() - u;
  const double b = px.y() - v;
  const auto at = [&](int du, int dv) { return smoothed.at<std::uint16_t>(v + dv, u + du); };
  return (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
}

/// One pixel after the other, in double.
std::pair<Vector8d, double> slowly(const cv::Mat& smoothed, const Patch& patch, const Warp& warp) {
  Vector8d products = Vector8d::Zero();
  double squares = 0;
  for (std::size_t k = 0; k < patch.dx.size(); ++k) {
    const double dx = patch.dx[k];
    const double dy = patch.dy[k];
    const double I = patch.one[k] * between(smoothed, warp(Eigen::Vector2d(dx, dy)));
    const double gx = patch.slope_x[k];
    const double gy = patch.slope_y[k];
    Vector8d column;
    column << gx, gy, gx * dx, gx * dy, gy * dx, gy * dy, patch.brightness[k], patch.one[k];
    products += I * column;
    squares += I * I;
  }
  return {products, squares};
}

void expect_near(const PatchSums& sums, const Vector8d& products, double squares) {
  // Sums of some 450 terms of either sign, each of rounded floats.
  const double scale = std::sqrt(squares);
  for (int k = 0; k < 8; ++k)
    EXPECT_NEAR(sums.products[k], products[k], 1e-6 * scale * (1e4 + std::abs(products[k]) / scale))
        << k;
  EXPECT_NEAR(sums.squares / squares, 1, 1e-5);
}

TEST(PatchKernel, AddsUpWhatOnePixelAfterTheOtherAddsUpTo) {
  const cv::Mat smoothed = soft_texture();
  const Patch patch = make_patch(smoothed, {50, 40}, 10);
  const auto [products, squares] = slowly(smoothed, patch, some_warp());
  expect_near(patch_sums_baseline(smoothed, patch, some_warp()), products, squares);
  if (has_avx2_fma()) expect_near(patch_sums_avx2_fma(smoothed, patch, some_warp()), products, squares);
}

TEST(PatchKernel, OfAShiftAddsUpTheSame) {
  const cv::Mat smoothed = soft_texture();
  Patch patch = make_patch(smoothed, {50, 40}, 8);
  // Rows of 16: the last column and row are left out.
  std::vector<std::size_t> inner;
  for (std::size_t k = 0; k < 17 * 16; ++k)
    if (k % 17 != 16) inner.push_back(k);
  for (auto* values :
       {&patch.dx, &patch.dy, &patch.slope_x, &patch.slope_y, &patch.brightness, &patch.one}) {
    std::vector<float> kept;
    for (const std::size_t k : inner) kept.push_back((*values)[k]);
    *values = kept;
  }
  const Eigen::Vector2d center(47.3, 52.9);
  auto [products, squares] = slowly(smoothed, patch, Warp{center});
  products.segment<4>(2).setZero();
  expect_near(shifted_sums_baseline(smoothed, patch, center), products, squares);
  if (has_avx2_fma()) expect_near(shifted_sums_avx2_fma(smoothed, patch, center), products, squares);
}

TEST(PatchKernel, ReadsNothingOutsideOfTheImageInItsInsidePart) {
  const cv::Mat smoothed = soft_texture();
  const Patch patch = make_patch(smoothed, {50, 40}, 10);
  Warp warp = some_warp();
  for (const Eigen::Vector2d& center : {Eigen::Vector2d(3.2, 4.1), Eigen::Vector2d(117.1, 86.5)}) {
    warp.center = center;
    EXPECT_FALSE(is_inside(smoothed.size(), patch, warp));
    const Patch part = inside_part(smoothed.size(), patch, warp);
    double pixels = 0;
    for (const float one : part.one) pixels += one;
    EXPECT_GT(pixels, 100);
    EXPECT_LT(pixels, 300);
    const auto [products, squares] = slowly(smoothed, part, warp);
    expect_near(patch_sums(smoothed, part, warp), products, squares);
  }
}

}  // namespace
}  // namespace gpo::test
