// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace gpo {

/// An OpenGL texture as Dear ImGui names it (ImTextureID).
void* imgui_texture(unsigned texture);

/// A picture in the graphics memory, owned. Needs its context to be current.
class ImageTexture {
 public:
  ImageTexture();
  ~ImageTexture();
  ImageTexture(const ImageTexture&) = delete;
  ImageTexture& operator=(const ImageTexture&) = delete;

  /// CV_8UC3, BGR; replaces what was there.
  void upload(const cv::Mat& bgr);
  /// How it will be drawn: pixels are squares from 200 % on, smooth below.
  void set_screen_scale(double screen_pixels_a_pixel);
  /// For Dear ImGui; null before the first upload.
  void* id() const;
  /// Counts the uploads: another one, another picture.
  std::size_t revision() const { return revision_; }

 private:
  unsigned texture_ = 0;
  std::size_t revision_ = 0;
};

}  // namespace gpo
