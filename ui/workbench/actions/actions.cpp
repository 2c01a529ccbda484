// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/actions.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/inspection/settings/settings_table.h"
#include "ui/workbench/actions/tables.h"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

std::vector<Action> make_actions() {
  std::vector<Action> table;
  add_file_actions(table);
  add_edit_actions(table);
  add_view_actions(table);
  add_time_actions(table);
  add_method_actions(table);
  add_help_actions(table);
  return table;
}

template <class Matches>
const Action* find_shortcut(Matches&& matches) {
  for (const Action& action : actions()) {
    if (std::any_of(action.shortcuts.begin(), action.shortcuts.end(), matches)) return &action;
  }
  return nullptr;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> std::quoted(word);) words.push_back(word);
  return words;
}

bool has_all_words(const std::string& text, const std::vector<std::string>& words) {
  return std::ranges::all_of(
      words, [&](const std::string& word) { return text.find(word) != std::string::npos; });
}

}  // namespace

std::span<const Action> actions() {
  static const std::vector<Action> table = make_actions();
  return table;
}

std::vector<Action> all_actions(const WorkbenchState& state) {
  std::vector<Action> all(actions().begin(), actions().end());
  const auto last = std::find_if(all.rbegin(), all.rend(), [](const Action& action) {
    return action.name.starts_with("method ");
  });
  std::vector<Action> own;
  for (const auto& method : state.methods.own())
    own.push_back(choice_of_method(MethodChoice(method)));
  all.insert(last.base(), own.begin(), own.end());
  return all;
}

const Action* find_action(const std::string& name) {
  const auto table = actions();
  const auto found = std::ranges::find(table, name, &Action::name);
  return found == table.end() ? nullptr : &*found;
}

const Action& action_named(std::string_view name) {
  if (const Action* action = find_action(std::string(name))) return *action;
  throw std::logic_error("no action is called " + std::string(name));
}

const Action* action_of_key(int glfw_key, bool shift, bool control) {
  return find_shortcut([&](const Shortcut& s) {
    return s.character == 0 && s.key == glfw_key && s.shift == shift && s.control == control;
  });
}

const Action* action_of_character(char32_t character) {
  const char32_t lower =
      character >= U'A' && character <= U'Z' ? character - U'A' + U'a' : character;
  return find_shortcut([&](const Shortcut& s) { return s.character != 0 && s.character == lower; });
}

bool enabled(const Action& action, const WorkbenchState& state) {
  return state.document.recording || !action.needs_recording;
}

bool takes_a_file(const Action& action) {
  return action.arguments.starts_with("FILE") || action.arguments.starts_with("PATH") ||
         action.arguments.starts_with("[FILE");
}

std::vector<Action> find_actions(const std::string& text, const WorkbenchState& state) {
  const std::vector<std::string> words = words_of(lower_case(text));
  std::vector<Action> found = all_actions(state);
  std::erase_if(found, [&](const Action& action) {
    return !has_all_words(lower_case(action.name + " " + action.title + " " + action.menu), words);
  });
  std::stable_partition(found.begin(), found.end(), [&](const Action& action) {
    return action.name.starts_with(lower_case(text));
  });
  return found;
}

std::optional<ActionCall> match_line(const std::string& line) {
  const std::vector<std::string> words = words_of(line);
  for (std::size_t count = words.size(); count > 0; --count) {
    const std::string name = fmt::format(
        "{}", fmt::join(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(count), " "));
    if (const Action* action = find_action(name))
      return ActionCall{action, {words.begin() + static_cast<std::ptrdiff_t>(count), words.end()}};
  }
  // A setting's name is enough: "start 0" is "set start 0".
  if (words.size() > 1 && std::ranges::count(setting_keys(), words.front()) > 0)
    return ActionCall{find_action("set"), words};
  return std::nullopt;
}

void run_line(WorkbenchState& state, const std::string& line) {
  const auto call = match_line(line);
  if (!call) {
    const std::vector<std::string> words = words_of(line);
    throw InputError(
        fmt::format("no action is called \"{}\"; F1 lists them", words.empty() ? line : words[0]));
  }
  if (!enabled(*call->action, state)) throw InputError("no recording is open");
  call->action->run(state, call->arguments);
}

void run_action(WorkbenchState& state, const std::string& line) {
  try {
    run_line(state, line);
  } catch (const InputError& error) {
    say(state, error.what(), Severity::warning);
  }
}

}  // namespace gpo
