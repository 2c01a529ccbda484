// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "engine/recording/board/board.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core/version.hpp>
#include <opencv2/imgproc.hpp>

// The module `aruco` up to OpenCV 4.6, a part of `objdetect` since 4.7, see CMakeLists.txt.
#define GPO_ARUCO_IN_OBJDETECT (CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407)
#if GPO_ARUCO_IN_OBJDETECT
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

namespace gpo {
namespace {

using Quad = std::vector<cv::Point2f>;

const Eigen::Vector2d kHidden = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

auto dictionary_at(int number) {
#if GPO_ARUCO_IN_OBJDETECT
  return std::make_unique<cv::aruco::Dictionary>(cv::aruco::getPredefinedDictionary(number));
#else
  return cv::aruco::getPredefinedDictionary(number);
#endif
}

struct Detections {
  std::vector<int> ids;
  std::vector<Quad> corners;
  std::vector<Quad> others;
};

Detections detect(const cv::Mat& gray, int dictionary, int refinement) {
  Detections found;
#if GPO_ARUCO_IN_OBJDETECT
  cv::aruco::DetectorParameters parameters;
  parameters.cornerRefinementMethod = refinement;
  cv::aruco::ArucoDetector(*dictionary_at(dictionary), parameters)
      .detectMarkers(gray, found.corners, found.ids, found.others);
#else
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = refinement;
  cv::aruco::detectMarkers(
      gray, dictionary_at(dictionary), found.corners, found.ids, parameters, found.others);
#endif
  return found;
}

/// Largest distance between two markers' predictions of a corner, of a square's side.
constexpr double kMostApart = 0.2;

const std::vector<std::string>& dictionaries() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const char* bits : {"4X4", "5X5", "6X6", "7X7"})
      for (const int size : {50, 100, 250, 1000})
        names.push_back(fmt::format("DICT_{}_{}", bits, size));
    for (const char* other :
         {"ARUCO_ORIGINAL", "APRILTAG_16h5", "APRILTAG_25h9", "APRILTAG_36h10", "APRILTAG_36h11"})
      names.push_back(fmt::format("DICT_{}", other));
    return names;
  }();
  static_assert(cv::aruco::DICT_4X4_50 == 0 && cv::aruco::DICT_7X7_1000 == 15 &&
                cv::aruco::DICT_APRILTAG_36h11 == 20);
  return kNames;
}

int dictionary_of(const std::string& name) {
  const auto found = std::ranges::find(dictionaries(), name);
  CV_Assert(found != dictionaries().end());
  return static_cast<int>(found - dictionaries().begin());
}

/// A visible marker: homography from the board [squares] to the image, side there, and corners.
struct VisibleMarker {
  cv::Matx33d H;
  double square_px = 0;
  Quad corners;
};

std::vector<cv::Point> marker_squares(const Board& board, bool light_first) {
  std::vector<cv::Point> squares;
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = 0; column <= board.columns; ++column)
      if (((column + row) % 2 == 0) == light_first) squares.emplace_back(column, row);
  }
  return squares;
}

using MarkersBySquare = std::vector<std::optional<VisibleMarker>>;

MarkersBySquare place_markers(const Board& board, const Detections& seen, bool light_first) {
  const auto& [ids, corners, others] = seen;
  const auto squares = marker_squares(board, light_first);
  const auto side = static_cast<float>(board.markers->side_m / board.square_m);
  const float margin = (1 - side) / 2;
  const int square_count = (board.columns + 1) * (board.rows + 1);
  MarkersBySquare markers(static_cast<std::size_t>(square_count));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] >= static_cast<int>(squares.size())) continue;
    const cv::Point& square = squares[ids[i]];
    const cv::Point2f first(static_cast<float>(square.x) + margin,
                            static_cast<float>(square.y) + margin);
    const std::vector<cv::Point2f> on_board = {first,
                                               first + cv::Point2f(side, 0),
                                               first + cv::Point2f(side, side),
                                               first + cv::Point2f(0, side)};
    const cv::Mat H = cv::getPerspectiveTransform(on_board, corners[i]);
    const double side_px = cv::arcLength(corners[i], true) / 4;
    markers[square.y * (board.columns + 1) + square.x] =
        VisibleMarker{cv::Matx33d(H), side_px / side, corners[i]};
  }
  return markers;
}

/// Predicted position of a corner, and the radius of a window around it that touches no marker.
struct ExpectedCorner {
  cv::Point2f at;
  double reach_px = 0;
};

std::optional<ExpectedCorner> expected_corner(const MarkersBySquare& markers,
                                              const Board& board,
                                              int column,
                                              int row) {
  const cv::Vec3d on_board(column + 1, row + 1, 1);
  std::vector<cv::Point2f> guesses;
  double square_px = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const int k : {0, 1, 2, 3}) {
    const auto& marker = markers[(row + k / 2) * (board.columns + 1) + column + k % 2];
    if (!marker) continue;
    const cv::Vec3d p = marker->H * on_board;
    guesses.emplace_back(static_cast<float>(p[0] / p[2]), static_cast<float>(p[1] / p[2]));
    square_px = marker->square_px;
    for (const auto& corner : marker->corners)
      nearest = std::min(nearest, cv::norm(corner - guesses.back()));
  }
  if (guesses.size() != 2 || cv::norm(guesses[0] - guesses[1]) > kMostApart * square_px)
    return std::nullopt;
  return ExpectedCorner{(guesses[0] + guesses[1]) / 2, nearest / std::sqrt(2.0)};
}

