// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/window_context.h"

#include "engine/base/error.h"
#include "ui/context/offscreen_context.h"

#include <algorithm>
#include <utility>

#include <GL/glew.h>
#include <GLFW/glfw3.h>

namespace gpo {
namespace {

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

}  // namespace

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

void WindowContext::make_current() { glfwMakeContextCurrent(window_); }

void WindowContext::bind() {
  make_current();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  const cv::Size pixels = size();
  glViewport(0, 0, pixels.width, pixels.height);
}

void WindowContext::poll() { glfwPollEvents(); }
void WindowContext::wait(double seconds) { glfwWaitEventsTimeout(seconds); }
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

}  // namespace gpo
