// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/recordings/recordings.h"
#include "app/terminal/terminal.h"
#include "engine/inspection/settings/settings_table.h"

#include <algorithm>
#include <cstdio>

namespace gpo {
namespace {

std::string help_of(const Setting& setting) {
  std::vector<std::string> keys;
  for (const SettingChoice& one : setting.choices) keys.push_back(one.key);
  return setting.help + (setting.unit.empty() ? "" : fmt::format(" [{}]", setting.unit)) +
         (keys.empty() ? "" : fmt::format(": {}", fmt::join(keys, ", ")));
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
          "Sets all settings to our best ones or to the paper's: best, paper")
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
      const bool number = setting.choices.empty();
      command.add_option_function<std::string>(name, take, help)
          ->default_str(setting.optional ? "" : normal)
          ->type_name(number ? fmt::format("{:g}..{:g}", setting.least, setting.most) : "KEY");
    }
  }
}

}  // namespace

std::string option_name(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return c == '_' || c == ' '; }, '-');
  return "--" + name;
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
      .add_option("--calibrate",
                  arguments.calibrate,
                  "auto: calibrates an uncalibrated camera from a plane in view, once")
      ->capture_default_str()
      ->check(CLI::IsMember({"off", "auto"}));
  add_settings(command, arguments.settings, arguments.given);
  return recording;
}

CLI::Option* add_tracks_and_recording(CLI::App& command, InspectArguments& arguments) {
  command.add_option(
      "--tracks", arguments.tracks, "Tracks (frame,track,x,y) instead of the built-in tracker");
  return add_recording(command, arguments);
}

void find_method(InspectArguments& arguments, const MethodTable& methods) {
  arguments.settings =
      with_setting(arguments.settings, "method", arguments.settings.options.method.key(), methods);
}

std::shared_ptr<const Recording> open(const InspectArguments& arguments) {
  auto recording = open_given(arguments.recording,
                              {.tracks = arguments.tracks,
                               .cache_bytes = arguments.cache_mib << 20,
                               .topics = arguments.topics},
                              arguments.calibrate == "auto");
  for (const std::string& note : recording->notes) fmt::print(stderr, "{}\n", note);
  return recording;
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
