// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/tracking/patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace gpo {
namespace {

constexpr double kRounding_px = 0.01;  // more than the rounding of floats

using Column = Eigen::Map<Eigen::ArrayXf>;
using ConstColumn = Eigen::Map<const Eigen::ArrayXf>;

ConstColumn column(const std::vector<float>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

std::array<std::vector<float>*, 6> columns_of(Patch& patch) {
  return {&patch.dx, &patch.dy, &patch.slope_x, &patch.slope_y, &patch.brightness, &patch.one};
}

void add_pixel(const cv::Mat& image, const cv::Point& middle, const cv::Point& d, Patch& patch) {
  const cv::Point p = middle + d;
  const bool inside = p.x >= 1 && p.y >= 1 && p.x < image.cols - 1 && p.y < image.rows - 1;
  const auto at = [&](int u, int v) {
    return inside ? static_cast<float>(image.at<std::uint16_t>(p.y + v, p.x + u)) : 0.0F;
  };
  patch.dx.push_back(static_cast<float>(d.x));
  patch.dy.push_back(static_cast<float>(d.y));
  patch.slope_x.push_back((at(1, 0) - at(-1, 0)) / 2);
  patch.slope_y.push_back((at(0, 1) - at(0, -1)) / 2);
  patch.brightness.push_back(at(0, 0));
  patch.one.push_back(inside ? 1 : 0);
}

}  // namespace

Patch make_patch(const cv::Mat& image, const cv::Point& middle, int half) {
  Patch patch;
  patch.half = half;
  patch.row = (2 * half + kPatchKernelWidth) / kPatchKernelWidth * kPatchKernelWidth;
  for (int v = -half; v <= half; ++v) {
    for (int u = -half; u <= half; ++u) add_pixel(image, middle, {u, v}, patch);
    for (auto* values : columns_of(patch)) values->resize((v + half + 1) * patch.row, 0.0F);
  }
  const float pixels = column(patch.one).sum();
  patch.is_complete = pixels == static_cast<float>((2 * half + 1) * (2 * half + 1));
  Column brightness(patch.brightness.data(), std::ssize(patch.brightness));
  if (pixels > 0) brightness -= brightness.sum() / pixels * column(patch.one);
  return patch;
}

PatchNormalMatrix patch_normal_matrix(const Patch& patch) {
  const ConstColumn dx = column(patch.dx);
  const ConstColumn dy = column(patch.dy);
  const ConstColumn gx = column(patch.slope_x);
  const ConstColumn gy = column(patch.slope_y);
  Eigen::Matrix<float, Eigen::Dynamic, 8> columns(dx.size(), 8);
  columns << gx, gy, gx * dx, gx * dy, gy * dx, gy * dy, column(patch.brightness),
      column(patch.one);
  return (columns.transpose() * columns).cast<double>();
}

bool is_inside(const cv::Size& image, const Patch& patch, const Warp& warp) {
  const Eigen::Vector2d reach = reach_px(patch, warp).array() + kRounding_px;
  return warp.center.x() - reach.x() >= 0 && warp.center.y() - reach.y() >= 0 &&
         warp.center.x() + reach.x() < image.width - 1 &&
         warp.center.y() + reach.y() < image.height - 1;
}

Patch inside_part(const cv::Size& image, const Patch& patch, const Warp& warp) {
  Patch part = patch;
  for (std::size_t k = 0; k < part.dx.size(); ++k) {
    const Eigen::Vector2d px = warp(Eigen::Vector2d(part.dx[k], part.dy[k]));
    if (px.minCoeff() >= kRounding_px && px.x() < image.width - 1 - kRounding_px &&
        px.y() < image.height - 1 - kRounding_px)
      continue;
    for (auto* values : columns_of(part)) (*values)[k] = 0;
    part.is_complete = false;
  }
  return part;
}

}  // namespace gpo
