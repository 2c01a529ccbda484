// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/setting_options.h"

#include "engine/inspection/settings/settings_table.h"

#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

std::string help_of(const Setting& setting) {
  std::vector<std::string> keys;
  for (const SettingChoice& one : setting.choices) keys.push_back(one.key);
  return setting.help + (setting.unit.empty() ? "" : fmt::format(" [{}]", setting.unit)) +
         (keys.empty() ? "" : fmt::format(": {}", fmt::join(keys, ", ")));
}

void report_idle(const std::string& key, const std::string& why) {
  if (!why.empty()) fmt::print(stderr, "{} is not used. {}\n", option_name(key), why);
}

}  // namespace

std::string option_name(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return c == '_' || c == ' '; }, '-');
  return "--" + name;
}

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
      // The user's own methods are only known after parsing, see `find_methods`.
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

void report_unused(std::span<const std::string> given, const Inspection& inspection) {
  for (const std::string& key : given)
    report_idle(key, why_idle(find_setting(key), inspection.settings, inspection.recording.get()));
}

void report_unused(std::span<const std::string> given,
                   std::span<const Configuration> compared,
                   std::span<const std::shared_ptr<const Inspection>> inspections) {
  for (const std::string& key : given) {
    const Setting& setting = find_setting(key);
    const auto sets = [&](const Configuration& one) { return key == "method" || one.names(key); };
    const auto why = [&](const std::shared_ptr<const Inspection>& one) {
      return why_idle(setting, one->settings, one->recording.get());
    };
    const bool used = std::ranges::any_of(inspections, &std::string::empty, why);
    if (std::ranges::any_of(compared, sets)) {
      report_idle(key, "The compared methods set it themselves");
    } else if (!used && !inspections.empty()) {
      report_idle(key, why(inspections.front()));
    }
  }
}

}  // namespace gpo
