// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

struct GLFWwindow;

namespace gpo {

/// A window of the desktop with OpenGL 3.3 core, current in the thread that made it. One at a time.
/// Throws InputError where there is no display.
class WindowContext {
 public:
  WindowContext(const std::string& title, int width, int height, bool visible = true);
  ~WindowContext();
  WindowContext(const WindowContext&) = delete;
  WindowContext& operator=(const WindowContext&) = delete;

  void make_current();
  /// Makes it current; draws go to the back buffer from now on, to all of it.
  void bind();
  /// Takes what happened since the last call from the desktop.
  void poll();
  /// As `poll`, but sleeps until something happens, at most so long.
  void wait(double seconds);
  void swap();
  bool should_close() const;
  /// Of the framebuffer [px].
  cv::Size size() const;
  /// The monitor's: 1 at 96 dpi, 2 on a HiDPI screen.
  float content_scale() const;
  /// The whole monitor, or as it was before.
  void set_fullscreen(bool fullscreen);
  /// As large as that [screen units], but no larger than the monitor's free area.
  void resize(cv::Size wanted);
  /// [screen units], and of a window in full screen what it was before.
  cv::Rect place() const;
  /// What was drawn into the back buffer: CV_8UC3, BGR, y down. Before `swap`.
  cv::Mat read_bgr();
  GLFWwindow* glfw() { return window_; }

 private:
  GLFWwindow* window_ = nullptr;
  cv::Rect before_;  ///< full screen; empty: it is not
};

}  // namespace gpo
