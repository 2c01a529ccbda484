// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/actions.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

/// Returns where a script line's comment begins: at a '#' that begins a word outside of quotes.
std::size_t comment_begin(std::string_view line) {
  bool quoted = false, in_word = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '#' && !quoted && !in_word) return i;
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == '\\' && quoted && i + 1 < line.size()) ++i;  // the next character is one of the word
    in_word = line[i] != ' ' && line[i] != '\t';
  }
  return line.size();
}

/// Words for which users look, beside those in the names of the actions.
constexpr std::pair<std::string_view, const char*> kSynonyms[] = {
    {"metric", "scale measure units length"},
    {"select track", "measure distance between two points length"},
    {"put-cube", "origin place move anchor object"},
    {"reset-cube", "origin place object"},
    {"window-start", "origin reference frame"},
    {"export result", "report summary save"},
    {"export points", "cloud map save"},
    {"export trajectory", "poses path report save"},
    {"save-picture", "screenshot image png"},
    {"gravity", "horizon up vertical level"},
    {"undistorted", "rectify lens"},
    {"exclude", "delete remove reject"},
    {"mask not", "ignore region rectangle polygon area roi"},
    {"mask plane", "region rectangle polygon area roi floor table"},
    {"explain-track", "why rejected outlier reason"},
    {"calibrate", "camera lens focal intrinsics"},
    {"find-start", "scan initialize search"},
    {"live", "webcam device capture rtsp http udp phone"},
    {"theme dark", "color appearance night"},
    {"theme light", "color appearance day"},
    {"text-size", "font zoom scale dpi"}};

std::string synonyms_of(std::string_view name) {
  const auto found =
      std::ranges::find(kSynonyms, name, &std::pair<std::string_view, const char*>::first);
  return found == std::end(kSynonyms) ? "" : found->second;
}

const Action* find_shortcut(auto&& matches, const WorkbenchState* state = nullptr) {
  for (const Action& action : actions()) {
    if (action.takes_keys && (state == nullptr || !action.takes_keys(*state))) continue;
    if (std::ranges::any_of(action.shortcuts, matches)) return &action;
  }
  return nullptr;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> std::quoted(word);) words.push_back(word);
  return words;
}

/// The least and the largest number of words that "FILE [VIEW] [WxH]" or "[NOTE ...]" allows.
std::pair<std::size_t, std::size_t> argument_counts(const std::string& arguments) {
  std::istringstream stream(arguments);
  std::size_t least = 0, most = 0;
  bool optional = false;
  for (std::string word; stream >> word; ++most) {
    if (word.starts_with("...")) return {least, std::numeric_limits<std::size_t>::max()};
    optional = optional || word.starts_with('[');
    if (!optional) ++least;
  }
  return {least, most};
}

/// Throws InputError for a line that is no command.
[[noreturn]] void refuse_line(const std::string& line) {
  const std::vector<std::string> words = words_of(line);
  const std::string first = words.empty() ? line : words[0];
  std::vector<std::string> seconds;
  for (const Action& action : actions())
    if (action.name.starts_with(first + " "))
      seconds.push_back(action.name.substr(first.size() + 1));
  if (!seconds.empty())
    throw InputError(fmt::format("{}: {}expected one of {}",
                                 first,
                                 words.size() > 1 ? "'" + words[1] + "', " : "",
                                 fmt::join(seconds, ", ")));
  if (words.size() > 2 && std::ranges::count(setting_keys(), first) > 0)
    throw InputError(fmt::format("{}: unexpected argument '{}'", first, words[2]));
  throw InputError(fmt::format("unknown command \"{}\"; Ctrl+P lists all commands", first));
}

std::vector<Action> make_actions() {
  std::vector<Action> table;
  add_file_actions(table);
  add_edit_actions(table);
  add_point_actions(table);
  add_mask_actions(table);
  add_view_actions(table);
  add_time_actions(table);
  add_method_actions(table);
  add_finding_actions(table);
  add_help_actions(table);
  return table;
}

}  // namespace

const Action* find_action(const std::string& name) {
  const auto table = actions();
  const auto found = std::ranges::find(table, name, &Action::name);
  return found == table.end() ? nullptr : &*found;
}

const Action& action_named(std::string_view name) {
  if (const Action* action = find_action(std::string(name))) return *action;
  throw std::logic_error("unknown action: " + std::string(name));
}

const Action* action_of_key(int glfw_key, bool shift, bool control) {
  return find_shortcut([&](const Shortcut& s) {
    return s.character == 0 && s.key == glfw_key && s.shift == shift && s.control == control;
  });
}

const Action* action_of_character(char32_t typed, const WorkbenchState* state) {
  const char32_t lower = typed >= U'A' && typed <= U'Z' ? typed - U'A' + U'a' : typed;
  return find_shortcut([&](const Shortcut& s) { return s.character != 0 && s.character == lower; },
                       state);
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
  const auto in = [&](const std::string& where) {
    const std::string all = lower_case(where);
    return std::ranges::all_of(
        words, [&](const std::string& word) { return all.find(word) != std::string::npos; });
  };
  const auto rank = [&](const Action& action) {
    const std::string named = action.name + " " + action.title + " " + action.menu;
    if (action.name.starts_with(lower_case(text))) return 0;
    if (in(named)) return 1;
    if (in(named + " " + synonyms_of(action.name))) return 2;
    return in(named + " " + synonyms_of(action.name) + " " + action.tooltip) ? 3 : 4;
  };
  std::vector<std::pair<int, Action>> ranked;
  for (Action& action : all_actions(state)) {
    const int place = rank(action);
    if (place < 4) ranked.emplace_back(place, std::move(action));
  }
  std::ranges::stable_sort(ranked, {}, &std::pair<int, Action>::first);
  std::vector<Action> found;
  for (auto& [place, action] : ranked) found.push_back(std::move(action));
  return found;
}

