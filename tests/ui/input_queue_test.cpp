// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/window_input.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Kind = InputEvent::Kind;

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
