// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/snapshot.h"

#include "ui/context/vtk_window.h"
#include "ui/views/compare/compare_view.h"
#include "ui/views/normals/normals_view.h"
#include "ui/views/scene/scene_view.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

float text_scale(cv::Size size) {
  return std::clamp(static_cast<float>(size.height) / 720.0F, 0.85F, 3.0F);
}

/// Creates a `Resource` in graphics memory and calls `draw(resource, area)`.
template <class Resource, class Draw>
cv::Mat snapshot(cv::Size size, float scale, const Draw& draw, Theme theme = Theme::dark) {
  const VtkMessages vtk;
  OffscreenContext context(size.width, size.height);
  Gui gui(scale);
  gui.set_theme(theme);
  Resource resource;
  context.bind();
  gui.begin_frame(size.width, size.height);
  draw(resource, Area{*ImGui::GetBackgroundDrawList(), {{0, 0}, {size.width, size.height}}});
  gui.end_frame();
  if (!vtk.text().empty()) throw std::runtime_error("VTK: " + vtk.text());
  return context.read_bgr();
}

constexpr int kBlock_px = 16;
constexpr double kMostUnequal = 0.0005;
constexpr double kMostUnequalInBlock = 0.25;

cv::Mat largest_difference(const cv::Mat& actual, const cv::Mat& expected) {
  cv::Mat difference, largest;
  cv::absdiff(actual, expected, difference);
  cv::reduce(
      difference.reshape(1, static_cast<int>(difference.total())), largest, 1, cv::REDUCE_MAX);
  return largest.reshape(1, actual.rows);
}

double worst_block(const cv::Mat& unequal) {
  double worst = 0;
  for (int y = 0; y < unequal.rows; y += kBlock_px)
    for (int x = 0; x < unequal.cols; x += kBlock_px) {
      const cv::Rect block =
          cv::Rect(x, y, kBlock_px, kBlock_px) & cv::Rect(0, 0, unequal.cols, unequal.rows);
      worst = std::max(worst, cv::countNonZero(unequal(block)) / static_cast<double>(block.area()));
    }
  return worst;
}

/// Returns the expected image, pale, with small differences in blue and unequal pixels in red.
cv::Mat drawn_difference(const cv::Mat& expected,
                         const cv::Mat& difference,
                         const cv::Mat& unequal) {
  cv::Mat image;
  cv::cvtColor(expected, image, cv::COLOR_BGR2GRAY);
  image = image / 3 + 160;
  cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  image.setTo(cv::Scalar(230, 190, 120), difference > 0);
  const cv::Mat zero = cv::Mat::zeros(difference.size(), CV_8U);
  cv::Mat red;
  cv::merge(std::vector<cv::Mat>{zero, zero, difference + 150}, red);
  red.copyTo(image, unequal);
  return image;
}

}  // namespace

cv::Mat snapshot_image(const Inspection& inspection,
                       int frame,
                       std::optional<cv::Size> size,
                       const ViewOptions& options) {
  const Recording& recording = *inspection.recording;
  const cv::Size pixels = size.value_or(shown_size(recording));
  const auto draw = [&](ImageTexture& texture, const Area& area) {
    if (recording.images) texture.upload(recording.images->bgr(frame));
    draw_image_view(area, {inspection, frame, options}, &texture);
  };
  return snapshot<ImageTexture>(pixels, text_scale(pixels), draw);
}

cv::Mat snapshot_scene(const Inspection& inspection,
                       int frame,
                       std::optional<cv::Size> size,
                       const ViewOptions& options,
                       Theme theme) {
  const cv::Size pixels = size.value_or(cv::Size(960, 720));
  const double side = cube_side(inspection, options.cube_side);
  const auto camera = default_scene_camera(inspection, side, 1.0 * pixels.width / pixels.height);
  const auto draw = [&](SceneView& scene, const Area& area) {
    draw_scene_view(area, {inspection, frame, options}, scene, camera);
  };
  return snapshot<SceneView>(pixels, text_scale(pixels), draw, theme);
}

cv::Mat snapshot_normals(const std::shared_ptr<const Inspection>& inspection,
                         int frame,
                         std::optional<cv::Size> size,
                         Theme theme) {
  const cv::Size pixels = size.value_or(cv::Size(720, 760));
  NormalsContent content{*inspection, study_normals(*inspection), {}, frame};
  const Method& method = inspection->settings.options.method.row();
  if (inspection->initialization->ok)
    content.answers.push_back(
        {.name = method.title, .rgb = method.rgb, .inspection = inspection, .current = true});
  const auto draw = [&](NormalsMap& map, const Area& area) {
    draw_normals_view(area, map, content, {});
  };
  return snapshot<NormalsMap>(pixels, text_scale(pixels), draw, theme);
}

cv::Mat snapshot_compare(Comparison inspections, int frame, std::optional<cv::Size> size) {
  const Recording unknown;
  const Recording& recording = inspections.empty() ? unknown : *inspections.front()->recording;
  std::vector<Compared> columns;
  for (const auto& one : inspections)
    columns.push_back({configuration_of(one->settings), one->settings, one});
  const cv::Size usual = default_compare_size(static_cast<int>(columns.size()), recording);
  const cv::Size pixels = size.value_or(usual);
  const auto draw = [&](ImageTexture& texture, const Area& area) {
    if (recording.images) texture.upload(recording.images->bgr(frame));
    const ViewOptions options{};
    draw_compare_view(area, columns, {recording, frame, &texture, options});
  };
  const double scale = std::clamp(1.0 * pixels.width / usual.width, 0.75, 3.0);
  return snapshot<ImageTexture>(pixels, static_cast<float>(scale), draw);
}

ImageComparison compare_images(const cv::Mat& actual, const cv::Mat& expected, int tolerance) {
  ImageComparison result;
  if (actual.size() != expected.size() || actual.empty()) {
    result.reason = fmt::format(
        "size {}x{}, expected {}x{}", actual.cols, actual.rows, expected.cols, expected.rows);
    return result;
  }
  const cv::Mat difference = largest_difference(actual, expected);
  for (std::size_t i = 0; i < result.beyond.size(); ++i)
    result.beyond[i] = cv::countNonZero(difference > ImageComparison::kSweep[i]);
  const cv::Mat unequal = difference > tolerance;
  result.unequal = cv::countNonZero(unequal);
  result.worst_block = worst_block(unequal);
  result.difference = drawn_difference(expected, difference, unequal);
  const double share = result.unequal / static_cast<double>(unequal.total());
  result.equal = share <= kMostUnequal && result.worst_block <= kMostUnequalInBlock;
  if (!result.equal)
    result.reason = fmt::format(
        "{} pixels ({:.3f} %) differ by more than {} levels, {:.0f} % of the worst 16x16 block; "
        "allowed: {} % and {} %",
        result.unequal,
        100 * share,
        tolerance,
        100 * result.worst_block,
        100 * kMostUnequal,
        100 * kMostUnequalInBlock);
  return result;
}

}  // namespace gpo
