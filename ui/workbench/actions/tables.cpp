// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/tables.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

namespace gpo {

void add_submenu(std::vector<Action>& table, const char* title, void (*add)(std::vector<Action>&)) {
  const std::size_t before = table.size();
  add(table);
  for (std::size_t i = before; i < table.size(); ++i) table[i].submenu = title;
}

Shortcut key(int glfw_key, std::string label, bool shift) {
  return {glfw_key, shift, false, 0, std::move(label)};
}

Shortcut letter(char character) {
  const char lower = character >= 'A' && character <= 'Z' ? char(character - 'A' + 'a') : character;
  return {0, false, false, static_cast<char32_t>(lower), std::string(1, character)};
}

Shortcut control(char letter) { return {letter, false, true, 0, std::string("Ctrl+") + letter}; }

Action plain(std::string name,
             std::string title,
             std::string menu,
             std::vector<Shortcut> shortcuts,
             std::string tooltip,
             std::function<void(WorkbenchState&)> run) {
  Action action{
      std::move(name), std::move(title), std::move(menu), std::move(shortcuts), std::move(tooltip)};
  action.run = [run = std::move(run), name = action.name](WorkbenchState& state,
                                                          const Arguments& arguments) {
    expect_count(name.c_str(), arguments, 0, 0);
    run(state);
  };
  return action;
}

Action anytime(Action action) {
  action.needs_recording = false;
  return action;
}

double number_in(const char* action, const Arguments& arguments, std::size_t index) {
  if (index >= arguments.size())
    throw InputError(fmt::format("{}: expected a number after it", action));
  const std::string& text = arguments[index];
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    throw InputError(fmt::format("{}: '{}', expected a number", action, text));
  return value;
}

int whole_number_in(const char* action, const Arguments& arguments, std::size_t index) {
  const double value = number_in(action, arguments, index);
  if (value != std::round(value) || std::abs(value) > 1e9)
    throw InputError(fmt::format("{}: '{}', expected a whole number", action, arguments.at(index)));
  return static_cast<int>(value);
}

void expect_count(const char* action,
                  const Arguments& arguments,
                  std::size_t least,
                  std::size_t most) {
  if (arguments.size() < least)
    throw InputError(fmt::format("{}: expected {} after it",
                                 action,
                                 least == 1 ? "one word" : fmt::format("{} words", least)));
  if (arguments.size() > most)
    throw InputError(fmt::format("{}: '{}' is one word too many", action, arguments[most]));
}

bool switched(const char* action, const Arguments& arguments, bool now) {
  expect_count(action, arguments, 0, 1);
  if (arguments.empty()) return !now;
  if (arguments[0] == "on") return true;
  if (arguments[0] == "off") return false;
  throw InputError(fmt::format("{}: '{}', expected on or off", action, arguments[0]));
}

ImageZoom zoom_in(const char* action, const Arguments& arguments, const Camera& camera) {
  expect_count(action, arguments, 1, 3);
  ImageZoom wanted;
  wanted.factor = std::clamp(number_in(action, arguments), 1.0, 64.0);
  if (arguments.size() > 1)
    wanted.center = Eigen::Vector2d(number_in(action, arguments, 1) / camera.width,
                                    number_in(action, arguments, 2) / camera.height)
                        .cwiseMax(0)
                        .cwiseMin(1);
  return wanted;
}

Action toggle(std::string name,
              std::string title,
              std::vector<Shortcut> shortcuts,
              std::string tooltip,
              const std::function<bool&(WorkbenchState&)>& flag) {
  Action action{
      std::move(name), std::move(title), "View", std::move(shortcuts), std::move(tooltip)};
  action.arguments = "[on|off]";
  action.run = [flag, name = action.name](WorkbenchState& s, const Arguments& arguments) {
    flag(s) = switched(name.c_str(), arguments, flag(s));
  };
  action.checked = [flag](const WorkbenchState& s) { return flag(const_cast<WorkbenchState&>(s)); };
  action.needs_recording = false;
  return action;
}

}  // namespace gpo
