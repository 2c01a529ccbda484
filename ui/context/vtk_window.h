// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkSmartPointer.h>

namespace gpo {

/// VTK in the OpenGL context that is current, drawing into a texture of its own. VTK never opens a
/// window here; Debian's would abort without a display.
class VtkWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static VtkWindow* New();
  VtkWindow(const VtkWindow&) = delete;
  void operator=(const VtkWindow&) = delete;

  /// Loads OpenGL's functions once; VTK 9.1 takes GLEW's "no GLX display" for a failure, and then
  /// prints an error a frame and draws thin lines only.
  void OpenGLInitContext() override;

 protected:
  VtkWindow();
  vtkTypeMacro(VtkWindow, vtkGenericOpenGLRenderWindow)
};

/// Anti-aliased by four samples: llvmpipe's most, and the same bytes every time.
vtkSmartPointer<VtkWindow> make_vtk_window();

/// Renders at this size and returns the texture of the picture, bottom row first; 0 where there
/// is nothing to draw on. Fetch it anew after every call. The bound framebuffer stays bound.
unsigned render_to_texture(VtkWindow& window, int width, int height);

/// The texture of the last picture; 0 before the first.
unsigned texture_of(VtkWindow& window);

/// While it lives, VTK's errors and warnings come here instead of the standard error stream.
class VtkMessages {
 public:
  explicit VtkMessages(std::function<void(const std::string&)> on_message);
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

 private:
  vtkSmartPointer<vtkObject> previous_;
};

}  // namespace gpo
