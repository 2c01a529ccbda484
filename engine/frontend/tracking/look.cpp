// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/look.h"

#include <cstdint>

namespace gpo {
namespace {

constexpr double kRounding_px = 0.01;  // more than floats are off, a look's reach from its middle

using Column = Eigen::Map<Eigen::ArrayXf>;
using ConstColumn = Eigen::Map<const Eigen::ArrayXf>;

ConstColumn column(const std::vector<float>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

void add_pixel(const cv::Mat& soft, const cv::Point& middle, const cv::Point& d, Look& look) {
  const cv::Point p = middle + d;
  const bool inside = p.x >= 1 && p.y >= 1 && p.x < soft.cols - 1 && p.y < soft.rows - 1;
  const auto at = [&](int u, int v) {
    return inside ? static_cast<float>(soft.at<std::uint16_t>(p.y + v, p.x + u)) : 0.0F;
  };
  look.dx.push_back(static_cast<float>(d.x));
  look.dy.push_back(static_cast<float>(d.y));
  look.slope_x.push_back((at(1, 0) - at(-1, 0)) / 2);
  look.slope_y.push_back((at(0, 1) - at(0, -1)) / 2);
  look.brightness.push_back(at(0, 0));
  look.one.push_back(inside ? 1 : 0);
}

}  // namespace

Look make_look(const cv::Mat& soft, const cv::Point& middle, int half) {
  Look look;
  look.half = half;
  for (int v = -half; v <= half; ++v)
    for (int u = -half; u <= half; ++u) add_pixel(soft, middle, {u, v}, look);
  const std::size_t padded =
      (look.dx.size() + kLookKernelWidth - 1) / kLookKernelWidth * kLookKernelWidth;
  for (auto* values :
       {&look.dx, &look.dy, &look.slope_x, &look.slope_y, &look.brightness, &look.one})
    values->resize(padded, 0.0F);
  const float pixels = column(look.one).sum();
  Column brightness(look.brightness.data(), static_cast<Eigen::Index>(padded));
  if (pixels > 0) brightness -= brightness.sum() / pixels * column(look.one);
  return look;
}

LookNormal look_normal(const Look& look) {
  const ConstColumn dx = column(look.dx);
  const ConstColumn dy = column(look.dy);
  const ConstColumn gx = column(look.slope_x);
  const ConstColumn gy = column(look.slope_y);
  Eigen::Matrix<float, Eigen::Dynamic, 8> columns(dx.size(), 8);
  columns << gx, gy, gx * dx, gx * dy, gy * dx, gy * dy, column(look.brightness), column(look.one);
  return (columns.transpose() * columns).cast<double>();
}

Eigen::Vector2d reach_px(const Look& look, const Warp& warp) {
  return look.half * warp.linear.cwiseAbs().rowwise().sum() +
         look.half * look.half * warp.quadratic.cwiseAbs().rowwise().sum();
}

bool is_inside(const cv::Size& picture, const Look& look, const Warp& warp) {
  const Eigen::Vector2d reach = reach_px(look, warp).array() + kRounding_px;
  return warp.center.x() - reach.x() >= 0 && warp.center.y() - reach.y() >= 0 &&
         warp.center.x() + reach.x() < picture.width - 1 &&
         warp.center.y() + reach.y() < picture.height - 1;
}

Look inside_part(const cv::Size& picture, const Look& look, const Warp& warp) {
  Look part = look;
  for (std::size_t k = 0; k < part.dx.size(); ++k) {
    const Eigen::Vector2d px = warp(Eigen::Vector2d(part.dx[k], part.dy[k]));
    if (px.minCoeff() >= kRounding_px && px.x() < picture.width - 1 - kRounding_px &&
        px.y() < picture.height - 1 - kRounding_px)
      continue;
    for (auto* values :
         {&part.dx, &part.dy, &part.slope_x, &part.slope_y, &part.brightness, &part.one})
      (*values)[k] = 0;
  }
  return part;
}

}  // namespace gpo
