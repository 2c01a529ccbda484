// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/offscreen_context.h"

#include "engine/base/error.h"

#include <array>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glew.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

bool initialized(EGLDisplay display) {
  return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE;
}

/// Tries a surfaceless display first: it needs neither a display nor a GPU.
EGLDisplay open_display() {
  const auto platform_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (platform_display != nullptr) {
    EGLDisplay display =
        platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (initialized(display)) return display;
    const auto query_devices =
        reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    std::array<EGLDeviceEXT, 8> devices{};
    EGLint count = 0;
    if (query_devices != nullptr) query_devices(devices.size(), devices.data(), &count);
    for (int i = 0; i < count; ++i) {
      display = platform_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
      if (initialized(display)) return display;
    }
  }
  EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
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

}  // namespace

void load_gl_functions() {
  glewExperimental = GL_TRUE;
  const GLenum status = glewInit();
  if (status != GLEW_OK && status != GLEW_ERROR_NO_GLX_DISPLAY)
    throw InputError("cannot load OpenGL 3.3: install libgl1-mesa-dri or a driver");
  while (glGetError() != GL_NO_ERROR) {
  }
}

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

}  // namespace gpo
