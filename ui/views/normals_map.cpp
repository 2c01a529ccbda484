// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/normals_view.h"
#include "ui/views/palette.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr int kPicture_px = 768;
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

/// Index of the contour below a value: ..., 0.5, 1, 2, 5, 10, ...
int band_of(float log_value) {
  const float decade = std::floor(log_value), rest = log_value - decade;
  return 3 * static_cast<int>(decade) + (rest >= 0.69897F ? 2 : rest >= 0.30103F ? 1 : 0);
}

cv::Vec3b shaded(const cv::Vec3b& bgr, double share) {
  cv::Vec3b result;
  for (int i = 0; i < 3; ++i) result[i] = cv::saturate_cast<uchar>(share * bgr[i]);
  return result;
}

cv::Vec3b bgr_of(std::uint32_t rgb) {
  return {static_cast<uchar>(rgb), static_cast<uchar>(rgb >> 8), static_cast<uchar>(rgb >> 16)};
}

/// Logarithms of the cells, as large as the picture; `known`: how much of a pixel's cells are.
struct LogField {
  cv::Mat1f value, known;
};

LogField log_field(const std::vector<float>& rms, int side, float high) {
  cv::Mat1f value(side, side), known(side, side);
  for (int k = 0; k < side * side; ++k) {
    const bool finite = std::isfinite(rms[k]);
    value(k / side, k % side) = std::log10(finite ? std::max(rms[k], 1e-3F) : high);
    known(k / side, k % side) = finite ? 1.0F : 0.0F;
  }
  LogField field;
  const cv::Size size(kPicture_px, kPicture_px);
  cv::resize(value, field.value, size, 0, 0, cv::INTER_LINEAR);
  cv::resize(known, field.known, size, 0, 0, cv::INTER_LINEAR);
  return field;
}

/// Colors on a logarithmic scale, contours at 1, 2 and 5 times powers of ten.
cv::Mat picture_of(const std::vector<float>& rms, int side, float low, float high) {
  const LogField field = log_field(rms, side, high);
  const float from = std::log10(low), to = std::log10(high);
  cv::Mat1b levels(field.value.size());
  for (int i = 0; i < kPicture_px * kPicture_px; ++i) {
    const float v = (field.value(i) - from) / (to - from);
    levels(i) = static_cast<uchar>(std::lround(255 * std::clamp(v, 0.0F, 1.0F)));
  }
  cv::Mat3b colors;
  cv::applyColorMap(levels, colors, cv::COLORMAP_VIRIDIS);
  cv::Mat3b picture(colors.size(), bgr_of(palette::kSceneBottom));
  for (int y = 0; y + 1 < kPicture_px; ++y)
    for (int x = 0; x + 1 < kPicture_px; ++x) {
      const double u = (2.0 * x + 1) / kPicture_px - 1, v = (2.0 * y + 1) / kPicture_px - 1;
      if (u * u + v * v > 1) continue;
      if (field.known(y, x) < 0.5F) {
        picture(y, x) = bgr_of(palette::kRaised);
        continue;
      }
      const int band = band_of(field.value(y, x));
      const bool contour =
          band != band_of(field.value(y, x + 1)) || band != band_of(field.value(y + 1, x));
      picture(y, x) = shaded(colors(y, x), contour ? 0.5 : 0.8);
    }
  return picture;
}

}  // namespace

void NormalsMap::update(const std::shared_ptr<const NormalStudy>& study, int frames) {
  if (study == study_ && frames == frames_) return;
  if (study != study_)
    std::tie(low_px_, high_px_) =
        range_of(gpo::rms_px(study->landscape, static_cast<int>(study->landscape.cost_px2.size())));
  study_ = study;
  frames_ = frames;
  rms_px_ = gpo::rms_px(study->landscape, frames);
  texture_.upload(picture_of(rms_px_, study->landscape.side, low_px_, high_px_));
}

float NormalsMap::rms_at(const Eigen::Vector2d& disc) const {
  if (!study_ || disc.norm() > 1) return std::numeric_limits<float>::quiet_NaN();
  const int side = study_->landscape.side;
  const Eigen::Vector2i cell =
      ((disc.array() + 1) / 2 * side).floor().cast<int>().cwiseMin(side - 1);
  return rms_px_[cell.y() * side + cell.x()];
}

}  // namespace gpo
