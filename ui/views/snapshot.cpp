// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/snapshot.h"

#include "ui/context/gui.h"
#include "ui/context/offscreen_context.h"
#include "ui/context/vtk_window.h"
#include "ui/views/normals/normals_view.h"
#include "ui/views/image/image_texture.h"
#include "ui/views/scene/scene_geometry.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <imgui.h>

namespace gpo {
namespace {

/// Returns a scale of text in proportion to the image.
float text_scale(cv::Size size) {
  return std::clamp(static_cast<float>(size.height) / 720.0F, 0.85F, 3.0F);
}

/// Creates a `Resource` in graphics memory and calls `draw(resource, list, rect)`.
template <class Resource, class Draw>
cv::Mat snapshot(cv::Size size, float scale, const Draw& draw) {
  std::string complaint;
  const VtkMessages vtk([&complaint](const std::string& message) { complaint += message; });
  OffscreenContext context(size.width, size.height);
  Gui gui(scale);
  Resource resource;
  context.bind();
  gui.begin_frame(size.width, size.height);
  draw(resource, *ImGui::GetBackgroundDrawList(), ScreenRect{{0, 0}, {size.width, size.height}});
  gui.end_frame();
  if (!complaint.empty()) throw std::runtime_error("VTK: " + complaint);
  return context.read_bgr();
}

}  // namespace

cv::Mat snapshot_image(const Inspection& inspection,
                       int frame,
                       std::optional<cv::Size> size,
                       const ViewOptions& options) {
  const Recording& recording = *inspection.recording;
  const cv::Size pixels = size.value_or(cv::Size(recording.camera.width, recording.camera.height));
  const auto draw = [&](ImageTexture& texture, ImDrawList& list, const ScreenRect& rect) {
    if (recording.images) texture.upload(recording.images->bgr(frame));
    draw_image_view(list, rect, {inspection, frame, options}, &texture, {});
  };
  return snapshot<ImageTexture>(pixels, text_scale(pixels), draw);
}

cv::Mat snapshot_scene(const Inspection& inspection,
                       int frame,
                       cv::Size size,
                       const ViewOptions& options) {
  const double side = cube_side(inspection, options.cube_side);
  const OrbitCamera camera =
      default_scene_camera(inspection, side, static_cast<double>(size.width) / size.height);
  const auto draw = [&](SceneView& scene, ImDrawList& list, const ScreenRect& rect) {
    draw_scene_view(list, rect, {inspection, frame, options}, scene, camera);
  };
  return snapshot<SceneView>(size, text_scale(size), draw);
}

cv::Mat snapshot_normals(const std::shared_ptr<const Inspection>& inspection,
                         int frame,
                         cv::Size size) {
  NormalsContent content{.inspection = *inspection,
                         .study = study_normals(*inspection),
                         .answers = {},
                         .frame = frame};
  const Method& method = inspection->settings.options.method.row();
  if (inspection->initialization->ok)
    content.answers.push_back(
        {.name = method.title, .rgb = method.rgb, .inspection = inspection, .current = true});
  const auto draw = [&](NormalsMap& map, ImDrawList& list, const ScreenRect& rect) {
    draw_normals_view(list, rect, map, content, {});
  };
  return snapshot<NormalsMap>(size, text_scale(size), draw);
}

cv::Mat snapshot_compare(Comparison inspections, int frame, std::optional<cv::Size> size) {
  const cv::Size pixels = size.value_or(default_compare_size(inspections));
  const auto draw = [&](ImageTexture& texture, ImDrawList& list, const ScreenRect& rect) {
    if (!inspections.empty() && inspections.front()->recording->images)
      texture.upload(inspections.front()->recording->images->bgr(frame));
    draw_compare_view(list, rect, inspections, frame, &texture);
  };
  const auto scale = static_cast<float>(compare_text_scale(inspections, pixels));
  return snapshot<ImageTexture>(pixels, scale, draw);
}

}  // namespace gpo
