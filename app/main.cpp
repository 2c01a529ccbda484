// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/terminal/terminal.h"
#include "engine/base/error.h"
#include "engine/experiment/experiment.h"
#include "engine/inspection/settings/settings_table.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <map>
#include <system_error>

namespace gpo {
namespace {

std::map<std::string, RunCommand> add_commands(CLI::App& app, MethodArguments& methods) {
  app.require_subcommand(0, 1);
  // In the order of --help.
  std::map<std::string, RunCommand> commands;
  commands["view"] = add_view(app);
  commands["info"] = add_info(app);
  commands["convert"] = add_convert(app);
  commands["run"] = add_run(app);
  commands["snapshot"] = add_snapshot(app);
  commands["evaluate"] = add_evaluate(app);
  commands["calibrate"] = add_calibrate(app);
  commands["synthesize"] = add_synthesize(app);
  commands["pages"] = add_pages(app);
  for (const char* command : {"view", "run", "snapshot", "evaluate"})
    add_method_commands(*app.get_subcommand(command), methods);
  return commands;
}

int report_error(const std::string& message) {
  fmt::print(stderr, "gpo-inspector: {}\n", message);
  return kBadInput;
}

/// Returns the message in one line with the command that prints more help.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  std::string message = error.what();
  std::ranges::replace(message, '\n', ' ');
  std::string help = app.get_name();
  const auto commands = app.get_subcommands();
  const auto words = app.remaining();
  if (!commands.empty()) {
    help += " " + commands.front()->get_name();
  } else if (!words.empty() && !words.front().starts_with('-')) {
    message = fmt::format(
        "unknown command '{}', expected one of {}", words.front(), names_of_commands(app, ", "));
  }
  return InputError(fmt::format("{}; see {} --help", message, help)).what();
}

}  // namespace

int main_with_errors(int argc, char** argv) {
  CLI::App app("gpo-inspector: inspects monocular initialization on planar scenes",
               "gpo-inspector");
  try {
    quiet_libraries();
    MethodArguments methods;
    const std::map<std::string, RunCommand> commands = add_commands(app, methods);
    app.set_version_flag("--version", "gpo-inspector " GPO_VERSION);
    app.parse(argc, argv);
    OwnMethods own(methods);
    const auto chosen = app.get_subcommands();
    const int code = commands.at(chosen.empty() ? "view" : chosen.front()->get_name())(own);
    if (std::fflush(stdout) == 0) return code;
    return report_error(fmt::format("standard output: cannot be written: {}",
                                    std::generic_category().message(errno)));
  } catch (const CLI::Success& help_requested) {
    return app.exit(help_requested);
  } catch (const CLI::ParseError& error) {
    return report_error(usage_error(app, error));
  } catch (const Interrupted& interrupted) {
    report_error(interrupted.what());
    return kFailed;
  } catch (const SettingError& error) {
    return report_error(option_name(error.name) +
                        std::string(error.what()).substr(error.name.size()));
  } catch (const std::exception& error) {
    return report_error(message_of(error));
  }
}

}  // namespace gpo
