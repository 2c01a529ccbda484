// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "tests/ui/gl_test.h"
#include "ui/context/gui.h"
#include "ui/window_input.h"

#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>

namespace gpo {
namespace {

using testing::ElementsAre, testing::IsEmpty;
using Kind = InputEvent::Kind;

class Context : public DrawingTest {};

TEST_F(Context, FontsCoverLatinGreekAndCyrillic) {
  const OffscreenContext context(64, 64);
  Gui gui;
  gui.begin_frame(64, 64);
  gui.end_frame();
  for (const Font which : {Font::regular, Font::bold, Font::small, Font::heading})
    for (const ImWchar letter : {0x00E9, 0x03A9, 0x0416, 0x044F, 0x0457})
      EXPECT_NE(font(which)->FindGlyphNoFallback(letter), nullptr) << letter;
}

/// Returns the code points of a text in UTF-16.
std::vector<ImWchar> code_points(const std::u16string& text) { return {text.begin(), text.end()}; }

TEST_F(Context, ProvidesGlyphsForNamesInAnyScript) {
  const OffscreenContext context(240, 32);
  Gui gui;
  const std::vector<std::string_view> names = {"desk", "\u4F60\u3042", "\uD55C \uF8FE.mp4"};
  EXPECT_TRUE(gui.provide_glyphs(names));
  EXPECT_FALSE(gui.provide_glyphs(names)) << "all glyphs are there now";
  for (const Font which : {Font::regular, Font::bold, Font::small, Font::heading})
    for (const ImWchar letter : code_points(u"\u4F60\u3042\uD55C\uF8FE"))
      EXPECT_NE(font(which)->FindGlyphNoFallback(letter), nullptr) << std::hex << letter;
  gui.set_zoom(2);
  EXPECT_NE(font(Font::regular)->FindGlyphNoFallback(0x4F60), nullptr) << "at another size";
}

TEST_F(Context, SpellsCharactersThatNoFontHas) {
  constexpr ImWchar kPrivate = 0xF8FE;
  if (!fonts_with({kPrivate}).empty()) GTEST_SKIP() << "a font has a private character";
  OffscreenContext context(240, 32);
  Gui gui;
  const std::vector<std::string_view> names = {"\uF8FE"};
  gui.provide_glyphs(names);
  EXPECT_GT(font(Font::regular)->GetCharAdvance(kPrivate), 3 * font(Font::regular)->FontSize);
  const auto ink = [&](const char* text) {
    context.bind();
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    gui.begin_frame(240, 32);
    ImGui::GetBackgroundDrawList()->AddText({4, 4}, IM_COL32_WHITE, text);
    gui.end_frame();
    return cv::mean(context.read_bgr())[0];
  };
  const double spelled = ink("\uF8FE");
  EXPECT_NEAR(spelled / ink("\\uF8FE"), 1, 0.15);
}

TEST_F(Context, ShowsABoxInsteadOfAQuestionMark) {
  const OffscreenContext context(8, 8);
  const Gui gui;
  EXPECT_EQ(font(Font::regular)->FindGlyph(0x4F61)->Codepoint, 0x25A1U);
}

TEST(InstalledFonts, AreFoundByTheirCharacters) {
  const auto fonts = fonts_with({0x10D0, 0xF8FE});  // Georgian an, a private one
  if (fonts.empty()) GTEST_SKIP() << "no font with Georgian letters is installed";
  EXPECT_THAT(fonts[0].covered, testing::Contains(0x10D0));
  EXPECT_GT(fonts[0].bytes.size(), 1000U);
}

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
    list.AddImage(imgui_texture(texture), {0, 0}, {width - 40.F, height - 20.F}, {0, 1}, {1, 0});
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

constexpr std::uint32_t kGround = 0x102030;

class WindowImages : public DrawingTest {
 protected:
  struct Content {
    ImU32 left = IM_COL32(200, 0, 0, 255), right = IM_COL32(0, 200, 0, 128);
    float right_x = 60;
    bool popup = false;
  };

