// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/navigation.h"

#include <string>

#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>

class vtkCamera;

namespace gpo {

/// VTK in the current OpenGL context, drawing into a texture. It opens no window.
class VtkWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static VtkWindow* New();

  /// Loads OpenGL's functions once: VTK 9.1 takes GLEW's "no GLX display" for a failure.
  void OpenGLInitContext() override;

 protected:
  VtkWindow();
  vtkTypeMacro(VtkWindow, vtkGenericOpenGLRenderWindow)
};

/// Anti-aliased by four samples: the maximum of llvmpipe, so that bytes are reproducible.
vtkSmartPointer<VtkWindow> make_vtk_window();

/// Renders; returns the image's texture, bottom row first, valid until the next call; 0: empty.
unsigned render_to_texture(VtkWindow& window, int width, int height);

void set_camera_from_orbit(vtkCamera& vtk, const OrbitCamera& camera);

/// Collects VTK's errors and warnings, which it would print on standard error.
class VtkMessages {
 public:
  VtkMessages();
  ~VtkMessages();

  std::string text() const { return collected_->GetOutput(); }

 private:
  vtkSmartPointer<vtkOutputWindow> previous_;
  vtkNew<vtkStringOutputWindow> collected_;
};

}  // namespace gpo
