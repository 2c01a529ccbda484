// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace gpo {

/// Loads OpenGL's functions into the current context. GLEW answers "no GLX display" in an EGL
/// context although everything is loaded; that is not an error here. Throws InputError.
void load_gl_functions();

/// A color-only RGBA8 framebuffer of its own, owned. Needs its context to be current.
class Framebuffer {
 public:
  Framebuffer(int width, int height);
  ~Framebuffer();
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;

  /// Draws go here from now on, to all of it.
  void bind() const;
  /// Copies what was drawn into another framebuffer (0: the window's), pixel by pixel, and binds
  /// that one.
  void copy_to(unsigned framebuffer) const;

 private:
  int width_, height_;
  unsigned framebuffer_ = 0, color_ = 0;
};

/// What was drawn into the bound framebuffer: CV_8UC3, BGR, y down.
cv::Mat read_bound_framebuffer(int width, int height);

/// What is in a texture, bottom row first there: CV_8UC3, BGR, y down.
cv::Mat read_texture(unsigned texture, int width, int height);

}  // namespace gpo
