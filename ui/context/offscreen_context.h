// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <opencv2/core.hpp>

namespace gpo {

/// OpenGL 3.3 core without a display, by EGL, with a framebuffer of its own. Current in the thread
/// that made it. Throws InputError that says what to install where there is no EGL.
class OffscreenContext {
 public:
  OffscreenContext(int width, int height);
  ~OffscreenContext();

  void make_current();
  /// Makes it current; draws go to its framebuffer from now on.
  void bind();
  int width() const { return width_; }
  int height() const { return height_; }
  /// What was drawn: CV_8UC3, BGR, y down.
  cv::Mat read_bgr();

 private:
  struct Handles;
  int width_, height_;
  std::unique_ptr<Handles> handles_;
};

}  // namespace gpo
