// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/normals/normals_view.h"

#include <algorithm>
#include <limits>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

/// Returns the color range, from the lowest RMS to the 90 % quantile.
std::pair<float, float> range_of(const std::vector<float>& rms) {
  constexpr float kLeast_px = 0.05F;
  std::vector<float> known;
  std::ranges::copy_if(rms, std::back_inserter(known), [](float v) { return std::isfinite(v); });
  if (known.empty()) return {0.1F, 1};
  std::ranges::sort(known);
  const float low = std::max(kLeast_px, known.front());
  return {low, std::max(2 * low, known[(known.size() - 1) * 9 / 10])};
}

struct LogField {
  cv::Mat1f value, known;
};

LogField log_field(const std::vector<float>& rms, int side) {
  LogField field{cv::Mat1f(side, side), cv::Mat1f(side, side)};
  for (int k = 0; k < side * side; ++k) {
    const bool finite = std::isfinite(rms[k]);
    field.value(k / side, k % side) = finite ? std::log10(std::max(rms[k], 1e-3F)) : 0;
    field.known(k / side, k % side) = finite ? 1.0F : 0.0F;
  }
  // Unknown cells take the mean of known neighbors, so that interpolation adds no bright border.
  cv::Mat1f sum, count;
  cv::boxFilter(field.value, sum, -1, {3, 3}, {-1, -1}, false, cv::BORDER_CONSTANT);
  cv::boxFilter(field.known, count, -1, {3, 3}, {-1, -1}, false, cv::BORDER_CONSTANT);
  cv::Mat1f(sum / cv::max(count, 1)).copyTo(field.value, field.known == 0);
  return field;
}

/// Appends the level's lines between the centers of four cells (marching squares).
void cross_square(const LogField& field, int row, int column, float level, Contours& contours) {
  constexpr std::array<std::array<int, 2>, 5> kAround = {{{0, 0}, {0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  std::vector<Vector2d> crossings;
  for (int k = 0; k < 4; ++k) {
    const auto [i, j] = kAround[k];
    const auto [m, n] = kAround[k + 1];
    if (field.known(row + i, column + j) == 0) return;
    const float a = field.value(row + i, column + j), b = field.value(row + m, column + n);
    if ((a < level) == (b < level)) continue;
    const double share = (level - a) / (b - a);
    const int side = field.value.rows;
    crossings.emplace_back((1 - share) * disc_of_cell(side, row + i, column + j) +
                           share * disc_of_cell(side, row + m, column + n));
  }
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
    contours.emplace_back(crossings[k], crossings[k + 1]);
}

Contours contours_of(const LogField& field, float low, float high) {
  Contours contours;
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  for (int decade = first; decade <= last; ++decade)
    for (const float step : {1.0F, 2.0F, 5.0F}) {
      const float level = static_cast<float>(decade) + std::log10(step);
      for (int row = 0; row + 1 < field.value.rows; ++row)
        for (int column = 0; column + 1 < field.value.cols; ++column)
          cross_square(field, row, column, level, contours);
    }
  return contours;
}

/// Returns an image of the disc in colors on a logarithmic scale.
cv::Mat image_of(const LogField& field, float low, float high) {
  constexpr int kSide_px = 768;
  constexpr double kDimmed = 0.8;  // to set off the drawings over the map
  const auto color = [](Role role) {
    const std::uint32_t rgb = color_of(role);
    return cv::Vec3b(rgb & 0xFF, rgb >> 8 & 0xFF, rgb >> 16);
  };
  cv::Mat1f value, known;
  cv::resize(field.value, value, {kSide_px, kSide_px}, 0, 0, cv::INTER_LINEAR);
  cv::resize(field.known, known, {kSide_px, kSide_px}, 0, 0, cv::INTER_LINEAR);
  const double from = std::log10(low), per_level = (std::log10(high) - from) / 255;
  cv::Mat levels, image;
  value.convertTo(levels, CV_8U, 1 / per_level, -from / per_level);
  cv::applyColorMap(levels, image, cv::COLORMAP_VIRIDIS);
  image.convertTo(image, -1, kDimmed);
  image.setTo(cv::Scalar(color(Role::raised)), known < 0.5);
  const cv::Vec3b outside = color(Role::scene_bottom);
  for (int y = 0; y < kSide_px; ++y)
    for (int x = 0; x < kSide_px; ++x) {
      const double u = (2.0 * x + 1) / kSide_px - 1, v = (2.0 * y + 1) / kSide_px - 1;
      if (u * u + v * v > 1) image.at<cv::Vec3b>(y, x) = outside;
    }
  return image;
}

}  // namespace

void NormalsMap::update(const std::shared_ptr<const NormalStudy>& study, int frames) {
  if (study == study_ && frames == frames_ && theme_ == current_theme()) return;
  if (study != study_)
    std::tie(low_px_, high_px_) =
        range_of(gpo::rms_px(study->landscape, static_cast<int>(study->landscape.cost_px2.size())));
  study_ = study;
  theme_ = current_theme();
  frames_ = frames;
  rms_px_ = gpo::rms_px(study->landscape, frames);
  const LogField field = log_field(rms_px_, study->landscape.side);
  texture_.upload(image_of(field, low_px_, high_px_));
  contours_ = contours_of(field, low_px_, high_px_);
}

float NormalsMap::rms_at(const Vector2d& disc) const {
  if (!study_ || disc.norm() > 1) return std::numeric_limits<float>::quiet_NaN();
  const int side = study_->landscape.side;
  const Eigen::Vector2i cell =
      ((disc.array() + 1) / 2 * side).floor().cast<int>().cwiseMin(side - 1);
  return rms_px_[cell.y() * side + cell.x()];
}

}  // namespace gpo
