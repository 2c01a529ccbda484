// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <opencv2/core.hpp>

namespace gpo {

/// Loads OpenGL's functions into the current context. GLEW reports "no GLX display" in an EGL
/// context although all functions are loaded; this is ignored. Throws InputError.
void load_gl_functions();

/// An owned RGBA8 framebuffer without depth. Needs its context to be current.
class Framebuffer {
 public:
  Framebuffer(int width, int height);
  ~Framebuffer();
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;

  /// Makes it the target of all following draw calls, with a viewport of its size.
  void bind() const;
  /// Copies the pixels into another framebuffer (0: the window's) and binds that one.
  void copy_to(unsigned framebuffer) const;

 private:
  int width_, height_;
  unsigned framebuffer_ = 0, color_ = 0;
};

/// Returns the content of the bound framebuffer: CV_8UC3, BGR, y down.
cv::Mat read_bound_framebuffer(int width, int height);

/// OpenGL 3.3 core without a display, through EGL, with its own framebuffer. Current in the thread
/// that creates it. Throws InputError with the packages to install if EGL is missing.
class OffscreenContext {
 public:
  OffscreenContext(int width, int height);
  ~OffscreenContext();

  /// Makes the context current and its framebuffer the target of all following draw calls.
  void bind();
  int width() const { return width_; }
  int height() const { return height_; }
  cv::Mat read_bgr();  ///< Returns the content of its framebuffer: CV_8UC3, BGR, y down.

 private:
  bool make_current() const;  ///< false if it fails

  int width_, height_;
  void* display_;            ///< EGLDisplay
  void* context_ = nullptr;  ///< EGLContext
  std::unique_ptr<Framebuffer> framebuffer_;
};

}  // namespace gpo
