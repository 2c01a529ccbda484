// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/calibration/calibrate.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/board/board.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

namespace gpo {

namespace {

constexpr int kLeastCorners = 8;
constexpr int kCornersOfTag = 4;
constexpr double kMostBlurred = 2;  // times the median width of edges
constexpr int kSuccessive = 5;      // images that determine velocities

using Feature = Eigen::Matrix<double, 6, 1>;

std::optional<double> gray_at(const cv::Mat& gray, const Eigen::Vector2d& at) {
  const int u = static_cast<int>(std::floor(at.x()));
  const int v = static_cast<int>(std::floor(at.y()));
  if (u < 0 || v < 0 || u + 1 >= gray.cols || v + 1 >= gray.rows) return std::nullopt;
  const double a = at.x() - u;
  const double b = at.y() - v;
  const auto px = [&](int x, int y) { return static_cast<double>(gray.at<std::uint8_t>(y, x)); };
  return (1 - b) * ((1 - a) * px(u, v) + a * px(u + 1, v)) +
         b * ((1 - a) * px(u, v + 1) + a * px(u + 1, v + 1));
}

/// Width of the edge between two corners, at its middle: contrast by steepest slope.
std::optional<double> edge_width(const cv::Mat& gray,
                                 const Eigen::Vector2d& a,
                                 const Eigen::Vector2d& b,
                                 double reach) {
  const Eigen::Vector2d along = b - a;
  const Eigen::Vector2d across = Eigen::Vector2d(-along.y(), along.x()).normalized();
  const double half = std::max(2.0, reach * along.norm());
  const auto at = [&](double t) { return gray_at(gray, (a + b) / 2 + t * across); };
  const auto low = at(-half);
  const auto high = at(half);
  if (!low || !high) return std::nullopt;
  double slope = 0;
  const int steps = static_cast<int>(2 * (2 * half - 1));
  for (int k = 0; k <= steps; ++k) {
    const double t = -half + 0.5 * (k + 1);
    slope = std::max(slope, std::abs(*at(t + 0.5) - *at(t - 0.5)));
  }
  constexpr double kLeastContrast = 20;
  const double contrast = std::abs(*high - *low);
  if (contrast < kLeastContrast || slope == 0) return std::nullopt;
  return std::max(1.0, contrast / slope);
}

/// Width of the plain area on both sides of an edge [edge lengths].
double gap_beside_edge(const Board& board) {
  if (board.markers) return (1 - board.markers->side_m / board.square_m) / 2;
  if (!board.tags) return 1;
  constexpr double kCode = 6;  // bits
  const double border = board.tags->border / (kCode + 2 * board.tags->border);
  return board.tags->alone ? border : std::min(border, board.tags->spacing);
}

/// The larger median of rows and columns, as motion blurs one direction; infinite without contrast.
double edge_width(const cv::Mat& gray,
                  const std::vector<Eigen::Vector2d>& corners,
                  const Board& board) {
  const double reach = std::min(0.25, 0.9 * gap_beside_edge(board));
  std::vector<double> widths[2];
  for (int i = 0; i < static_cast<int>(corners.size()); ++i) {
    const auto add = [&](int direction, int next) {
      if (!corners[i].allFinite() || !corners[next].allFinite()) return;
      if (const auto width = edge_width(gray, corners[i], corners[next], reach))
        widths[direction].push_back(*width);
    };
    if (i % board.columns + 1 < board.columns) add(0, i + 1);
    if (i + board.columns < static_cast<int>(corners.size())) add(1, i + board.columns);
  }
  if (widths[0].empty() || widths[1].empty()) return std::numeric_limits<double>::infinity();
  return std::max(median(widths[0]), median(widths[1]));
}

/// Place, size and slant of the board in the image, and time; 0.1 apart are different views.
std::optional<Feature> feature_of(const CalibrationView& view,
                                  const Board& board,
                                  cv::Size size,
                                  int last_frame) {
  const auto points = board_points(board);
  const double diagonal = std::hypot(size.width, size.height);
  const Eigen::Vector3d middle = (points.front() + points.back()) / 2;
  const double board_size = (points.back() - points.front()).norm();
  std::vector<cv::Point2d> from;
  std::vector<cv::Point2d> to;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!view.corners[i].allFinite()) continue;
    const Eigen::Vector3d point = (points[i] - middle) / board_size;
    from.emplace_back(point.x(), point.y());
    to.emplace_back(view.corners[i].x() / diagonal, view.corners[i].y() / diagonal);
  }
  if (from.size() < 4) return std::nullopt;
  const cv::Mat found = cv::findHomography(from, to);
  if (found.empty()) return std::nullopt;
  const cv::Matx33d H = cv::Matx33d(found) * (1 / found.at<double>(2, 2));
  const double area = std::abs((H(0, 0) - H(0, 2) * H(2, 0)) * (H(1, 1) - H(1, 2) * H(2, 1)) -
                               (H(0, 1) - H(0, 2) * H(2, 1)) * (H(1, 0) - H(1, 2) * H(2, 0)));
  Feature feature;
  feature << H(0, 2), H(1, 2), 0.25 * std::log(area), 2 * H(2, 0), 2 * H(2, 1),
      0.3 * view.frame / std::max(1, last_frame);
  return feature;
}

