// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "tests/ui/gl_test.h"
#include "ui/context/gui.h"
#include "ui/context/window_context.h"
#include "ui/views/image/image_texture.h"

#include <cstdlib>
#include <string>

#include <GL/glew.h>
#include <gmock/gmock.h>
#include <imgui.h>
#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>

namespace gpo {
namespace {

class Context : public DrawingTest {};

cv::Mat draw_sphere_in_gui(int width, int height) {
  OffscreenContext context(width, height);
  Gui gui;
  auto window = make_vtk_window();
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(0.1, 0.2, 0.3);
  renderer->SetBackgroundAlpha(1);
  vtkNew<vtkSphereSource> sphere;
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(sphere->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  renderer->AddActor(actor);
  window->AddRenderer(renderer);
  for (int frame = 0; frame < 3; ++frame) {
    context.bind();
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const unsigned texture = render_to_texture(*window, width - 40, height - 20 - frame);
    gui.begin_frame(width, height);
    auto& list = *ImGui::GetBackgroundDrawList();
    list.AddImage(imgui_texture(texture),
                  ImVec2(0, 0),
                  ImVec2(width - 40.F, height - 20.F),
                  ImVec2(0, 1),
                  ImVec2(1, 0));
    list.AddText(ImVec2(8, 8), IM_COL32_WHITE, "0123456789 1.11° ±2 px² 3×4 a→b · x–y …");
    gui.end_frame();
  }
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  return context.read_bgr();
}

TEST_F(Context, ReadsPixelsWithTheFirstRowOnTopWithoutADisplay) {
  OffscreenContext context(5, 4);
  context.bind();
  glClearColor(1, 0.2F, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  Gui gui;
  gui.begin_frame(5, 4);
  ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0, 0), ImVec2(5, 1), IM_COL32_WHITE);
  gui.end_frame();
  const cv::Mat image = context.read_bgr();
  ASSERT_EQ(image.size(), cv::Size(5, 4));
  EXPECT_EQ(image.at<cv::Vec3b>(0, 0), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(image.at<cv::Vec3b>(3, 4), cv::Vec3b(0, 51, 255));
}

TEST_F(Context, VtkAndImGuiShareItAndGiveTheSameBytesAgain) {
  const cv::Mat first = draw_sphere_in_gui(320, 200);
  cv::Scalar mean, deviation;
  cv::meanStdDev(first, mean, deviation);
  EXPECT_GT(deviation[0], 20) << "a bright sphere on a dark ground";
  if (!on_llvmpipe()) GTEST_SKIP() << "bytes are reproducible only with llvmpipe";
  EXPECT_TRUE(same_bytes(first, draw_sphere_in_gui(320, 200)));
}

TEST_F(Context, DrawsWideLinesWithoutGlx) {
  OffscreenContext context(8, 8);
  auto window = make_vtk_window();
  EXPECT_GT(window->GetMaximumHardwareLineWidth(), 1);
}

TEST_F(Context, FontsHaveScientificCharacters) {
  OffscreenContext context(8, 8);
  Gui gui;
  gui.begin_frame(8, 8);
  for (const Font f : {Font::regular, Font::bold, Font::small, Font::heading})
    for (const ImWchar character : std::u16string(u"°²±×→·–…○σ"))
      EXPECT_NE(font(f)->FindGlyphNoFallback(character), nullptr) << std::hex << character;
  EXPECT_FLOAT_EQ(font(Font::regular)->GetCharAdvance('1'),
                  font(Font::regular)->GetCharAdvance('8'));
  gui.end_frame();
}

TEST_F(Context, WindowWithoutADisplayFailsAndNamesTheCause) {
  if (std::getenv("DISPLAY") != nullptr) GTEST_SKIP() << "there is a display";
  EXPECT_THAT([] { WindowContext("test", 10, 10); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("display")));
}

}  // namespace
}  // namespace gpo
