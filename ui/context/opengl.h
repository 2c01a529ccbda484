// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include <opencv2/core.hpp>

struct GLFWwindow;

namespace gpo {

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

/// OpenGL 3.3 core through EGL, without a display. Throws InputError with the packages to install.
class OffscreenContext {
 public:
  OffscreenContext(int width, int height);
  ~OffscreenContext();

  /// Makes the context current and its framebuffer the target of all following draw calls.
  void bind();
  cv::Mat read_bgr();  ///< Returns the content of its framebuffer: CV_8UC3, BGR, y down.

 private:
  bool make_current() const;  ///< false if it fails

  int width_, height_;
  void* display_;            ///< EGLDisplay
  void* context_ = nullptr;  ///< EGLContext
  std::unique_ptr<Framebuffer> framebuffer_;
};

/// A desktop window with OpenGL 3.3 core. Only one at a time. Throws InputError without a display.
class WindowContext {
 public:
  WindowContext(const std::string& title, int width, int height, bool visible = true);
  ~WindowContext();
  WindowContext(const WindowContext&) = delete;
  WindowContext& operator=(const WindowContext&) = delete;

  /// Makes the context current and its back buffer the target of all following draw calls.
  void bind();
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
