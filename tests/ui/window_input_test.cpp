// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/window_input.h"

#include "tests/ui/window_test.h"

#include <GLFW/glfw3.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

/// Keys of a keyboard whose layout differs from a US one.
class KeyCommandsTest : public test::WindowTest {
 protected:
  /// `name`: what the layout types at the place.
  InputEvent event(int place, const char* name, int action, int modifiers = 0) const {
    return {.code = place,
            .action = action,
            .modifiers = modifiers,
            .layout_key = key_in_layout(place, name),
            .time_s = time_s_};
  }
  std::string press(int place, const char* name, int modifiers = 0, int action = GLFW_PRESS) {
    Commands commands;
    keys_.press(event(place, name, action, modifiers), listener_, state_, commands);
    return test::line_of(commands);
  }
  std::string release(int place, const char* name, int modifiers = 0) {
    return press(place, name, modifiers, GLFW_RELEASE);
  }
  /// Returns the line of a character; the key at the place types it.
  std::string type(int place, const char* name, char32_t character) {
    press(place, name);
    Commands commands;
    const InputEvent typed{
        .kind = InputEvent::Kind::character, .character = character, .time_s = time_s_};
    keys_.type(typed, listener_, state_, commands);
    return test::line_of(commands);
  }

  KeyCommands keys_;
  Listener listener_ = Listener::shortcuts;
  double time_s_ = 10;
};

TEST_F(KeyCommandsTest, ControlWithALetterFollowsTheLayout) {
  const auto control = [this](int place, const char* name, int more = 0) {
    return press(place, name, GLFW_MOD_CONTROL | more);
  };
  EXPECT_EQ(control(GLFW_KEY_Z, "z"), "undo");
  EXPECT_EQ(control(GLFW_KEY_Y, "z"), "undo") << "German";
  EXPECT_EQ(control(GLFW_KEY_Z, "y"), "redo") << "German";
  EXPECT_EQ(control(GLFW_KEY_Q, "a"), "") << "French: Ctrl+A must not quit";
  EXPECT_EQ(control(GLFW_KEY_A, "q"), "quit") << "French";
  EXPECT_EQ(control(GLFW_KEY_Z, "\u044f"), "undo") << "Russian: no Latin letters";
  EXPECT_EQ(control(GLFW_KEY_0, "\u00e0"), "text-size") << "French";
  EXPECT_EQ(control(GLFW_KEY_0, "*"), "text-size") << "a sign without a shortcut";
  EXPECT_EQ(control(GLFW_KEY_RIGHT_BRACKET, "+"), "larger") << "German";
  EXPECT_EQ(control(GLFW_KEY_SLASH, "-"), "smaller") << "German";
  EXPECT_EQ(control(GLFW_KEY_MINUS, "\u00df"), "") << "German";
  EXPECT_EQ(control(GLFW_KEY_EQUAL, "=", GLFW_MOD_SHIFT), "larger");
}

TEST_F(KeyCommandsTest, ArrowsAndFunctionKeysHaveAPlace) {
  EXPECT_EQ(press(GLFW_KEY_LEFT, ""), "previous");
  EXPECT_EQ(press(GLFW_KEY_F1, ""), "help");
  EXPECT_EQ(press(GLFW_KEY_KP_7, "7"), "viewpoint top");
}

TEST_F(KeyCommandsTest, DigitsNeedNoShiftOnAFrenchKeyboard) {
  EXPECT_EQ(type(GLFW_KEY_1, "&", U'&'), type(GLFW_KEY_1, "1", U'1'));
  EXPECT_EQ(type(GLFW_KEY_2, "\u00e9", U'\u00e9'), type(GLFW_KEY_2, "2", U'2'));
  EXPECT_EQ(type(GLFW_KEY_T, "\u0435", U'\u0435'), "tails") << "Russian";
  EXPECT_EQ(type(GLFW_KEY_SEMICOLON, "\u00f6", U'\u00f6'), "") << "German";
}

TEST_F(KeyCommandsTest, DigitsOfTheKeypadOnlyChooseAViewpoint) {
  EXPECT_EQ(type(GLFW_KEY_KP_7, "7", U'7'), "");
}

TEST_F(KeyCommandsTest, FlipEndsWithItsKeyWhateverElseIsPressed) {
  EXPECT_EQ(press(GLFW_KEY_X, "x"), "flip on");
  EXPECT_EQ(press(GLFW_KEY_LEFT_SHIFT, ""), "");
  EXPECT_EQ(release(GLFW_KEY_X, "x", GLFW_MOD_SHIFT), "flip off");
  EXPECT_EQ(press(GLFW_KEY_B, "x"), "flip on") << "Dvorak";
  listener_ = Listener::field;
  EXPECT_EQ(release(GLFW_KEY_B, "n"), "flip off") << "another layout, and a field is open";
  EXPECT_EQ(release(GLFW_KEY_B, "x"), "");
}

TEST_F(KeyCommandsTest, DigitsChooseNothingRightAfterAField) {
  keys_.note_field({.time_s = 10});
  time_s_ = 10.4;
  EXPECT_EQ(type(GLFW_KEY_2, "2", U'2'), "");
  EXPECT_EQ(type(GLFW_KEY_T, "t", U't'), "tails");
  time_s_ = 11.5;
  EXPECT_THAT(type(GLFW_KEY_2, "2", U'2'), testing::StartsWith("method "));
}

}  // namespace
}  // namespace gpo
