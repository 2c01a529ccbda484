// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/method_commands.h"

#include "engine/base/error.h"

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace gpo {
namespace {

/// On standard error, all in all so many lines.
auto teller() {
  constexpr int kMostLines = 200;
  return [count = std::make_shared<std::atomic<int>>(0)](const std::string& name,
                                                         const std::string& line) {
    const int number = ++*count;
    if (number <= kMostLines) fmt::print(stderr, "{}: {}\n", name, line);
    if (number == kMostLines + 1) fmt::print(stderr, "{}: (what follows is not shown)\n", name);
  };
}

}  // namespace

void add_method_commands(CLI::App& command, MethodArguments& arguments) {
  command
      .add_option("--method-command",
                  arguments.commands,
                  "A method of your own, NAME='COMMAND': it is given each window as a line of JSON "
                  "and answers with one (engine/commands/README.md)")
      ->allow_extra_args(false)
      ->type_name("NAME=COMMAND");
  command
      .add_option(
          "--method-timeout", arguments.timeout_s, "Such a command is killed after so long [s]")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e5));
}

void register_method_commands(int argc, const char* const* argv) {
  CLI::App only_these;
  only_these.set_help_flag();
  only_these.allow_extras();
  MethodArguments arguments;
  add_method_commands(only_these, arguments);
  try {
    only_these.parse(argc, argv);
  } catch (const CLI::ParseError&) {
    return;  // said where all is read
  }
  std::vector<MethodCommand> commands;
  for (const std::string& text : arguments.commands) commands.push_back(parse_method_command(text));
  if (commands.empty()) return;
  CommandOptions options;
  options.time_limit =
      std::chrono::milliseconds(static_cast<std::int64_t>(1000 * arguments.timeout_s));
  options.told = teller();
  add_methods(command_methods(commands, options));
}

}  // namespace gpo
