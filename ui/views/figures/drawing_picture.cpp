// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/figures/drawing.h"
#include "ui/views/figures/glyphs.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Vector2d;

constexpr int kShift = 4;  ///< binary digits of a pixel that OpenCV is told

/// A picture that is several times as large as the one that is asked for, so that edges are smooth.
class Sheet {
 public:
  Sheet(cv::Size size, double scale)
      : scale_(scale), pixels_(size, CV_8UC3, cv::Scalar::all(255)) {}

  void draw(const Fill& fill) {
    const std::vector<cv::Point> outline = points(fill.outline);
    paint(fill.ink, outline, 0, [&](cv::Mat& mat, const cv::Scalar& color) {
      cv::fillPoly(mat, std::vector{outline}, color, cv::LINE_8, kShift);
    });
  }

  void draw(const Stroke& stroke) {
    const std::vector<cv::Point> line = points(stroke.line);
    const int width = std::max(1, static_cast<int>(std::lround(scale_ * stroke.width)));
    paint(stroke.ink, line, width, [&](cv::Mat& mat, const cv::Scalar& color) {
      cv::polylines(mat, std::vector{line}, false, color, width, cv::LINE_8, kShift);
    });
  }

  void draw(const Text& text) {
    std::vector<std::vector<cv::Point>> contours;
    for (const std::vector<Vector2d>& contour : flattened(outlines_of(text)))
      contours.push_back(points(contour));
    if (contours.empty()) return;
    cv::fillPoly(pixels_, contours, color_of(text.rgb), cv::LINE_8, kShift);
  }

  cv::Mat reduced(cv::Size size) const {
    cv::Mat picture;
    cv::resize(pixels_, picture, size, 0, 0, cv::INTER_AREA);
    return picture;
  }

 private:
  static cv::Scalar color_of(std::uint32_t rgb) {
    return {static_cast<double>(rgb & 0xFF),
            static_cast<double>(rgb >> 8 & 0xFF),
            static_cast<double>(rgb >> 16 & 0xFF)};
  }

  std::vector<cv::Point> points(std::span<const Vector2d> line) const {
    std::vector<cv::Point> result;
    result.reserve(line.size());
    for (const Vector2d& point : line) {
      // The center of OpenCV's first pixel is (0, 0), the drawing's begins there.
      const Vector2d px = (scale_ * point).array() - 0.5;
      result.emplace_back(static_cast<int>(std::lround(std::ldexp(px.x(), kShift))),
                          static_cast<int>(std::lround(std::ldexp(px.y(), kShift))));
    }
    return result;
  }

  static std::vector<std::vector<Vector2d>> flattened(const std::vector<OutlinePiece>& pieces) {
    constexpr int kSteps = 6;
    std::vector<std::vector<Vector2d>> contours;
    for (const OutlinePiece& piece : pieces) {
      if (piece.kind == OutlinePiece::Kind::move) contours.emplace_back();
      std::vector<Vector2d>& contour = contours.back();
      const auto& [a, b, end] = piece.points;
      if (piece.kind == OutlinePiece::Kind::cubic) {
        const Vector2d begin = contour.back();
        for (int i = 1; i < kSteps; ++i) {
          const double t = static_cast<double>(i) / kSteps, u = 1 - t;
          contour.emplace_back(u * u * u * begin + 3 * u * u * t * a + 3 * u * t * t * b +
                               t * t * t * end);
        }
      }
      contour.push_back(end);
    }
    return contours;
  }

  /// `draw(mat, color)`; what is translucent on a copy of what is around it.
  template <class Draw>
  void paint(const Ink& ink, const std::vector<cv::Point>& points, int width, const Draw& draw) {
    if (points.empty()) return;
    if (ink.opacity >= 1) return draw(pixels_, color_of(ink.rgb));
    const cv::Rect box = cv::boundingRect(points);
    const int x = (box.x >> kShift) - width - 1, y = (box.y >> kShift) - width - 1;
    const cv::Rect around(
        x, y, (box.width >> kShift) + 2 * width + 4, (box.height >> kShift) + 2 * width + 4);
    const cv::Mat before = pixels_(around & cv::Rect({0, 0}, pixels_.size())).clone();
    draw(pixels_, color_of(ink.rgb));
    cv::Mat after = pixels_(around & cv::Rect({0, 0}, pixels_.size()));
    cv::addWeighted(after, ink.opacity, before, 1 - ink.opacity, 0, after);
  }

  double scale_;
  cv::Mat pixels_;
};

}  // namespace

cv::Mat picture_of(const Drawing& drawing, double px_per_unit) {
  const cv::Size size(static_cast<int>(std::lround(drawing.width * px_per_unit)),
                      static_cast<int>(std::lround(drawing.height * px_per_unit)));
  constexpr int kLargestDrawn = 6400;
  const int factor = std::clamp(kLargestDrawn / std::max(size.width, size.height), 1, 4);
  Sheet sheet(size * factor, px_per_unit * factor);
  for (const auto& item : drawing.items)
    std::visit([&](const auto& one) { sheet.draw(one); }, item);
  return sheet.reduced(size);
}

}  // namespace gpo
