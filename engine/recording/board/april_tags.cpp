// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/board.h"
#include "engine/recording/board/opencv_aruco.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr int kFamily = cv::aruco::DICT_APRILTAG_36h11;
constexpr int kCode = 6;  // bits along a tag's side, without border

using Quad = std::vector<cv::Point2f>;

double side_of(const Quad& quad) { return cv::arcLength(quad, true) / 4; }

Quad widened(const Quad& quad, double by_px) {
  Quad wider = quad;
  for (int k = 0; k < 4; ++k) {
    const cv::Point2f before = quad[k] - quad[(k + 3) % 4], after = quad[(k + 1) % 4] - quad[k];
    // y is down, so the outside of a clockwise contour is on its left.
    const cv::Vec2d n(before.y / cv::norm(before), -before.x / cv::norm(before));
    const cv::Vec2d m(after.y / cv::norm(after), -after.x / cv::norm(after));
    const double sine = n[0] * m[1] - n[1] * m[0];
    if (!(std::abs(sine) > 0.1)) continue;
    wider[k] += cv::Point2f(static_cast<float>(by_px * (m[1] - n[1]) / sine),
                            static_cast<float>(by_px * (n[0] - m[0]) / sine));
  }
  return wider;
}

/// Decodes the tag in a quadrilateral; nullopt if there is none.
std::optional<MarkerCode> code_of(const cv::Mat& gray, const Quad& quad, int border) {
  constexpr int kBit = 6;  // px
  const int bits = kCode + 2 * border;
  const float first = -0.5F;  // left border of the first pixel
  const float last = static_cast<float>(bits * kBit) - 0.5F;
  const Quad square = {{first, first}, {last, first}, {last, last}, {first, last}};
  cv::Mat flat, means;
  cv::warpPerspective(gray,
                      flat,
                      cv::getPerspectiveTransform(quad, square),
                      {bits * kBit, bits * kBit},
                      cv::INTER_LINEAR,
                      cv::BORDER_REPLICATE);
  cv::resize(flat, means, {bits, bits}, 0, 0, cv::INTER_AREA);
  double darkest = 0, lightest = 0;
  cv::minMaxLoc(means, &darkest, &lightest);
  constexpr double kLeastContrast = 20;
  if (lightest - darkest < kLeastContrast) return std::nullopt;
  const cv::Mat white = means > (darkest + lightest) / 2;
  const cv::Rect inside(border, border, kCode, kCode);
  constexpr int kMostWhiteInBorder = 2;  // bits
  if (cv::countNonZero(white) - cv::countNonZero(white(inside)) > kMostWhiteInBorder)
    return std::nullopt;
  return identify_marker(white(inside) / 255, kFamily);
}

/// Returns the column and row (from the top) of a tag; nullopt if the board lacks this number.
std::optional<cv::Point> place_of(int id, const Board& board) {
  if (const auto& alone = board.tags->alone) {
    const bool wanted = *alone == BoardTags::kAnyTag || *alone == id;
    return wanted ? std::optional(cv::Point()) : std::nullopt;
  }
  const int columns = board.columns / 2;
  const int rows = board.rows / 2;
  if (id < 0 || id >= columns * rows) return std::nullopt;
  return cv::Point(id % columns, rows - 1 - id / columns);
}

/// Refines the corners of a tag in a grid, where each touches two black squares.
void refine(Quad& corners, const cv::Mat& gray, const Board& board) {
  const double bits = kCode + 2 * board.tags->border;
  const double plain = std::min(board.tags->border / bits, board.tags->spacing);
  const int half = std::clamp(static_cast<int>(0.7 * plain * side_of(corners)), 2, 7);
  refine_corners(corners, gray, half, half);
}

bool is_inside(const Quad& quad, const cv::Mat& gray) {
  constexpr float kMargin = 2;
  return std::ranges::all_of(quad, [&](const cv::Point2f& corner) {
    return corner.x >= kMargin && corner.y >= kMargin &&
           corner.x <= static_cast<float>(gray.cols - 1) - kMargin &&
           corner.y <= static_cast<float>(gray.rows - 1) - kMargin;
  });
}

/// Tags by their numbers; corners clockwise from the tag's own top left.
using Tags = std::map<int, Quad>;

/// Adds the tags that appear after all black areas are narrowed.
void add_tags(Tags& tags, const cv::Mat& gray, const Board& board, int narrower_px) {
  const int size = 2 * narrower_px + 1;
  cv::Mat narrowed;
  cv::dilate(gray, narrowed, cv::getStructuringElement(cv::MORPH_RECT, {size, size}));
  for (Quad quad : dark_quads(narrowed)) {
    constexpr float kAprilTags = 0.5F;  // center of the first pixel in AprilTag's convention
    for (cv::Point2f& corner : quad) corner -= cv::Point2f(kAprilTags, kAprilTags);
    quad = widened(quad, narrower_px);
    if (!is_inside(quad, gray)) continue;
    if (!board.tags->alone) refine(quad, gray, board);
    const auto code = code_of(gray, quad, board.tags->border);
    if (!code || tags.contains(code->id) || !place_of(code->id, board)) continue;
    // OpenCV stores this family upside down.
    std::rotate(quad.begin(), quad.begin() + (6 - code->quarters) % 4, quad.end());
    tags[code->id] = quad;
  }
}

}  // namespace

int april_tag_count() { return marker_dictionary_size(kFamily); }

std::vector<Eigen::Vector2d> find_april_tags(const cv::Mat& gray, const Board& board) {
  const int corner_count = board.columns * board.rows;
  const auto expected = static_cast<std::size_t>(corner_count / 4);
  Tags tags;
  // Black squares that touch a tag's corners hide its outline until black areas are narrower.
  for (const int narrower_px : {0, 1, 2, 3})
    if (tags.size() < expected) add_tags(tags, gray, board, narrower_px);
  if (tags.empty() || tags.size() > expected) return {};
  const Eigen::Vector2d none = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::vector<Eigen::Vector2d> corners(static_cast<std::size_t>(corner_count), none);
  for (const auto& [id, quad] : tags) {
    static const std::array<cv::Point, 4> kOffsets = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (int k = 0; k < 4; ++k) {
      const cv::Point at = 2 * *place_of(id, board) + kOffsets[k];
      corners[at.y * board.columns + at.x] = {quad[k].x, quad[k].y};
    }
  }
  return corners;
}

}  // namespace gpo
