// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/input_queue.h"

#include <string>

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Kind = InputEvent::Kind;

void type(InputQueue& queue, int key, int modifiers = 0) {
  queue.push({Kind::key, key, 0, GLFW_PRESS, modifiers});
  if (key < GLFW_KEY_ESCAPE && modifiers == 0)
    queue.push({.kind = Kind::character, .character = static_cast<char32_t>(key)});
  queue.push({Kind::key, key, 0, GLFW_RELEASE, modifiers});
}

/// A frame's events: "+" and "-" of keys with their numbers, characters as they are, "b" buttons.
std::string frame(InputQueue& queue, Listener listener) {
  std::string events;
  queue.begin_frame();
  while (queue.has_next(listener)) {
    const InputEvent event = queue.take();
    if (event.kind == Kind::character) events += static_cast<char>(event.character);
    if (event.kind == Kind::button) events += event.action == GLFW_PRESS ? "b+ " : "b- ";
    if (event.kind == Kind::pointer) events += "m";
    if (event.kind == Kind::key && !types(event))
      events += (event.action == GLFW_PRESS ? "+" : "-") + std::to_string(event.code) + " ";
  }
  return events;
}

TEST(InputQueue, TextIsOneFramesAndEnterTheLastOfIt) {
  InputQueue queue;
  for (const char c : std::string("FRAME 7")) type(queue, c);
  type(queue, GLFW_KEY_ENTER);
  type(queue, 'X');
  EXPECT_EQ(frame(queue, Listener::field), "FRAME 7+257 ");
  // What Enter does takes Dear ImGui some frames to say.
  EXPECT_EQ(frame(queue, Listener::field), "");
  EXPECT_EQ(frame(queue, Listener::field), "");
  EXPECT_EQ(frame(queue, Listener::shortcuts), "-257 X");
  EXPECT_TRUE(queue.empty());
}

TEST(InputQueue, AKeyOfAFieldThatGoesDownAndUpIsSeenDown) {
  InputQueue queue;
  type(queue, GLFW_KEY_BACKSPACE);
  type(queue, GLFW_KEY_BACKSPACE);
  EXPECT_EQ(frame(queue, Listener::field), "+259 ");
  EXPECT_EQ(frame(queue, Listener::field), "-259 ");
  EXPECT_EQ(frame(queue, Listener::field), "+259 ");
  EXPECT_EQ(frame(queue, Listener::field), "-259 ");
}

TEST(InputQueue, WhatIsTypedAfterAKeyThatTypesNothingIsTheNextFrames) {
  InputQueue queue;
  type(queue, 'A');
  type(queue, GLFW_KEY_BACKSPACE);
  type(queue, 'B');
  EXPECT_EQ(frame(queue, Listener::field), "A+259 ") << "a field takes characters first";
  EXPECT_EQ(frame(queue, Listener::field), "-259 B");
}

TEST(InputQueue, WhatIsTypedDoesNotMeetTheNextCtrl) {
  InputQueue queue;
  type(queue, 'A');
  queue.push({Kind::key, GLFW_KEY_LEFT_CONTROL, 0, GLFW_PRESS, 0});
  type(queue, 'P', GLFW_MOD_CONTROL);
  queue.push({Kind::key, GLFW_KEY_LEFT_CONTROL, 0, GLFW_RELEASE, GLFW_MOD_CONTROL});
  type(queue, 'B');
  EXPECT_EQ(frame(queue, Listener::field), "A");
  EXPECT_EQ(frame(queue, Listener::field), "+341 +80 ");
  EXPECT_EQ(frame(queue, Listener::field), "-80 -341 B");
}

TEST(InputQueue, ShortcutsAreAsManyAsCame) {
  InputQueue queue;
  for (int i = 0; i < 3; ++i) type(queue, GLFW_KEY_RIGHT);
  EXPECT_EQ(frame(queue, Listener::shortcuts), "+262 -262 +262 -262 +262 -262 ");
}

TEST(InputQueue, KeysWaitForAFieldThatIsToCome) {
  InputQueue queue;
  type(queue, 'A');
  queue.push({.kind = Kind::pointer, .x = 1});
  EXPECT_EQ(frame(queue, Listener::nobody), "");
  EXPECT_EQ(frame(queue, Listener::field), "Am");
}

TEST(InputQueue, KeysWaitAfterAClickAndModifiersOutlastIt) {
  InputQueue queue;
  queue.push({Kind::key, GLFW_KEY_LEFT_CONTROL, 0, GLFW_PRESS, 0});
  queue.push({Kind::button, 0, 0, GLFW_PRESS, GLFW_MOD_CONTROL});
  queue.push({Kind::button, 0, 0, GLFW_RELEASE, GLFW_MOD_CONTROL});
  queue.push({Kind::key, GLFW_KEY_LEFT_CONTROL, 0, GLFW_RELEASE, 0});
  type(queue, 'A');
  EXPECT_EQ(frame(queue, Listener::shortcuts), "+341 b+ ");
  EXPECT_EQ(frame(queue, Listener::shortcuts), "b- ");
  EXPECT_EQ(frame(queue, Listener::shortcuts), "");
  EXPECT_EQ(frame(queue, Listener::shortcuts), "");
  EXPECT_EQ(frame(queue, Listener::field), "-341 A");
}

TEST(InputQueue, OfAMovingPointerTheLastPlaceCounts) {
  InputQueue queue;
  for (int x = 0; x < 5; ++x) queue.push({.kind = Kind::pointer, .x = static_cast<double>(x)});
  queue.begin_frame();
  ASSERT_TRUE(queue.has_next(Listener::shortcuts));
  EXPECT_EQ(queue.take().x, 4);
  EXPECT_TRUE(queue.empty());
}

}  // namespace
}  // namespace gpo
