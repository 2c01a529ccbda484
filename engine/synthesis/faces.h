// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// The face of a desk, a floor or a wall: a rectangle with its center at the origin, x right, y up
/// in its texture. A scale of 2 makes all that is painted on it twice as large and as coarse.
struct PaintedFace {
  Eigen::Vector2d size;  ///< [m]
  double scale = 1;
};

constexpr double kFaceTexelsPerMeter = 1600;   ///< of faces, at scale 1
constexpr double kSheetTexelsPerMeter = 2600;  ///< of prints and boxes, at scale 1

/// Place of a texel's center on the face [m].
Eigen::Vector2d texel_place(const PaintedFace& face, double col, double row, double per_meter);
cv::Mat empty_map(const PaintedFace& face, double per_meter, int type);

/// wood, parquet, plaster, bricks.
std::vector<std::string> surface_kinds();

/// CV_8UC3, +y at the picture's top, without light.
cv::Mat paint_face(const PaintedFace& face,
                   const std::string& kind,
                   std::uint64_t seed,
                   int threads);

/// A sheet on a face; `picture` is CV_8UC4 and seen with +y of the sheet at the picture's top.
struct Sheet {
  Eigen::Vector2d center;
  Eigen::Vector2d size;
  Eigen::Matrix2d turn;  ///< from the face into the sheet's axes
  cv::Mat picture;
};
void lay_sheet(cv::Mat& texture, const PaintedFace& face, const Sheet& sheet, int threads);

}  // namespace gpo
