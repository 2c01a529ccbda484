// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/window_image.h"

#include "tests/ui/gl_test.h"
#include "ui/context/gui.h"
#include "ui/views/image/image_texture.h"

#include <GL/glew.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint32_t kGround = 0x102030;

/// Two windows of Dear ImGui side by side on a ground.
class WindowImages : public DrawingTest {
 protected:
  struct Content {
    ImU32 left = IM_COL32(200, 0, 0, 255), right = IM_COL32(0, 200, 0, 128);
    float right_x = 60;
    bool popup = false;
  };

  void begin(const Content& content) {
    context_.bind();
    gui_.begin_frame(100, 80);
    window("left", {10, 10}, content.left);
    window("right", {content.right_x, 10}, content.right);
    if (content.popup) window("popup", {30, 20}, IM_COL32(0, 0, 200, 100));
  }
  void draw(const Content& content) {
    begin(content);
    gui_.end_frame(image_, kGround);
  }
  /// Returns the pixels drawn without a cache.
  cv::Mat drawn_at_once(const Content& content) {
    WindowImage fresh;
    begin(content);
    gui_.end_frame(fresh, kGround);
    return context_.read_bgr();
  }

  static void window(const char* name, ImVec2 at, ImU32 color) {
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize({30, 40});
    ImGui::Begin(name, nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground);
    ImGui::GetWindowDrawList()->AddCircleFilled({at.x + 15, at.y + 20}, 12, color);
    ImGui::End();
  }

  OffscreenContext context_{100, 80};
  Gui gui_;
  WindowImage image_;
};

TEST_F(WindowImages, RedrawsNothingIfNothingChanged) {
  draw({});
  EXPECT_THAT(image_.redrawn(), ElementsAre(cv::Rect(0, 0, 100, 80)));
  const cv::Mat first = context_.read_bgr();
  glClearColor(1, 1, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  draw({});
  EXPECT_THAT(image_.redrawn(), IsEmpty());
  EXPECT_TRUE(same_bytes(context_.read_bgr(), first));
  EXPECT_EQ(first.at<cv::Vec3b>(79, 99), cv::Vec3b(0x30, 0x20, 0x10));
}

TEST_F(WindowImages, RedrawsOnlyTheChangedWindow) {
  draw({});
  const Content other{.left = IM_COL32(9, 9, 9, 99)};
  draw(other);
  ASSERT_EQ(image_.redrawn().size(), 1U);
  EXPECT_LE(image_.redrawn().front().area(), 30 * 40);
  EXPECT_TRUE(image_.redrawn().front().contains({25, 30}));
  EXPECT_TRUE(same_bytes(context_.read_bgr(), drawn_at_once(other)));
}

TEST_F(WindowImages, PartialRedrawGivesTheSameBytesAsAFullOne) {
  const Content contents[] = {{},
                              {.right_x = 47},
                              {.right_x = 47, .popup = true},
                              {.right = IM_COL32(99, 0, 99, 99), .popup = true},
                              {.right_x = 110},
                              {}};
  for (const Content& content : contents) {
    for (int i = 0; i < 2; ++i) draw(content);  // Dear ImGui shows a window in its second frame
    EXPECT_TRUE(same_bytes(context_.read_bgr(), drawn_at_once(content)));
  }
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(WindowImages, RedrawsATextureWithNewContent) {
  ImageTexture texture;
  const auto draw_texture = [&](int gray) {
    texture.upload(cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(gray)));
    context_.bind();
    gui_.begin_frame(100, 80);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    mark_content(list, texture.revision());
    list.AddImage(texture.id(), {0, 0}, {20, 20});
    gui_.end_frame(image_, kGround);
    return context_.read_bgr().at<cv::Vec3b>(10, 10);
  };
  EXPECT_EQ(draw_texture(10), cv::Vec3b::all(10));
  EXPECT_EQ(draw_texture(20), cv::Vec3b::all(20));
}

}  // namespace
}  // namespace gpo
