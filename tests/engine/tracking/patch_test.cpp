// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/tracking/patch.h"

#include "engine/base/processor.h"
#include "engine/geometry/statistics.h"
#include "engine/tracking/tracker.h"
#include "tests/engine/desk.h"
#include "tests/engine/largest.h"
#include "tests/engine/tracking/texture.h"

#include <algorithm>
#include <cstdint>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

using Eigen::Vector2d;
using Vector8d = Eigen::Matrix<double, 8, 1>;

cv::Mat smoothed_texture() {
  return smooth_image(image_of({120, 90}, [](const Vector2d& p) { return p; }));
}

Warp some_warp() {
  Warp warp{{61.37, 43.81}};
  warp.linear << 1.1, 0.2, -0.15, 0.9;
  warp.quadratic << 1e-3, -2e-3, 5e-4, 7e-4, 1e-3, -1e-3;
  return warp;
}

double between(const cv::Mat& smoothed, const Vector2d& px) {
  const auto u = static_cast<int>(px.x());
  const auto v = static_cast<int>(px.y());
  const double a = px.x() - u;
  const double b = px.y() - v;
  const auto at = [&](int du, int dv) { return smoothed.at<std::uint16_t>(v + dv, u + du); };
  return (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
}

/// Returns products and squares, summed pixel by pixel in double precision.
std::pair<Vector8d, double> slow_sums(const cv::Mat& smoothed,
                                      const Patch& patch,
                                      const Warp& warp) {
  Vector8d products = Vector8d::Zero();
  double squares = 0;
  for (std::size_t k = 0; k < patch.dx.size(); ++k) {
    const double dx = patch.dx[k];
    const double dy = patch.dy[k];
    const double I = patch.one[k] * between(smoothed, warp(Vector2d(dx, dy)));
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
  // Sums of about 450 terms of either sign, in floats.
  const double scale = std::sqrt(squares);
  for (int k = 0; k < 8; ++k)
    EXPECT_NEAR(sums.products[k], products[k], 1e-6 * scale * (1e4 + std::abs(products[k]) / scale))
        << k;
  EXPECT_NEAR(sums.squares / squares, 1, 1e-5);
}

/// Compares both versions with slow sums; those of a shift may lack the products of dx and dy.
void expect_slow_sums(const cv::Mat& smoothed, const Patch& patch, const Warp& warp) {
  const auto [products, squares] = slow_sums(smoothed, patch, warp);
  for (const bool avx2_fma : {false, has_avx2_fma()}) {
    expect_near(
        patch_sums(smoothed, patch, warp, MotionModel::affine, avx2_fma), products, squares);
    PatchSums of_shift = patch_sums(smoothed, patch, warp, MotionModel::shift, avx2_fma);
    of_shift.products.segment<4>(2) = products.segment<4>(2).cast<float>();
    expect_near(of_shift, products, squares);
  }
}

TEST(PatchKernel, MatchesSlowSums) {
  const cv::Mat smoothed = smoothed_texture();
  const Patch patch = make_patch(smoothed, {50, 40}, 10);
  ASSERT_TRUE(patch.is_complete);
  ASSERT_EQ(patch.row, 24);
  ASSERT_EQ(patch.dx.size(), 21U * 24U);
  expect_slow_sums(smoothed, patch, some_warp());
}

TEST(PatchKernel, MatchesSlowSumsOfWholePixelsAndOfAnyRotation) {
  const cv::Mat smoothed = smoothed_texture();
  const Patch patch = make_patch(smoothed, {50, 40}, 10);
  expect_slow_sums(smoothed, patch, {{60, 43}});
  Warp warp{{60.3, 43.9}};
  for (int deg = -180; deg < 180; deg += 15) {
    SCOPED_TRACE(deg);
    warp.linear = 1.3 * Eigen::Rotation2Dd(deg * M_PI / 180).toRotationMatrix();
    expect_slow_sums(smoothed, patch, warp);
  }
}

TEST(PatchKernel, MatchesSlowSumsOfATemplatePartlyOutsideOfItsImage) {
  const cv::Mat smoothed = smoothed_texture();
  const Patch patch = make_patch(smoothed, {6, 85}, 10);
  EXPECT_FALSE(patch.is_complete);
  expect_slow_sums(smoothed, patch, some_warp());
}

TEST(PatchKernel, TakesPixelsLikeATemplate) {
  const cv::Mat smoothed = smoothed_texture();
  const Patch whole = make_patch(smoothed, {50, 40}, 8);
  Patch patch;
  patch.half = 8;
  patch.row = 16;
  for (auto* values : {&patch.dx, &patch.slope_x, &patch.slope_y, &patch.brightness})
    values->resize(16 * 16);
  for (const bool avx2_fma : {false, has_avx2_fma()}) {
    const Eigen::Matrix4d normal = take_pixels(smoothed, {50, 40}, patch, avx2_fma);
    Eigen::Matrix4d slow = Eigen::Matrix4d::Zero();
    const float offset = patch.brightness[0] - whole.brightness[0];
    for (int k = 0; k < 16 * 16; ++k) {
      const int of_whole = k / 16 * whole.row + k % 16;
      EXPECT_EQ(patch.slope_x[k], whole.slope_x[of_whole]);
      EXPECT_EQ(patch.slope_y[k], whole.slope_y[of_whole]);
      EXPECT_NEAR(patch.brightness[k] - whole.brightness[of_whole], offset, 0.01);
      const Eigen::Vector4d column(patch.slope_x[k], patch.slope_y[k], patch.brightness[k], 1);
      slow += column * column.transpose();
    }
    EXPECT_NEAR(slow(2, 3), 0, 1);  // without its mean, in 64ths of a gray level
    const Eigen::Vector4d scale = slow.diagonal().cwiseSqrt();
    const Eigen::Matrix4d off =
        scale.cwiseInverse().asDiagonal() * (normal - slow) * scale.cwiseInverse().asDiagonal();
    EXPECT_LT(largest(off), 1e-5);
  }
}

TEST(PatchKernel, MatchesSlowSumsOfAShift) {
  const cv::Mat smoothed = smoothed_texture();
  Patch patch = make_patch(smoothed, {50, 40}, 8);
  // Rows of 16: without padding, the last column and row.
  std::vector<std::size_t> inner;
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 16; ++column) inner.push_back(row * patch.row + column);
  patch.row = 16;
  for (auto* values :
       {&patch.dx, &patch.dy, &patch.slope_x, &patch.slope_y, &patch.brightness, &patch.one}) {
    for (std::size_t k = 0; k < inner.size(); ++k) (*values)[k] = (*values)[inner[k]];
    values->resize(inner.size());
  }
  const Vector2d center(47.3, 52.9);
  auto [products, squares] = slow_sums(smoothed, patch, Warp{center});
  products.segment<4>(2).setZero();
  for (const bool avx2_fma : {false, has_avx2_fma()})
    expect_near(shifted_sums(smoothed, patch, center, avx2_fma), products, squares);
}

TEST(PatchKernel, ReadsOnlyPixelsOfTheImageInTheInsidePart) {
  const cv::Mat smoothed = smoothed_texture();
  const Patch patch = make_patch(smoothed, {50, 40}, 10);
  Warp warp = some_warp();
  for (const Vector2d& center : {Vector2d(3.2, 4.1), Vector2d(117.1, 86.5)}) {
    warp.center = center;
    EXPECT_FALSE(is_inside(smoothed.size(), patch, warp));
    const Patch part = inside_part(smoothed.size(), patch, warp);
    double pixels = 0;
    for (const float one : part.one) pixels += one;
    EXPECT_GT(pixels, 100);
    EXPECT_LT(pixels, 300);
    const auto [products, squares] = slow_sums(smoothed, part, warp);
    expect_near(patch_sums(smoothed, part, warp, MotionModel::affine), products, squares);
  }
}

const cv::Size kSize(160, 120);
const cv::Point kMiddle(70, 60);

PatchTemplate template_in_texture() {
  return make_patch_template(
      make_patch(smooth_image(image_of(kSize, [](const Vector2d& p) { return p; })), kMiddle, 10));
}

/// Returns an image of the texture moved by `warp` around kMiddle.
cv::Mat warped(const Warp& warp, double gain = 1, double offset = 0) {
  const Eigen::Matrix2d inverse = warp.linear.inverse();
  return smooth_image(image_of(
      kSize,
      [&](const Vector2d& p) {
        return Vector2d(Vector2d(kMiddle.x, kMiddle.y) + inverse * (p - warp.center));
      },
      gain,
      offset));
}

Warp affine_truth() {
  Warp truth{{78.37, 55.18}};
  truth.linear << 1.08, -0.07, 0.11, 0.94;
  return truth;
}

TEST(PatchAlignment, FindsAnAffineWarpOrAShiftUnderAnotherExposure) {
  const Warp truth = affine_truth();
  const Warp start{truth.center + Vector2d(1.1, -0.8)};
  const Found found =
      search(warped(truth, 0.6, 25), template_in_texture(), start, MotionModel::affine);
  ASSERT_FALSE(found.end);
  EXPECT_LT((found.warp.center - truth.center).norm(), 0.02);
  EXPECT_LT((found.warp.linear - truth.linear).norm(), 0.01);
  Warp moved = truth;
  moved.center += Vector2d(-0.9, 1);
  const Found shifted =
      search(warped(truth, 1.2, -20), template_in_texture(), moved, MotionModel::shift);
  ASSERT_FALSE(shifted.end);
  EXPECT_LT((shifted.warp.center - truth.center).norm(), 0.02);
  EXPECT_EQ(shifted.warp.linear, truth.linear);
}

TEST(PatchAlignment, FindsATemplatePartlyOutsideOfTheImage) {
  const Warp truth{{4.3, 57.6}};
  const Found found =
      search(warped(truth), template_in_texture(), {{5.2, 57}}, MotionModel::affine);
  ASSERT_FALSE(found.end);
  EXPECT_LT((found.warp.center - truth.center).norm(), 0.03);
}

TEST(PatchAlignment, ReportsWhyItFails) {
  const PatchTemplate patch_template = template_in_texture();
  const auto end = [&](const cv::Mat& image, const Warp& start, const SearchOptions& options) {
    const Found found = search(image, patch_template, start, MotionModel::shift, options);
    EXPECT_TRUE(found.end);
    return found.end.value_or(TrackEnd{});
  };
  const cv::Mat other = smooth_image(
      image_of(kSize, [](const Vector2d& p) { return Vector2d(300 + 2.1 * p.y(), 1.7 * p.x()); }));
  EXPECT_NE(end(other, {{60, 60}}, {}).reason, LossReason::left_image);
  EXPECT_EQ(end(warped({{70, 60}}), {{-3, 60}}, {}).reason, LossReason::left_image);
  const TrackEnd far = end(warped({{71.5, 60}}), {{70, 60}}, {.farthest_px = 0.5});
  EXPECT_EQ(far.reason, LossReason::far_from_prediction);
  EXPECT_GT(far.value, far.limit);
  cv::Mat noisy = image_of(kSize, [](const Vector2d& p) { return p; });
  cv::RNG random(7);
  cv::Mat noise(kSize, CV_8UC1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 40);
  noisy += noise;
  const TrackEnd noisily = end(smooth_image(noisy), {{70, 60}}, {.least_correlation = 0.99999});
  EXPECT_EQ(noisily.reason, LossReason::low_correlation);
  EXPECT_LT(noisily.value, noisily.limit);
}

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
  return smooth_image(gray);
}