std::optional<ActionCall> match_line(const std::string& line) {
  const std::vector<std::string> words = words_of(line);
  for (auto end = words.end(); end != words.begin(); --end)
    if (const Action* action = find_action(fmt::format("{}", fmt::join(words.begin(), end, " "))))
      return ActionCall{action, {action->name, {end, words.end()}}};
  // The name of a setting is enough: "start 0" is "set start 0".
  if (words.size() == 2 && std::ranges::count(setting_keys(), words.front()) > 0)
    return ActionCall{find_action("set"), {"set", words}};
  return std::nullopt;
}

void run_line(WorkbenchState& state, const std::string& line) {
  const auto call = match_line(line);
  if (!call) refuse_line(line);
  const auto& [action, arguments] = *call;
  if (!enabled(*action, state)) throw InputError("no recording is open");
  const auto [least, most] = argument_counts(action->arguments);
  if (arguments.size() < least)
    throw InputError(fmt::format("{}: expected {}", action->name, action->arguments));
  if (arguments.size() > most)
    throw InputError(fmt::format("{}: unexpected argument '{}'", action->name, arguments[most]));
  action->run(state, arguments);
}

void run_action(WorkbenchState& state, const std::string& line) {
  try {
    run_line(state, line);
  } catch (const InputError& error) {
    say(state, error.what(), Severity::warning);
  }
}

double Arguments::number_within(double least, double most, std::size_t i) const {
  const double value = number(i);
  if (value >= least && value <= most) return value;
  throw InputError(fmt::format("{}: '{}', expected {:g} to {:g}", action, words[i], least, most));
}

double Arguments::number(std::size_t i) const {
  if (i >= words.size()) throw InputError(fmt::format("{}: expected a number", action));
  if (const auto value = parse_number(words[i])) return *value;
  throw InputError(fmt::format("{}: '{}', expected a number", action, words[i]));
}

int Arguments::whole_number(std::size_t i) const {
  const double value = number(i);
  if (value != std::round(value) || std::abs(value) > 1e9)
    throw InputError(fmt::format("{}: '{}', expected a whole number", action, words[i]));
  return static_cast<int>(value);
}

bool Arguments::on_off(bool now, std::size_t i) const {
  if (i >= words.size()) return !now;
  if (words[i] == "on" || words[i] == "off") return words[i] == "on";
  throw InputError(fmt::format("{}: '{}', expected on or off", action, words[i]));
}

ImageZoom Arguments::zoom(const Recording& recording) const {
  ImageZoom zoom;
  zoom.factor = number_within(1, 64);
  if (words.size() > 1) {
    const ShownImage image(recording.camera, recording.quarter_turns);
    const ImageMapping whole = map_image(image, {.size = image.size()}, {});
    const Vector2d from_corner(number(1), number(2));
    zoom.center = to_screen(whole, from_corner - Vector2d::Constant(0.5))
                      .cwiseQuotient(image.size())
                      .cwiseMax(0)
                      .cwiseMin(1);
  }
  return zoom;
}

std::vector<ScriptLine> read_script(const fs::path& file) {
  std::istringstream text(read_file(file, limits().hand_bytes));
  std::vector<ScriptLine> lines;
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    line = line.substr(0, comment_begin(line));
    if (line.find_first_not_of(" \t\r") != std::string::npos) lines.push_back({number, line});
  }
  return lines;
}

cv::Size image_size(const std::string& text, const std::string& requested_by) {
  constexpr int kLeast = 16, kMost = 8192;
  const auto possible = [](int side) { return side >= kLeast && side <= kMost; };
  const auto size = parse_size(text);
  if (size && possible(size->first) && possible(size->second)) return {size->first, size->second};
  throw InputError(fmt::format("{}: '{}', expected WIDTHxHEIGHT of {} to {} pixels, e.g. 1280x720",
                               requested_by,
                               text,
                               kLeast,
                               kMost));
}

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

Action& MenuRows::add(Action action) const {
  action.menu = menu;
  action.submenu = submenu;
  action.needs_recording = needs_recording;
  return table.emplace_back(std::move(action));
}

Action& MenuRows::add(Action action,
                      const char* arguments,
                      std::function<void(WorkbenchState&, const Arguments&)> run) const {
  action.arguments = arguments;
  action.run = std::move(run);
  return add(std::move(action));
}

Action& MenuRows::plain(Action action, std::function<void(WorkbenchState&)> run) const {
  action.run = [run = std::move(run)](WorkbenchState& state, const Arguments&) { run(state); };
  return add(std::move(action));
}

Action& MenuRows::toggle(Action action, const std::function<bool&(WorkbenchState&)>& flag) const {
  action.checked = [flag](const WorkbenchState& s) { return flag(const_cast<WorkbenchState&>(s)); };
  return anytime().add(
      std::move(action), "[on|off]", [flag](WorkbenchState& s, const Arguments& arguments) {
        flag(s) = arguments.on_off(flag(s));
      });
}

Shortcut key(int glfw_key, std::string label, bool shift) {
  return {.key = glfw_key, .shift = shift, .label = std::move(label)};
}

Shortcut letter(char character) {
  const char lower = character >= 'A' && character <= 'Z' ? char(character - 'A' + 'a') : character;
  return {.character = static_cast<char32_t>(lower), .label = std::string(1, character)};
}

Shortcut control(char letter) {
  return {.key = letter, .control = true, .label = std::string("Ctrl+") + letter};
}

}  // namespace gpo
