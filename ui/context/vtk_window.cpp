// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/vtk_window.h"

#include <vtkCamera.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLState.h>
#include <vtkTextureObject.h>
#include <vtk_glew.h>

namespace gpo {

vtkStandardNewMacro(VtkWindow);

VtkWindow::VtkWindow() {
  SetOwnContext(0);
  SetMapped(true);
  SetIsCurrent(true);
  SetSupportsOpenGL(1);
  SetReadyForRendering(true);
  SetFrameBlitModeToNoBlit();
  SetMultiSamples(4);
}

void VtkWindow::OpenGLInitContext() {
  if (Initialized) return;
  const GLenum status = glewInit();
  GlewInitValid = status == GLEW_OK || status == GLEW_ERROR_NO_GLX_DISPLAY;
  if (!GlewInitValid) {
    vtkErrorMacro("cannot load OpenGL's functions");
    return;
  }
  Initialized = true;
  GLfloat range[2] = {1, 1};
  glGetFloatv(GL_LINE_WIDTH_RANGE, range);
  if (glGetError() == GL_NO_ERROR) MaximumHardwareLineWidth = range[1];
}

vtkSmartPointer<VtkWindow> make_vtk_window() {
  auto window = vtkSmartPointer<VtkWindow>::New();
  window->InitializeFromCurrentContext();
  return window;
}

unsigned render_to_texture(VtkWindow& window, int width, int height) {
  if (width < 1 || height < 1) return 0;
  GLint bound = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &bound);
  window.SetSize(width, height);
  // VTK caches OpenGL's state, which Dear ImGui has changed.
  window.GetState()->Reset();
  window.Render();
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
  glUseProgram(0);
  glBindVertexArray(0);
  auto* texture = window.GetDisplayFramebuffer()->GetColorAttachmentAsTextureObject(0);
  return texture != nullptr ? texture->GetHandle() : 0;
}

void set_camera_from_orbit(vtkCamera& vtk, const OrbitCamera& camera) {
  vtk.SetPosition(eye(camera).eval().data());
  vtk.SetFocalPoint(camera.target.data());
  vtk.SetViewUp((-view_axes(camera).col(1)).eval().data());
  vtk.SetViewAngle(camera.view_angle_deg);
}

VtkMessages::VtkMessages() : previous_(vtkOutputWindow::GetInstance()) {
  vtkOutputWindow::SetInstance(collected_);
}

VtkMessages::~VtkMessages() { vtkOutputWindow::SetInstance(previous_); }

}  // namespace gpo
