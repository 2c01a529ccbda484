// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/opengl.h"

#include "engine/base/error.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glew.h>
#include <GLFW/glfw3.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

bool initialized(EGLDisplay display) {
  return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE;
}

/// Tries a surfaceless display first: it needs neither a display nor a GPU.
EGLDisplay open_display() {
  EGLDisplay display =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (initialized(display)) return display;
  const auto query_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  std::array<EGLDeviceEXT, 8> devices{};
  EGLint count = 0;
  if (query_devices != nullptr) query_devices(devices.size(), devices.data(), &count);
  for (int i = 0; i < count; ++i) {
    display = eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
    if (initialized(display)) return display;
  }
  display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  return initialized(display) ? display : EGL_NO_DISPLAY;
}

EGLContext create_context(EGLDisplay display) {
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) return EGL_NO_CONTEXT;
  const std::array<EGLint, 5> config_attributes = {
      EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  eglChooseConfig(display, config_attributes.data(), &config, 1, &count);
  if (count < 1) return EGL_NO_CONTEXT;
  const std::array<EGLint, 7> context_attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                                    3,
                                                    EGL_CONTEXT_MINOR_VERSION,
                                                    3,  //
                                                    EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                    EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                    EGL_NONE};
  return eglCreateContext(display, config, EGL_NO_CONTEXT, context_attributes.data());
}

std::string last_glfw_error() {
  const char* description = nullptr;
  glfwGetError(&description);
  return description != nullptr ? description : "unknown reason";
}

/// Returns the monitor that shows most of a window; the primary one if none does.
GLFWmonitor* monitor_below(const cv::Rect& window) {
  int count = 0;
  GLFWmonitor** const all = glfwGetMonitors(&count);
  GLFWmonitor* best = glfwGetPrimaryMonitor();
  int most = 0;
  for (int k = 0; k < count; ++k) {
    const GLFWvidmode* mode = glfwGetVideoMode(all[k]);
    if (mode == nullptr) continue;
    cv::Rect place(0, 0, mode->width, mode->height);
    glfwGetMonitorPos(all[k], &place.x, &place.y);
    const int shared = (place & window).area();
    if (shared <= most) continue;
    most = shared;
    best = all[k];
  }
  return best;
}

/// Ignores GLEW's "no GLX display" in EGL contexts.
void load_gl_functions() {
  glewExperimental = GL_TRUE;
  const GLenum status = glewInit();
  if (status != GLEW_OK && status != GLEW_ERROR_NO_GLX_DISPLAY)
    throw InputError("cannot load OpenGL 3.3: install libgl1-mesa-dri or a driver");
  while (glGetError() != GL_NO_ERROR) {
  }
}

}  // namespace

Framebuffer::Framebuffer(int width, int height) : width_(width), height_(height) {
  glGenRenderbuffers(1, &color_);
  glBindRenderbuffer(GL_RENDERBUFFER, color_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glGenFramebuffers(1, &framebuffer_);
  bind();
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_);
}

Framebuffer::~Framebuffer() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteRenderbuffers(1, &color_);
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_, height_);
}

void Framebuffer::copy_to(unsigned framebuffer) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

cv::Mat read_bound_framebuffer(int width, int height) {
  cv::Mat rgba(height, width, CV_8UC4), bgr;
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data);
  cv::cvtColor(rgba, bgr, cv::COLOR_RGBA2BGR);
  cv::flip(bgr, bgr, 0);  // OpenGL's rows begin at the bottom
  return bgr;
}

OffscreenContext::OffscreenContext(int width, int height)
    : width_(width), height_(height), display_(open_display()) {
  if (display_ != EGL_NO_DISPLAY) context_ = create_context(display_);
  if (context_ == EGL_NO_CONTEXT || !make_current())
    throw InputError(
        "cannot draw without a display: EGL with OpenGL 3.3 is missing. Install Mesa's (on Debian: "
        "apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri)");
  load_gl_functions();
  framebuffer_ = std::make_unique<Framebuffer>(width, height);
}

OffscreenContext::~OffscreenContext() {
  if (make_current()) framebuffer_.reset();
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  // The display stays open: EGL gives the same one to every context of the process.
}

bool OffscreenContext::make_current() const {
  return eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
}

void OffscreenContext::bind() {
  make_current();
  framebuffer_->bind();
}

cv::Mat OffscreenContext::read_bgr() {
  bind();
  return read_bound_framebuffer(width_, height_);
}

WindowContext::WindowContext(const std::string& title, int width, int height, bool visible) {
  if (glfwInit() != GLFW_TRUE)
    throw InputError("cannot open a window: " + last_glfw_error() +
                     ". A display is required; `run` and `snapshot` work without one");
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_VISIBLE, visible ? GLFW_TRUE : GLFW_FALSE);
  // The views have depth and samples of their own.
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string reason = last_glfw_error();
    glfwTerminate();
    throw InputError("cannot open a window: " + reason + ". OpenGL 3.3 is required");
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  try {
    load_gl_functions();
  } catch (...) {
    glfwTerminate();
    throw;
  }
}

WindowContext::~WindowContext() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void WindowContext::bind() {
  glfwMakeContextCurrent(window_);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  const cv::Size pixels = size();
  glViewport(0, 0, pixels.width, pixels.height);
}

void WindowContext::swap() { glfwSwapBuffers(window_); }
bool WindowContext::should_close() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

cv::Size WindowContext::size() const {
  cv::Size pixels;
  glfwGetFramebufferSize(window_, &pixels.width, &pixels.height);
  return pixels;
}

float WindowContext::content_scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  return std::max({x, y, 1.0F});
}

void WindowContext::set_fullscreen(bool fullscreen) {
  if (fullscreen == !before_.empty()) return;
  if (fullscreen) {
    const cv::Rect now = place();
    GLFWmonitor* monitor = monitor_below(now);
    const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
    if (mode == nullptr) return;
    before_ = now;
    glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, GLFW_DONT_CARE);
  } else {
    const cv::Rect back = std::exchange(before_, {});
    glfwSetWindowMonitor(window_, nullptr, back.x, back.y, back.width, back.height, GLFW_DONT_CARE);
  }
}

void WindowContext::resize(cv::Size wanted) {
  int x = 0, y = 0, width = 0, height = 0;
  if (GLFWmonitor* monitor = monitor_below(place()))
    glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
  if (width > 0 && height > 0) {
    wanted.width = std::min(wanted.width, width);
    wanted.height = std::min(wanted.height, height);
  }
  glfwSetWindowSize(window_, wanted.width, wanted.height);
}

cv::Rect WindowContext::place() const {
  if (!before_.empty()) return before_;
  cv::Rect now;
  glfwGetWindowPos(window_, &now.x, &now.y);
  glfwGetWindowSize(window_, &now.width, &now.height);
  return now;
}

cv::Mat WindowContext::read_bgr() {
  bind();
  glReadBuffer(GL_BACK);
  const cv::Size pixels = size();
  return read_bound_framebuffer(pixels.width, pixels.height);
}

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