/// Returns at most `most` frames, evenly spread, some of them successive if `with_velocities`.
std::vector<int> frames_to_search(int count, int most, bool with_velocities) {
  const int length = with_velocities && count > most ? std::min(kSuccessive, most) : 1;
  const int places = std::min(count, most) / length;
  std::vector<int> frames;
  for (int place = 0; place < places; ++place)
    for (int k = 0; k < length; ++k)
      frames.push_back(static_cast<int>(std::int64_t{place} * count / places) + k);
  return frames;
}

void add_velocities(std::vector<CalibrationView>& views,
                    std::span<const std::int64_t> frame_times_ns) {
  BoardCorners corners;
  for (const CalibrationView& view : views) corners.emplace(view.frame, view.corners);
  for (CalibrationView& view : views)
    view.velocities_px_s = corner_velocities(corners, view.frame, frame_times_ns);
}

struct Candidate {
  const CalibrationView* view;
  Feature feature;
  double sharpness;  ///< relative to the median, at most 1.5
  double distance = std::numeric_limits<double>::infinity();  ///< to the nearest chosen one
  bool chosen = false;
};

std::vector<Candidate> sharp_candidates(const BoardSearch& search, const Board& board) {
  std::vector<double> widths;
  for (const auto& view : search.views) widths.push_back(view.edge_px);
  const double typical = median(widths);
  const auto moving = std::ranges::count_if(
      search.views, [](const CalibrationView& view) { return !view.velocities_px_s.empty(); });
  const bool only_moving = 2 * moving > std::ssize(search.views);
  std::vector<Candidate> candidates;
  for (const auto& view : search.views) {
    if (view.edge_px > kMostBlurred * typical) continue;
    if (only_moving && view.velocities_px_s.empty()) continue;
    const auto feature = feature_of(view, board, search.size, search.views.back().frame);
    if (!feature) continue;
    candidates.push_back({&view, *feature, std::min(1.5, typical / view.edge_px)});
  }
  return candidates;
}

/// Returns the counts of inner corners that most of a dozen images show; nullopt if they differ.
std::optional<cv::Size> counts_in_images(const FrameCache& images,
                                         std::span<const int> frames,
                                         const Board& board) {
  constexpr std::size_t kMostImages = 12;
  constexpr int kLeastVotes = 3;
  std::map<std::pair<int, int>, int> votes;
  int found = 0;
  const std::size_t taken = std::min(kMostImages, frames.size());
  for (std::size_t i = 0; i < taken; ++i) {
    const auto counts = chessboard_counts(images.gray(frames[i * frames.size() / taken]));
    if (!counts) continue;
    ++found;
    ++votes[{counts->width, counts->height}];
  }
  if (votes.empty()) return std::nullopt;
  const auto& [counts, count] =
      *std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; });
  const auto [columns, rows] = counts;
  const bool same = std::minmax(columns, rows) == std::minmax(board.columns, board.rows);
  if (same || count < kLeastVotes || 2 * count < found) return std::nullopt;
  return cv::Size(columns, rows);
}

}  // namespace

BoardSearch find_calibration_views(const FrameCache& images,
                                   const Board& board,
                                   int most_frames,
                                   const std::function<void(int done, int of)>& progress,
                                   std::span<const std::int64_t> frame_times_ns) {
  const bool timed = std::ssize(frame_times_ns) == images.count();
  const std::vector<int> frames = frames_to_search(images.count(), most_frames, timed);
  BoardSearch search;
  search.size = images.bgr(frames.front()).size();
  std::mutex mutex;
  const auto patch = [&](int frame, const cv::Mat& gray) {
    if (gray.size() != search.size)
      throw InputError(fmt::format("image {}: found {}x{} pixels, expected {}x{} as in the first",
                                   frame,
                                   gray.cols,
                                   gray.rows,
                                   search.size.width,
                                   search.size.height));
    CalibrationView view{frame, find_board(gray, board)};
    const bool single_tag = board.tags && board.tags->alone;
    const auto corners =
        std::ranges::count_if(view.corners, [](const auto& px) { return px.allFinite(); });
    const bool found = corners >= (single_tag ? kCornersOfTag : kLeastCorners);
    if (found) view.edge_px = edge_width(gray, view.corners, board);
    const std::scoped_lock lock(mutex);
    ++search.examined;
    if (found) search.views.push_back(std::move(view));
    if (progress) progress(search.examined, static_cast<int>(frames.size()));
  };
  for_each_image(images, frames, current_stop(), patch);
  check_stop();
  std::ranges::sort(search.views, {}, &CalibrationView::frame);
  if (timed) add_velocities(search.views, frame_times_ns);
  const bool is_chessboard = !board.markers && !board.tags;
  if (is_chessboard && search.views.empty())
    search.other_counts = counts_in_images(images, frames, board);
  return search;
}

std::vector<CalibrationView> choose_views(const BoardSearch& search,
                                          const Board& board,
                                          int count) {
  if (search.views.empty()) return {};
  std::vector<Candidate> candidates = sharp_candidates(search, board);
  const auto worth = [](const Candidate& one) {
    if (one.chosen) return -1.0;
    return std::isinf(one.distance) ? one.sharpness : one.distance * one.sharpness;
  };
  const int taken = std::min(count, static_cast<int>(candidates.size()));
  for (int i = 0; i < taken; ++i) {
    Candidate& next = *std::ranges::max_element(candidates, {}, worth);
    next.chosen = true;
    for (Candidate& other : candidates)
      other.distance = std::min(other.distance, (other.feature - next.feature).norm());
  }
  std::vector<CalibrationView> views;
  for (const Candidate& one : candidates)
    if (one.chosen) views.push_back(*one.view);
  return views;
}

}  // namespace gpo
