// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/patch.h"

#include <cstdint>

namespace gpo {
namespace {

constexpr double kRounding_px = 0.01;  // more than floats are off, a look's reach from its middle

using Column = Eigen::Map<Eigen::ArrayXf>;
using ConstColumn = Eigen::Map<const Eigen::ArrayXf>;

ConstColumn column(const std::vector<float>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

void add_pixel(const cv::Mat& smoothed, const cv::Point& middle, const cv::Point& d, Patch& patch) {
  const cv::Point p = middle + d;
  const bool inside = p.x >= 1 && p.y >= 1 && p.x < smoothed.cols - 1 && p.y < smoothed.rows - 1;
  const auto at = [&](int u, int v) {
    return inside ? static_cast<float>(smoothed.at<std::uint16_t>(p.y + v, p.x + u)) : 0.0F;
  };
  patch.dx.push_back(static_cast<float>(d.x));
  patch.dy.push_back(static_cast<float>(d.y));
  patch.slope_x.push_back((at(1, 0) - at(-1, 0)) / 2);
  patch.slope_y.push_back((at(0, 1) - at(0, -1)) / 2);
  patch.brightness.push_back(at(0, 0));
  patch.one.push_back(inside ? 1 : 0);
}

}  // namespace

Patch make_patch(const cv::Mat& smoothed, const cv::Point& middle, int half) {
  Patch patch;
  patch.half = half;
  for (int v = -half; v <= half; ++v)
    for (int u = -half; u <= half; ++u) add_pixel(smoothed, middle, {u, v}, patch);
  const std::size_t padded =
      (patch.dx.size() + kPatchKernelWidth - 1) / kPatchKernelWidth * kPatchKernelWidth;
  for (auto* values :
       {&patch.dx, &patch.dy, &patch.slope_x, &patch.slope_y, &patch.brightness, &patch.one})
    values->resize(padded, 0.0F);
  const float pixels = column(patch.one).sum();
  Column brightness(patch.brightness.data(), static_cast<Eigen::Index>(padded));
  if (pixels > 0) brightness -= brightness.sum() / pixels * column(patch.one);
  return patch;
}

PatchNormalMatrix patch_normal_matrix(const Patch& patch) {
  const ConstColumn dx = column(patch.dx);
  const ConstColumn dy = column(patch.dy);
  const ConstColumn gx = column(patch.slope_x);
  const ConstColumn gy = column(patch.slope_y);
  Eigen::Matrix<float, Eigen::Dynamic, 8> columns(dx.size(), 8);
  columns << gx, gy, gx * dx, gx * dy, gy * dx, gy * dy, column(patch.brightness), column(patch.one);
  return (columns.transpose() * columns).cast<double>();
}

Eigen::Vector2d reach_px(const Patch& patch, const Warp& warp) {
  return patch.half * warp.linear.cwiseAbs().rowwise().sum() +
         patch.half * patch.half * warp.quadratic.cwiseAbs().rowwise().sum();
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
    for (auto* values :
         {&part.dx, &part.dy, &part.slope_x, &part.slope_y, &part.brightness, &part.one})
      (*values)[k] = 0;
  }
  return part;
}

}  // namespace gpo
