// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <limits>
#include <system_error>

namespace gpo {
namespace {

/// Adds --limits, which applies before the command opens anything.
void add_limits(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--limits",
          [](const std::string& text) {
            const auto factor = parse_number(text);
            if (text != "none" && !(factor && *factor >= 1))
              throw SettingError(
                  "limits",
                  fmt::format("found '{}', expected a number of at least 1, or none", text));
            set_limits(factor.value_or(std::numeric_limits<double>::infinity()));
          },
          "Multiplies the limits for the sizes of files, images, bags and recipes; none: no limits")
      ->default_str("1")
      ->type_name("FACTOR");
}

std::map<std::string, RunCommand> add_commands(CLI::App& app,
                                               std::span<const CommandRow> rows,
                                               MethodArguments& methods) {
  app.require_subcommand(0, 1);
  std::map<std::string, RunCommand> commands;
  for (const CommandRow& row : rows) {
    commands[row.name] = row.add(app);
    CLI::App& command = *app.get_subcommand(row.name);
    if (row.has_methods) add_method_commands(command, methods);
    add_limits(command);
  }
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

/// Returns the option of a setting or an argument, e.g. "--ransac-threshold-px".
std::string option_name(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return c == '_' || c == ' '; }, '-');
  return "--" + name;
}

std::string help_of(const Setting& setting) {
  std::vector<std::string> keys;
  for (const SettingChoice& one : setting.choices) keys.push_back(one.key);
  return setting.help + (setting.unit.empty() ? "" : fmt::format(" [{}]", setting.unit)) +
         (keys.empty() ? "" : fmt::format(": {}", fmt::join(keys, ", ")));
}

std::string type_of(const Setting& setting) {
  if (setting.kind == SettingKind::choice) return "KEY";
  if (setting.kind == SettingKind::keys) return "KEY,...";
  if (setting.kind == SettingKind::point_pair) return "X1,Y1,X2,Y2[,FRAME]";
  if (setting.kind == SettingKind::masks) return "KIND:X1,Y1,X2,Y2[,X3,Y3...][/...]";
  return fmt::format("{:g}..{:g}", setting.least, setting.most);
}

/// Adds one option per setting. `given` receives the keys of the options on the command line.
void add_settings(CLI::App& command, Settings& settings, std::vector<std::string>& given) {
  // Applied as soon as it is parsed, so that single options override it in any position.
  command
      .add_option_function<std::string>(
          "--preset",
          [&settings](const std::string& key) {
            settings = with_preset(std::move(settings), choice<Preset>(key));
          },
          "Sets all settings to our defaults or to the paper's: best, paper")
      ->default_str("best")
      ->type_name("KEY")
      ->check(CLI::IsMember({"best", "paper"}))
      ->trigger_on_parse();
  for (const Setting& setting : settings_table()) {
    const std::string name = option_name(setting.key);
    const std::string help = help_of(setting);
    const auto take = [&settings, &given, key = setting.key](const std::string& text) {
      // The user's own methods are only known after parsing, see `find_method`.
      if (key == "method")
        settings.options.method = text;
      else
        settings = with_setting(std::move(settings), key, text);
      given.push_back(key);
    };
    if (setting.kind == SettingKind::on_off) {
      CLI::Option* on = command.add_flag_callback(
          name, [take] { take("on"); }, help);
      command
          .add_flag_callback(
              "--no-" + name.substr(2), [take] { take("off"); }, "Off: " + help)
          ->excludes(on);
    } else if (setting.kind == SettingKind::ids) {
      command
          .add_option_function<std::vector<std::string>>(
              name,
              [take](const std::vector<std::string>& ids) {
                take(fmt::format("{}", fmt::join(ids, ",")));
              },
              help)
          ->delimiter(',');
    } else {
      const std::string normal = setting_text(settings, setting.key);
      command.add_option_function<std::string>(name, take, help)
          ->default_str(setting.optional ? "" : normal)
          ->type_name(type_of(setting));
    }
  }
}

}  // namespace

