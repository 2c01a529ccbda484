// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/loggers/signed_axes.h"

#include <Eigen/LU>

namespace gpo {

std::optional<Eigen::Matrix3d> signed_axes(std::string_view text) {
  constexpr std::string_view kAxes = "XYZxyz";
  if (text.size() != 3) return std::nullopt;
  Eigen::Matrix3d rows = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const std::size_t axis = kAxes.find(text[i]);
    if (axis == std::string_view::npos) return std::nullopt;
    rows(i, static_cast<int>(axis % 3)) = axis < 3 ? 1 : -1;
  }
  return rows.determinant() > 0.5 ? std::optional(rows) : std::nullopt;
}

}  // namespace gpo