  /// Returns the pixels drawn through a cache.
  cv::Mat draw(const Content& content, WindowImage& image) {
    context_.bind();
    gui_.begin_frame(100, 80);
    window("left", {10, 10}, content.left);
    window("right", {content.right_x, 10}, content.right);
    if (content.popup) window("popup", {30, 20}, IM_COL32(0, 0, 200, 100));
    gui_.end_frame(image, kGround);
    return context_.read_bgr();
  }
  cv::Mat draw(const Content& content) { return draw(content, image_); }
  cv::Mat drawn_at_once(const Content& content) {
    WindowImage fresh;
    return draw(content, fresh);
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
  const cv::Mat first = draw({});
  EXPECT_THAT(image_.redrawn(), ElementsAre(cv::Rect(0, 0, 100, 80)));
  glClearColor(1, 1, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  EXPECT_TRUE(same_bytes(draw({}), first));
  EXPECT_THAT(image_.redrawn(), IsEmpty());
  EXPECT_EQ(first.at<cv::Vec3b>(79, 99), cv::Vec3b(0x30, 0x20, 0x10));
}

TEST_F(WindowImages, RedrawsOnlyTheChangedWindow) {
  draw({});
  const Content other{.left = IM_COL32(9, 9, 9, 99)};
  const cv::Mat image = draw(other);
  ASSERT_EQ(image_.redrawn().size(), 1U);
  EXPECT_LE(image_.redrawn().front().area(), 30 * 40);
  EXPECT_TRUE(image_.redrawn().front().contains({25, 30}));
  EXPECT_TRUE(same_bytes(image, drawn_at_once(other)));
}

TEST_F(WindowImages, PartialRedrawGivesTheSameBytesAsAFullOne) {
  for (const Content& content : {Content{},
                                 {.right_x = 47},
                                 {.right_x = 47, .popup = true},
                                 {.right = IM_COL32(99, 0, 99, 99), .popup = true},
                                 {.right_x = 110},
                                 {}}) {
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

TEST(DroppedFiles, AreNamedIfOnlyOneOfThemIsOpened) {
  WorkbenchState state;
  Commands commands;
  push_drop({.kind = Kind::drop, .code = 3, .path = "/data/desk"}, commands);
  for (const Command& command : commands) apply(state, command);
  EXPECT_EQ(state.requests.open, std::filesystem::path("/data/desk"));
  EXPECT_EQ(state.messages.text, "3 files were dropped: only /data/desk is opened");
}

class InputQueueTest : public testing::Test {
 protected:
  void key(int code, int action, int modifiers = 0) {
    queue_.push({.kind = Kind::key, .code = code, .action = action, .modifiers = modifiers});
  }
  void type(int code, int modifiers = 0) {
    key(code, GLFW_PRESS, modifiers);
    if (code < GLFW_KEY_ESCAPE && modifiers == 0)
      queue_.push({.kind = Kind::character, .character = static_cast<char32_t>(code)});
    key(code, GLFW_RELEASE, modifiers);
  }
  void button(int action) {
    queue_.push({.kind = Kind::button, .action = action, .modifiers = GLFW_MOD_CONTROL});
  }
  /// Returns a frame's events: "+" and "-" of keys with their numbers, characters, "b" buttons.
  std::string frame(Listener listener) {
    std::string events;
    queue_.begin_frame();
    while (queue_.has_next(listener)) {
      const InputEvent event = queue_.take();
      if (event.kind == Kind::character) events += static_cast<char>(event.character);
      if (event.kind == Kind::button) events += event.action == GLFW_PRESS ? "b+ " : "b- ";
      if (event.kind == Kind::pointer) events += "m";
      if (event.kind == Kind::key && !types(event))
        events += (event.action == GLFW_PRESS ? "+" : "-") + std::to_string(event.code) + " ";
    }
    return events;
  }

  InputQueue queue_;
};

TEST_F(InputQueueTest, TakesTextInOneFrameAndWaitsAfterEnter) {
  for (const char c : std::string("FRAME 7")) type(c);
  type(GLFW_KEY_ENTER);
  type('X');
  EXPECT_EQ(frame(Listener::field), "FRAME 7+257 ");
  // Dear ImGui needs some frames to report the effect of Enter.
  EXPECT_EQ(frame(Listener::field), "");
  EXPECT_EQ(frame(Listener::field), "");
  EXPECT_EQ(frame(Listener::shortcuts), "-257 X");
  EXPECT_TRUE(queue_.empty());
}

TEST_F(InputQueueTest, SplitsPressAndReleaseInAField) {
  type(GLFW_KEY_BACKSPACE);
  type(GLFW_KEY_BACKSPACE);
  for (const char* events : {"+259 ", "-259 ", "+259 ", "-259 "})
    EXPECT_EQ(frame(Listener::field), events);
}

TEST_F(InputQueueTest, DelaysTextAfterACommandKey) {
  type('A');
  type(GLFW_KEY_BACKSPACE);
  type('B');
  EXPECT_EQ(frame(Listener::field), "A+259 ") << "a field handles characters first";
  EXPECT_EQ(frame(Listener::field), "-259 B");
}

TEST_F(InputQueueTest, SeparatesTextFromControl) {
  type('A');
  key(GLFW_KEY_LEFT_CONTROL, GLFW_PRESS);
  type('P', GLFW_MOD_CONTROL);
  key(GLFW_KEY_LEFT_CONTROL, GLFW_RELEASE, GLFW_MOD_CONTROL);
  type('B');
  for (const char* events : {"A", "+341 +80 ", "-80 -341 B"})
    EXPECT_EQ(frame(Listener::field), events);
}

TEST_F(InputQueueTest, PassesEveryShortcut) {
  for (int i = 0; i < 3; ++i) type(GLFW_KEY_RIGHT);
  EXPECT_EQ(frame(Listener::shortcuts), "+262 -262 +262 -262 +262 -262 ");
}

TEST_F(InputQueueTest, HoldsKeysUntilTheFieldOpens) {
  type('A');
  queue_.push({.kind = Kind::pointer, .x = 1});
  EXPECT_EQ(frame(Listener::none), "");
  EXPECT_EQ(frame(Listener::field), "Am");
}

TEST_F(InputQueueTest, KeepsModifiersDownDuringAClick) {
  key(GLFW_KEY_LEFT_CONTROL, GLFW_PRESS);
  button(GLFW_PRESS);
  button(GLFW_RELEASE);
  key(GLFW_KEY_LEFT_CONTROL, GLFW_RELEASE);
  type('A');
  for (const char* events : {"+341 b+ ", "b- ", "", ""})
    EXPECT_EQ(frame(Listener::shortcuts), events);
  EXPECT_EQ(frame(Listener::field), "-341 A");
}

TEST_F(InputQueueTest, KeepsOnlyTheLastPointerPosition) {
  for (int x = 0; x < 5; ++x) queue_.push({.kind = Kind::pointer, .x = static_cast<double>(x)});
  queue_.begin_frame();
  ASSERT_TRUE(queue_.has_next(Listener::shortcuts));
  EXPECT_EQ(queue_.take().x, 4);
  EXPECT_TRUE(queue_.empty());
}

}  // namespace
}  // namespace gpo
