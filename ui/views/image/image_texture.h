// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace gpo {

void* imgui_texture(unsigned texture);  ///< Converts an OpenGL texture to Dear ImGui's ImTextureID.

/// An owned image in graphics memory. Needs its context to be current.
class ImageTexture {
 public:
  ImageTexture();
  ~ImageTexture();
  ImageTexture(const ImageTexture&) = delete;
  ImageTexture& operator=(const ImageTexture&) = delete;

  void upload(const cv::Mat& bgr);  ///< CV_8UC3, BGR; replaces the content.
  /// Shows pixels as squares from 200 % on, smoothed below.
  void set_screen_scale(double screen_pixels_per_pixel);
  void* id() const;  ///< For Dear ImGui; null before the first upload.
  /// Number of uploads: it changes with the content.
  std::size_t revision() const { return revision_; }

 private:
  unsigned texture_ = 0;
  std::size_t revision_ = 0;
};

}  // namespace gpo