Eigen::Vector2d refined(const cv::Mat& gray, const ExpectedCorner& expected) {
  const int half = std::clamp(static_cast<int>(0.9 * expected.reach_px), 2, 7);
  if (!cv::Rect2f(cv::Point2f(), gray.size()).contains(expected.at)) return kHidden;
  std::vector<cv::Point2f> corner = {expected.at};
  if (!refine_corners(corner, gray, half, half)[0]) return kHidden;
  return {corner[0].x, corner[0].y};
}

std::vector<Eigen::Vector2d> corners_between(const MarkersBySquare& markers,
                                             const cv::Mat& gray,
                                             const Board& board) {
  std::vector<Eigen::Vector2d> corners;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const auto expected = expected_corner(markers, board, column, row);
      corners.push_back(expected ? refined(gray, *expected) : kHidden);
    }
  }
  return corners;
}

std::size_t visible_count(const std::vector<Eigen::Vector2d>& corners) {
  return std::ranges::count_if(corners, [](const auto& corner) { return corner.allFinite(); });
}

constexpr int kFamily = cv::aruco::DICT_APRILTAG_36h11;
constexpr int kCode = 6;  // bits along a tag's side, without border

struct TagCode {
  int id = 0;
  int quarters = 0;
};

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

std::optional<TagCode> code_of(const cv::Mat& gray, const Quad& quad, int border) {
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
  constexpr double kMostCorrected = 0.4;  // fraction of the bits that the family can correct
  TagCode code;
  const bool known =
      dictionary_at(kFamily)->identify(white(inside) / 255, code.id, code.quarters, kMostCorrected);
  return known ? std::optional(code) : std::nullopt;
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

void refine(Quad& corners, const cv::Mat& gray, const Board& board) {
  const double bits = kCode + 2 * board.tags->border;
  const double plain = std::min(board.tags->border / bits, board.tags->spacing);
  const double side = cv::arcLength(corners, true) / 4;
  const int half = std::clamp(static_cast<int>(0.7 * plain * side), 2, 7);
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

void add_tags(Tags& tags, const cv::Mat& gray, const Board& board, int narrower_px) {
  const int size = 2 * narrower_px + 1;
  cv::Mat narrowed;
  cv::dilate(gray, narrowed, cv::getStructuringElement(cv::MORPH_RECT, {size, size}));
  Detections found = detect(narrowed, kFamily, cv::aruco::CORNER_REFINE_APRILTAG);
  std::ranges::move(found.others, std::back_inserter(found.corners));
  for (Quad quad : found.corners) {
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

std::optional<std::string> dictionary_name(const std::string& name) {
  for (const std::string& known : dictionaries())
    for (const std::string& specs : {name, "DICT_" + name})
      if (lower_case(specs) == lower_case(known)) return known;
  return std::nullopt;
}

std::string dictionary_names() { return fmt::format("{}", fmt::join(dictionaries(), ", ")); }

int dictionary_size(const std::string& dictionary) {
  return dictionary_at(dictionary_of(dictionary))->bytesList.rows;
}

int marker_count(const Board& board) { return (board.columns + 1) * (board.rows + 1) / 2; }

std::vector<Eigen::Vector2d> find_charuco(const cv::Mat& gray, const Board& board) {
  const Detections markers =
      detect(gray, dictionary_of(board.markers->dictionary), cv::aruco::CORNER_REFINE_NONE);
  auto corners = corners_between(place_markers(board, markers, false), gray, board);
  if (board.rows % 2 == 1) {  // even number of rows of squares
    // No two neighbors agree if the markers are assigned to the wrong squares.
    auto older = corners_between(place_markers(board, markers, true), gray, board);
    if (visible_count(older) > visible_count(corners)) corners = std::move(older);
  }
  if (visible_count(corners) == 0) return {};
  return corners;
}

int april_tag_count() { return dictionary_at(kFamily)->bytesList.rows; }

std::vector<Eigen::Vector2d> find_april_tags(const cv::Mat& gray, const Board& board) {
  const int corner_count = board.columns * board.rows;
  const auto expected = static_cast<std::size_t>(corner_count / 4);
  Tags tags;
  // Black squares that touch a tag's corners hide its outline until black areas are narrower.
  for (const int narrower_px : {0, 1, 2, 3})
    if (tags.size() < expected) add_tags(tags, gray, board, narrower_px);
  if (tags.empty() || tags.size() > expected) return {};
  std::vector<Eigen::Vector2d> corners(static_cast<std::size_t>(corner_count), kHidden);
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
