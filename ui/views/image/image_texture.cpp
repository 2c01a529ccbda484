// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/image_texture.h"

#include <cstdint>

#include <GL/glew.h>

namespace gpo {

void* imgui_texture(unsigned texture) {
  // Dear ImGui identifies textures by pointers. NOLINTNEXTLINE(performance-no-int-to-ptr)
  return reinterpret_cast<void*>(static_cast<std::intptr_t>(texture));
}

ImageTexture::ImageTexture() { glGenTextures(1, &texture_); }
ImageTexture::~ImageTexture() { glDeleteTextures(1, &texture_); }

void ImageTexture::upload(const cv::Mat& bgr) {
  const cv::Mat rows = bgr.isContinuous() ? bgr : bgr.clone();
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(
      GL_TEXTURE_2D, 0, GL_RGBA8, rows.cols, rows.rows, 0, GL_BGR, GL_UNSIGNED_BYTE, rows.data);
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glBindTexture(GL_TEXTURE_2D, 0);
  ++revision_;
}

void ImageTexture::set_screen_scale(double screen_pixels_per_pixel) {
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexParameteri(
      GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, screen_pixels_per_pixel >= 2 ? GL_NEAREST : GL_LINEAR);
  glBindTexture(GL_TEXTURE_2D, 0);
}

void* ImageTexture::id() const { return revision_ > 0 ? imgui_texture(texture_) : nullptr; }

}  // namespace gpo
