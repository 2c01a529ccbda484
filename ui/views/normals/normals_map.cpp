// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/theme.h"
#include "ui/views/normals/normals_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr int kImage_px = 768;
/// So that what is drawn over the map stands out.
constexpr double kDimmed = 0.8;
constexpr float kLeastRange_px = 0.05F;

/// From the least to what most of the disc stays below.
std::pair<float, float> range_of(const std::vector<float>& rms) {
  std::vector<float> known;
  std::ranges::copy_if(rms, std::back_inserter(known), [](float v) { return std::isfinite(v); });
  if (known.empty()) return {0.1F, 1};
  std::ranges::sort(known);
  const float low = std::max(kLeastRange_px, known.front());
  return {low, std::max(2 * low, known[(known.size() - 1) * 9 / 10])};
}

cv::Vec3b shaded(const cv::Vec3b& bgr, double share) {
  cv::Vec3b result;
  for (int i = 0; i < 3; ++i) result[i] = cv::saturate_cast<uchar>(share * bgr[i]);
  return result;
}

cv::Vec3b bgr_of(std::uint32_t rgb) {
  return {static_cast<uchar>(rgb), static_cast<uchar>(rgb >> 8), static_cast<uchar>(rgb >> 16)};
}

/// Logarithms of the cells, and which of them are known.
struct LogField {
  cv::Mat1f value, known;
};

/// Beside what is known goes on what is there, so that its border does not shine.
float beside(const cv::Mat1f& value, const cv::Mat1f& known, int row, int column) {
  float sum = 0, count = 0;
  for (int i = std::max(0, row - 1); i <= std::min(row + 1, value.rows - 1); ++i)
    for (int j = std::max(0, column - 1); j <= std::min(column + 1, value.cols - 1); ++j) {
      sum += known(i, j) * value(i, j);
      count += known(i, j);
    }
  return count > 0 ? sum / count : 0;
}

LogField log_field(const std::vector<float>& rms, int side) {
  LogField field{cv::Mat1f(side, side), cv::Mat1f(side, side)};
  for (int k = 0; k < side * side; ++k) {
    const bool finite = std::isfinite(rms[k]);
    field.value(k / side, k % side) = finite ? std::log10(std::max(rms[k], 1e-3F)) : 0;
    field.known(k / side, k % side) = finite ? 1.0F : 0.0F;
  }
  const LogField before{field.value.clone(), field.known};
  for (int k = 0; k < side * side; ++k)
    if (!std::isfinite(rms[k]))
      field.value(k / side, k % side) = beside(before.value, before.known, k / side, k % side);
  return field;
}

/// Where a level crosses the edges between four cells, appended as pieces of lines (marching
/// squares; of the two ways to join four crossings the first).
void cross_square(const LogField& field, int row, int column, float level, Contours& contours) {
  constexpr std::array<std::array<int, 2>, 5> kAround = {{{0, 0}, {0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  std::vector<Eigen::Vector2d> crossings;
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

/// At 1, 2 and 5 times powers of ten within the range.
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

/// Colors on a logarithmic scale.
cv::Mat image_of(const LogField& field, float low, float high) {
  cv::Mat1f value, known;
  const cv::Size size(kImage_px, kImage_px);
  cv::resize(field.value, value, size, 0, 0, cv::INTER_LINEAR);
  cv::resize(field.known, known, size, 0, 0, cv::INTER_LINEAR);
  const float from = std::log10(low), to = std::log10(high);
  cv::Mat1b levels(size);
  for (int i = 0; i < kImage_px * kImage_px; ++i) {
    const float v = (value(i) - from) / (to - from);
    levels(i) = static_cast<uchar>(std::lround(255 * std::clamp(v, 0.0F, 1.0F)));
  }
  cv::Mat3b colors;
  cv::applyColorMap(levels, colors, cv::COLORMAP_VIRIDIS);
  cv::Mat3b image(size, bgr_of(color_of(Role::scene_bottom)));
  for (int y = 0; y < kImage_px; ++y)
    for (int x = 0; x < kImage_px; ++x) {
      const double u = (2.0 * x + 1) / kImage_px - 1, v = (2.0 * y + 1) / kImage_px - 1;
      if (u * u + v * v > 1) continue;
      image(y, x) =
          known(y, x) < 0.5F ? bgr_of(color_of(Role::raised)) : shaded(colors(y, x), kDimmed);
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

float NormalsMap::rms_at(const Eigen::Vector2d& disc) const {
  if (!study_ || disc.norm() > 1) return std::numeric_limits<float>::quiet_NaN();
  const int side = study_->landscape.side;
  const Eigen::Vector2i cell =
      ((disc.array() + 1) / 2 * side).floor().cast<int>().cwiseMin(side - 1);
  return rms_px_[cell.y() * side + cell.x()];
}

}  // namespace gpo