int main_with_errors(int argc, char** argv, std::span<const CommandRow> rows) {
  CLI::App app("gpo-inspector: inspects monocular initialization on planar scenes",
               "gpo-inspector");
  try {
    quiet_libraries();
    set_limits(1);
    Interrupt interrupt;
    MethodArguments methods;
    const std::map<std::string, RunCommand> commands = add_commands(app, rows, methods);
    app.set_version_flag("--version", "gpo-inspector " GPO_VERSION);
    app.parse(argc, argv);
    OwnMethods own(methods);
    const auto chosen = app.get_subcommands();
    const int code =
        commands.at(chosen.empty() ? "view" : chosen.front()->get_name())(own, interrupt);
    if (std::fflush(stdout) == 0) return code;
    return report_error(fmt::format("standard output: cannot be written: {}",
                                    std::generic_category().message(errno)));
  } catch (const CLI::Success& help_requested) {
    return app.exit(help_requested);
  } catch (const CLI::ParseError& error) {
    return report_error(usage_error(app, error));
  } catch (const Stopped& stopped) {
    report_error("stopped; " + stopped.remains);
    return kFailed;
  } catch (const SettingError& error) {
    return report_error(option_name(error.name) + (error.what() + error.name.size()));
  } catch (const std::exception& error) {
    return report_error(message_of(error));
  }
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::string names_of_commands(const CLI::App& app, const char* separator) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
  return fmt::format("{}", fmt::join(names, separator));
}

void add_topics(CLI::App& command, TopicChoices& topics) {
  command
      .add_option_function<std::vector<std::string>>(
          "--topic",
          [&topics](const std::vector<std::string>& texts) { topics = parse_topic_choices(texts); },
          fmt::format(
              "Topic of a bag that has several: ROLE=NAME, e.g. image=/cam0/image_raw; roles: {}",
              fmt::join(ChoiceKeys<TopicRole>::keys, ", ")))
      ->allow_extra_args(false);
}

void add_cache(CLI::App& command, std::size_t& mib) {
  command.add_option("--cache", mib, "Limit for decoded images that are cached in memory [MiB]")
      ->capture_default_str()
      ->check(CLI::Range(16, 1'000'000));
}

CLI::Option* add_recording(CLI::App& command, InspectArguments& arguments) {
  auto* recording = command.add_option("recording", arguments.recording, kRecordingHelp);
  add_topics(command, arguments.topics);
  add_cache(command, arguments.cache_mib);
  command
      .add_option(
          "--calibrate",
          arguments.calibrate,
          "auto: calibrates an uncalibrated camera from a plane in view and caches the result")
      ->capture_default_str()
      ->check(CLI::IsMember({"off", "auto"}));
  add_settings(command, arguments.settings, arguments.given);
  return recording;
}

CLI::Option* add_tracks_and_recording(CLI::App& command, InspectArguments& arguments) {
  command.add_option("--tracks",
                     arguments.tracks,
                     "CSV file of tracks (frame,track,x,y) to use instead of the built-in tracker");
  return add_recording(command, arguments);
}

void find_method(InspectArguments& arguments, const MethodTable& methods) {
  arguments.settings =
      with_setting(arguments.settings, "method", arguments.settings.options.method.key(), methods);
}

GivenRecording given_recording(const InspectArguments& arguments) {
  const Settings& window = arguments.settings;
  return {.path = arguments.recording,
          .topics = arguments.topics,
          .searched = {window.start, 2 * window.frames + 8}};
}

std::shared_ptr<const Recording> open(const InspectArguments& arguments) {
  const OpenOptions options{arguments.tracks, arguments.cache_mib << 20, {}, arguments.topics};
  auto recording = open_given(arguments.recording,
                              options,
                              arguments.calibrate == "auto",
                              given_recording(arguments).searched);
  for (const std::string& note : recording->notes) fmt::print(stderr, "{}\n", note);
  return recording;
}

void check_not_overwritten(const Recording& recording, const std::vector<NamedFile>& outputs) {
  for (const NamedFile& output : outputs)
    if (output.path && !is_standard_output(*output.path))
      check_not_overwritten(recording, *output.path);
}

void report_unused(std::span<const std::string> given,
                   std::span<const std::shared_ptr<const Inspection>> inspections,
                   std::span<const Configuration> compared) {
  for (const std::string& key : given) {
    const Setting& setting = find_setting(key);
    const auto sets = [&](const Configuration& one) { return key == "method" || one.names(key); };
    const auto why = [&](const std::shared_ptr<const Inspection>& one) {
      return why_idle(setting, one->settings, one->recording.get());
    };
    std::string reason;
    if (std::ranges::any_of(compared, sets))
      reason = "The compared methods set it themselves";
    else if (!inspections.empty() && std::ranges::none_of(inspections, &std::string::empty, why))
      reason = why(inspections.front());
    if (!reason.empty()) fmt::print(stderr, "{} is not used. {}\n", option_name(key), reason);
  }
}

}  // namespace gpo
