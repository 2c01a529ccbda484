// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/methods/method_commands.h"

#include "app/terminal/terminal.h"
#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/results/result_method.h"
#include "ui/workbench/session/session_file.h"

#include <chrono>
#include <cstdio>
#include <set>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

/// Returns the methods whose names are not taken yet and marks these names as taken.
std::vector<std::string> take_new(std::vector<std::string> specs, std::set<std::string>& taken) {
  std::erase_if(specs, [&](const std::string& one) {
    return !taken.insert(one.substr(0, one.find('='))).second;
  });
  return specs;
}

void check_can_be_shown(const std::vector<std::string>& waiting) {
  constexpr std::size_t kMostCommands = 20, kMostBytes = 2000;
  std::size_t bytes = 0;
  for (const std::string& one : waiting) bytes += legible(one, kMostBytes + 1).size();
  if (waiting.size() > kMostCommands || bytes > kMostBytes)
    throw InputError(fmt::format(
        "method_commands of a session: found {} commands of {} characters or more, but a "
        "question can show at most {} of {}; --allow-commands starts all",
        waiting.size(),
        bytes,
        kMostCommands,
        kMostBytes));
}

}  // namespace

void MethodLog::add(const std::string& name, const std::string& line) {
  constexpr int kMaxLines = 200;
  const std::lock_guard lock(mutex_);
  if (++count_ > kMaxLines + 1) return;
  lines_.push_back(count_ <= kMaxLines ? fmt::format("{}: {}", name, line)
                                       : fmt::format("{}: (further lines are not shown)", name));
  fmt::print(stderr, "{}\n", lines_.back());
  if (changed_) changed_();
}

std::vector<std::string> MethodLog::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(lines_, {});
}

void MethodLog::on_change(std::function<void()> changed) {
  const std::lock_guard lock(mutex_);
  changed_ = std::move(changed);
}

void report_not_started(const OwnMethods& own) {
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
                  arguments.specs.commands,
                  "Adds your own method, NAME='COMMAND', which reads each window as a line of JSON "
                  "and answers with one (engine/external_methods/README.md)")
      ->allow_extra_args(false)
      ->type_name("NAME=COMMAND");
  command
      .add_option("--method-timeout",
                  arguments.timeout_s,
                  "Time limit per window, after which the command is killed [s]")
      ->capture_default_str()
      ->check(number_within(0.01, 1e5));
  command.add_flag("--method-resample",
                   arguments.resample,
                   "Gives such a command nine more windows, each without a region of the image, for "
                   "its own uncertainty instead of the window's");
  command
      .add_option("--result",
                  arguments.specs.results,
                  "Adds another program's result as a method, "
                  "NAME=FILE[,POINTS][,frame=camera|body][,scale=metric|free]"
                  "[,offset=auto|SECONDS]: a trajectory (TUM, EuRoC, KITTI, ORB-SLAM3, VINS-Mono) "
                  "or a COLMAP model; {recording} in FILE stands for the recording's name "
                  "(engine/results/README.md)")
      ->allow_extra_args(false)
      ->type_name("NAME=FILE");
  command.add_flag(
      "--allow-commands", arguments.allow_commands, "Starts commands of a session without asking");
}

OwnMethods::OwnMethods(const MethodArguments& arguments)
    : allow_commands_(arguments.allow_commands) {
  options_.time_limit = std::chrono::milliseconds(std::int64_t(1000 * arguments.timeout_s));
  options_.resampled = arguments.resample;
  options_.on_line = [log = log](const std::string& name, const std::string& line) {
    log->add(name, line);
  };
  add(arguments.specs, options_);
}

void OwnMethods::add_session(const fs::path& file) {
  waiting.clear();
  if (!is_session(file)) return;
  std::set<std::string> taken;
  for (const auto& method : table.own()) taken.insert(method->key);
  MethodSpecs fresh = methods_in_session(file);
  fresh.commands = take_new(std::move(fresh.commands), taken);
  fresh.results = take_new(std::move(fresh.results), taken);
  if (!allow_commands_) check_can_be_shown(fresh.commands);
  CommandOptions options = options_;
  allowed = std::make_shared<std::atomic<bool>>(allow_commands_);
  options.allowed = allowed;
  add(fresh, options);
  if (!allow_commands_) waiting = fresh.commands;
}

ReadMethods session_methods(OwnMethods& own, std::function<void(const OwnMethods& added)> added) {
  return [&own, added = std::move(added)](const fs::path& session) {
    const auto read = std::make_shared<OwnMethods>(own);
    read->add_session(session);
    return SessionMethods{read->table, [&own, added, read](WorkbenchState& state) {
                            own = *read;
                            added(own);
                            state.methods = own.table;
                          }};
  };
}

void OwnMethods::add_shards(const std::vector<fs::path>& folders) {
  std::map<std::string, std::string> found;
  for (const fs::path& folder : folders) {
    std::error_code none;
    if (!fs::is_regular_file(folder / "experiment.json", none)) continue;
    try {
      found.merge(commands_in(read_json(folder / "experiment.json")));
    } catch (const nlohmann::json::exception&) {
      continue;  // reported when the shards are merged
    }
  }
  for (const auto& [name, identity] : found) {
    if (name.find('/') != std::string::npos) continue;  // files for one recording
    const auto fail = [name = name](const Window&, const Sources&, const Watch&) {
      return failed(name + ": known only from shards, which do not contain its command");
    };
    if (!table.contains(name))
      table.add(own_method(name, static_cast<int>(table.own().size()), fail, identity));
  }
}

void OwnMethods::add(const MethodSpecs& specs, const CommandOptions& options) {
  MethodTable more = table;
  const auto number = [&] { return static_cast<int>(more.own().size()); };
  for (const std::string& text : specs.commands) {
    Method method = command_method(parse_method_command(text), options, number());
    method.command = text;
    more.add(std::move(method));
  }
  for (const std::string& text : specs.results) {
    Method method = result_method(parse_program_result(text), options.on_line, number());
    method.result = text;
    more.add(std::move(method));
  }
  table = std::move(more);
}

}  // namespace gpo