TEST(PatchAlignment, SeparatesEdgesFromTemplatesWithDetail) {
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

TEST(SmoothedImage, SpreadsAPixelOverItsNeighborsAndKeepsAUniformImage) {
  cv::Mat gray(9, 11, CV_8UC1, cv::Scalar(0));
  gray.at<std::uint8_t>(4, 5) = 100;
  const cv::Mat smoothed = smooth_image(gray);
  ASSERT_EQ(smoothed.type(), CV_16UC1);
  const int weights[] = {1, 6, 1};
  for (int v = 0; v < 9; ++v)
    for (int u = 0; u < 11; ++u) {
      const bool near = std::abs(v - 4) <= 1 && std::abs(u - 5) <= 1;
      EXPECT_EQ(smoothed.at<std::uint16_t>(v, u), near ? 100 * weights[v - 3] * weights[u - 4] : 0);
    }
  const cv::Mat uniform = smooth_image(cv::Mat(6, 7, CV_8UC1, cv::Scalar(255)));
  for (const std::uint16_t value : cv::Mat_<std::uint16_t>(uniform)) EXPECT_EQ(value, 255 * 64);
  for (const std::uint16_t value : cv::Mat_<std::uint16_t>(halved(uniform)))
    EXPECT_EQ(value, 255 * 64);
}

TEST(SmoothedImage, HalvesToMeansOfFour) {
  cv::Mat smoothed(5, 6, CV_16UC1);
  for (int v = 0; v < 5; ++v)
    for (int u = 0; u < 6; ++u)
      smoothed.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(10 * v + u);
  const cv::Mat half = halved(smoothed);
  ASSERT_EQ(half.size(), cv::Size(3, 2));
  EXPECT_EQ(half.at<std::uint16_t>(0, 0), (0 + 1 + 10 + 11) / 4);
  EXPECT_EQ(half.at<std::uint16_t>(1, 2), (24 + 25 + 34 + 35) / 4);
}

TEST(SmoothedImage, IsTheSameForAnyWidth) {
  cv::Mat gray(21, 53, CV_8UC1);
  cv::randu(gray, 0, 256);
  const cv::Mat smoothed = smooth_image(gray);
  cv::Mat slow;
  const cv::Mat weights = (cv::Mat_<double>(3, 1) << 1, 6, 1);
  cv::sepFilter2D(gray, slow, CV_64F, weights, weights, {-1, -1}, 0, cv::BORDER_REPLICATE);
  cv::Mat values;
  smoothed.convertTo(values, CV_64F);
  EXPECT_EQ(cv::norm(values, slow, cv::NORM_INF), 0);
  const cv::Mat half = halved(smoothed);
  ASSERT_EQ(half.size(), cv::Size(26, 10));
  for (int v = 0; v < half.rows; ++v)
    for (int u = 0; u < half.cols; ++u)
      EXPECT_EQ(half.at<std::uint16_t>(v, u),
                static_cast<int>(cv::sum(smoothed({2 * u, 2 * v, 2, 2}))[0]) / 4);
}

cv::Mat shifted_image(const cv::Mat& gray, double dx, double dy, double gain) {
  cv::Mat shifted;
  const cv::Mat to = (cv::Mat_<double>(2, 3) << 1, 0, dx, 0, 1, dy);
  cv::warpAffine(gray, shifted, to, gray.size(), cv::INTER_LINEAR, cv::BORDER_REFLECT);
  shifted.convertTo(shifted, -1, gain, 10);
  return shifted;
}

TEST(CoarseFlow, EstimatesTheMotionAcrossStripes) {
  cv::Mat gray(240, 320, CV_8UC1);
  for (int u = 0; u < gray.cols; ++u)
    gray.col(u) = cv::Scalar(128 + 60 * std::sin(0.08 * u) + 50 * std::sin(0.031 * u));
  const Eigen::Matrix2Xd flow = coarse_flow(smoothed_pyramid(gray),
                                            smoothed_pyramid(shifted_image(gray, 5, 0, 1)),
                                            Eigen::Vector2d(160, 120));
  EXPECT_NEAR(flow(0, 0), 5, 0.3);  // the other component is not determined
}

TEST(CoarseFlow, EstimatesLargeMotionsForAnyExposureAndZeroWithoutTexture) {
  const cv::Mat gray = desk()->images->gray(0);
  const Eigen::Matrix2Xd corners = detect_corners(gray);
  for (const Vector2d& by : {Vector2d(0.4, -0.3), Vector2d(43.5, -28.25), Vector2d(-62, 39.5)})
    for (const double gain : {1.0, 0.6}) {
      const cv::Mat after = shifted_image(gray, by.x(), by.y(), gain);
      const Eigen::Matrix2Xd flow =
          coarse_flow(smoothed_pyramid(gray), smoothed_pyramid(after), corners);
      std::vector<double> errors;
      for (int j = 0; j < corners.cols(); ++j) {
        const Vector2d to = corners.col(j) + by;
        const bool stays = to.minCoeff() > 12 && to.x() < gray.cols - 12 && to.y() < gray.rows - 12;
        if (stays) errors.push_back((flow.col(j) - by).norm());
      }
      EXPECT_LT(median(errors), 0.15) << by.transpose() << ", " << gain;
      EXPECT_GT(std::ranges::count_if(errors, [](double e) { return e < 1.5; }),
                0.97 * static_cast<double>(errors.size()))
          << by.transpose() << ", " << gain;
    }
  const SmoothedPyramid empty = smoothed_pyramid(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)));
  Eigen::Matrix2Xd places(2, 3);
  places << 0, 160, 319, 0, 120, 239;
  EXPECT_EQ(coarse_flow(empty, empty, places), Eigen::Matrix2Xd::Zero(2, 3));
  const SmoothedPyramid tiny = smoothed_pyramid(cv::Mat(20, 20, CV_8UC1, cv::Scalar(1)));
  EXPECT_EQ(coarse_flow(tiny, tiny, places), Eigen::Matrix2Xd::Zero(2, 3));
}

}  // namespace
}  // namespace gpo::test
