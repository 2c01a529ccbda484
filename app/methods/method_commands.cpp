// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/methods/method_commands.h"

#include "engine/base/error.h"
#include "engine/commands/command_method.h"
#include "engine/commands/own_method.h"
#include "engine/files/json_text.h"
#include "engine/results/result_method.h"
#include "ui/workbench/session/script.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// What is known of the command line before it is read.
struct Glance {
  MethodArguments methods;
  std::optional<fs::path> session;
  std::optional<fs::path> script;
  std::vector<fs::path> merge;
  std::vector<std::string> others;
};

/// Nothing of one that is wrong, which is said where all is read.
std::optional<Glance> glance_at(int argc, const char* const* argv) {
  CLI::App only_these;
  only_these.set_help_flag();
  only_these.allow_extras();
  Glance glance;
  add_method_commands(only_these, glance.methods);
  only_these.add_option("--session", glance.session)->allow_extra_args(false);
  only_these.add_option("--script", glance.script)->allow_extra_args(false);
  only_these.add_option("--merge", glance.merge);
  try {
    only_these.parse(argc, argv);
  } catch (const CLI::ParseError&) {
    return std::nullopt;
  }
  glance.others = only_these.remaining();
  return glance;
}

/// Sessions that the command line opens, or its script.
std::vector<fs::path> sessions_of(const Glance& glance) {
  std::vector<fs::path> files;
  if (glance.session) files.push_back(*glance.session);
  const auto& others = glance.others;
  const std::size_t recording = !others.empty() && others[0] == "view" ? 1 : 0;
  if (recording < others.size()) files.emplace_back(others[recording]);
  try {
    constexpr std::string_view kOpen = "open ";
    for (const ScriptLine& line :
         glance.script ? read_script(*glance.script) : std::vector<ScriptLine>{})
      if (line.text.starts_with(kOpen)) files.emplace_back(line.text.substr(kOpen.size()));
    std::erase_if(files, [](const fs::path& file) { return !is_session(file); });
  } catch (const InputError&) {
    files.clear();  // said where it is read
  }
  return files;
}

/// Those of `from` whose names are not taken yet.
std::vector<std::string> take_new(const std::vector<std::string>& from,
                                  std::set<std::string>& taken) {
  std::vector<std::string> fresh;
  for (const std::string& one : from)
    if (taken.insert(one.substr(0, one.find('='))).second) fresh.push_back(one);
  return fresh;
}

/// All that is asked about must be seen: nothing beyond the window, nothing behind line ends.
void check_can_be_shown(const std::vector<std::string>& waiting) {
  constexpr std::size_t kMostCommands = 20, kMostBytes = 2000;
  std::size_t bytes = 0;
  for (const std::string& one : waiting) bytes += legible(one, kMostBytes + 1).size();
  if (waiting.size() > kMostCommands || bytes > kMostBytes)
    throw InputError(
        fmt::format("method_commands of a session: found {} with {} characters or more, expected "
                    "at most {} with {}, which a "
                    "question can show; --allow-commands takes all",
                    waiting.size(),
                    bytes,
                    kMostCommands,
                    kMostBytes));
}

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Methods of the user's that shards were computed with, by what they were then.
std::map<std::string, std::string> methods_of_shards(const std::vector<fs::path>& folders) {
  std::map<std::string, std::string> found;
  for (const fs::path& folder : folders) {
    std::error_code none;
    if (!fs::is_regular_file(folder / "experiment.json", none)) continue;
    const auto json = read_json(folder / "experiment.json");
    if (!json.is_object() || !json.contains("commands") || !json["commands"].is_object()) continue;
    for (const auto& [name, identity] : json["commands"].items())
      if (identity.is_string()) found.emplace(name, identity.get<std::string>());
  }
  return found;
}

/// It only has a name: nothing asks it for a window.
Method method_of_shard(const std::string& name, const std::string& identity, int number) {
  return own_method(
      name,
      number,
      [name](const Window&, const Sources&, const Watch&) {
        return failed(name + ": is known from shards alone");
      },
      identity);
}

}  // namespace

void say_not_started(const OwnMethods& own) {
  for (const std::string& one : own.waiting) {
    const std::size_t equals = one.find('=');
    own.log->add(one.substr(0, equals),
                 fmt::format("not started: only a session names its command ({}); "
                             "--allow-commands starts it",
                             legible(one.substr(equals + 1), 300)));
  }
}

void add_method_commands(CLI::App& command, MethodArguments& arguments) {
  command
      .add_option("--method-command",
                  arguments.spelled.commands,
                  "A method of your own, NAME='COMMAND': it is given each window as a line of JSON "
                  "and answers with one (engine/commands/README.md)")
      ->allow_extra_args(false)
      ->type_name("NAME=COMMAND");
  command
      .add_option(
          "--method-timeout", arguments.timeout_s, "Such a command is killed after so long [s]")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e5));
  command
      .add_option("--result",
                  arguments.spelled.results,
                  "Another program's result as a method, NAME=FILE[,POINTS][,frame=camera|body]: a "
                  "trajectory (TUM, EuRoC, KITTI, ORB-SLAM3, VINS-Mono) or a model of COLMAP "
                  "(engine/results/README.md)")
      ->allow_extra_args(false)
      ->type_name("NAME=FILE");
  command.add_flag("--allow-commands",
                   arguments.allow_commands,
                   "Commands that only a session names are started, without a question");
}

OwnMethods register_methods(int argc, const char* const* argv) {
  OwnMethods own;
  auto glance = glance_at(argc, argv);
  if (!glance) return own;
  SpelledMethods all = glance->methods.spelled;
  std::set<std::string> taken;
  for (const std::string& name : names_of(all)) taken.insert(name);
  const std::size_t given = all.commands.size();
  for (const fs::path& file : sessions_of(*glance)) {
    const SpelledMethods recorded = methods_in_session(file);
    append(all.commands, take_new(recorded.commands, taken));
    append(all.results, take_new(recorded.results, taken));
  }
  *own.allowed = glance->methods.allow_commands;
  CommandOptions options;
  options.time_limit =
      std::chrono::milliseconds(static_cast<std::int64_t>(1000 * glance->methods.timeout_s));
  options.told = [log = own.log](const std::string& name, const std::string& line) {
    log->add(name, line);
  };
  if (!*own.allowed)
    check_can_be_shown({all.commands.begin() + std::ptrdiff_t(given), all.commands.end()});
  std::vector<Method> methods;
  const auto number = [&] { return static_cast<int>(methods.size()); };
  for (std::size_t i = 0; i < all.commands.size(); ++i) {
    if (i >= given) options.allowed = own.allowed;
    if (i >= given && !*own.allowed) own.waiting.push_back(all.commands[i]);
    methods.push_back(command_method(parse_method_command(all.commands[i]), options, number()));
  }
  for (const std::string& text : all.results)
    methods.push_back(result_method(parse_program_result(text), options.told, number()));
  for (const auto& [name, identity] : methods_of_shards(glance->merge))
    if (!taken.contains(name)) methods.push_back(method_of_shard(name, identity, number()));
  if (!methods.empty()) add_methods(std::move(methods));
  keep_spelled_methods(std::move(all));
  return own;
}

}  // namespace gpo
