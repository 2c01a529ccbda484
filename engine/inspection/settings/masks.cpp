// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/settings/settings_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {

std::vector<Eigen::Vector2d> Mask::outline() const {
  if (corners_raw_px.size() != 2) return corners_raw_px;
  const Eigen::Vector2d &a = corners_raw_px[0], &b = corners_raw_px[1];
  return {a, {b.x(), a.y()}, b, {a.x(), b.y()}};
}

bool Mask::contains(const Eigen::Vector2d& raw_px) const {
  const std::vector<Eigen::Vector2d> corners = outline();
  bool inside = false;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Eigen::Vector2d &a = corners[k], &b = corners[(k + 1) % corners.size()];
    if ((a.y() > raw_px.y()) == (b.y() > raw_px.y())) continue;
    const double x = a.x() + (raw_px.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (raw_px.x() < x) inside = !inside;
  }
  return inside;
}

double Mask::area_px2() const {
  const std::vector<Eigen::Vector2d> corners = outline();
  double twice = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Eigen::Vector2d &a = corners[k], &b = corners[(k + 1) % corners.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2;
}

std::string Mask::text() const {
  std::vector<double> numbers;
  for (const Eigen::Vector2d& corner : corners_raw_px)
    numbers.insert(numbers.end(), {corner.x(), corner.y()});
  return fmt::format("{}:{}", to_string(kind), fmt::join(numbers, ","));
}

bool Masks::contain(MaskKind kind, const Eigen::Vector2d& raw_px) const {
  return std::ranges::any_of(
      areas, [&](const Mask& mask) { return mask.kind == kind && mask.contains(raw_px); });
}

bool Masks::has(MaskKind kind) const {
  return std::ranges::find(areas, kind, &Mask::kind) != areas.end();
}

std::vector<std::int64_t> left_out(const Tracks& tracks, const Masks& masks) {
  std::vector<std::int64_t> ids;
  if (!masks.has(MaskKind::leave_out)) return ids;
  for (int j = 0; j < tracks.track_count(); ++j)
    if (masks.contain(MaskKind::leave_out, tracks.raw_px[0].col(j))) ids.push_back(tracks.ids[j]);
  return ids;
}

std::vector<bool> on_first_plane(const Tracks& tracks, const Masks& masks) {
  std::vector<bool> on_plane;
  if (!masks.has(MaskKind::plane)) return on_plane;
  for (int j = 0; j < tracks.track_count(); ++j)
    on_plane.push_back(masks.contain(MaskKind::plane, tracks.raw_px[0].col(j)));
  return on_plane;
}

}  // namespace gpo
