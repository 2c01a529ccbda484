// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

struct GLFWwindow;

namespace gpo {

/// A desktop window with OpenGL 3.3 core, current in the thread that creates it. Only one at a
/// time. Throws InputError without a display.
class WindowContext {
 public:
  WindowContext(const std::string& title, int width, int height, bool visible = true);
  ~WindowContext();
  WindowContext(const WindowContext&) = delete;
  WindowContext& operator=(const WindowContext&) = delete;

  void make_current();
  /// Makes the context current and its back buffer the target of all following draw calls.
  void bind();
  void poll();                ///< Handles the events since the last call.
  void wait(double seconds);  ///< The same, but first sleeps until an event, at most `seconds`.
  void swap();
  bool should_close() const;
  cv::Size size() const;        ///< Returns the size of the framebuffer [px].
  float content_scale() const;  ///< Returns the monitor's scale: 1 at 96 dpi, 2 on a HiDPI screen.
  /// Covers the whole monitor, or restores the place before that.
  void set_fullscreen(bool fullscreen);
  void resize(cv::Size wanted);  ///< Resizes [screen units], at most to the monitor's free area.
  /// Returns the window's place [screen units]; in full screen the place before that.
  cv::Rect place() const;
  /// Returns the content of the back buffer before `swap`: CV_8UC3, BGR, y down.
  cv::Mat read_bgr();
  GLFWwindow* glfw() { return window_; }

 private:
  GLFWwindow* window_ = nullptr;
  cv::Rect before_;  ///< place before full screen; empty if not in full screen
};

}  // namespace gpo
