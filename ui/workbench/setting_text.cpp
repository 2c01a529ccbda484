// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/setting_text.h"

#include "engine/initializers/methods.h"

#include <charconv>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr const char* kDefault = "default";

/// What is wrong with a text, in one line.
[[noreturn]] void refuse(const SettingInfo& info,
                         const std::string& text,
                         const std::string& expected) {
  throw InputError(fmt::format("{}: '{}', expected {}", info.key, text, expected));
}

template <class Number>
Number number_from(const SettingInfo& info, const std::string& text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, number);
  const bool inside =
      static_cast<double>(number) >= info.least && static_cast<double>(number) <= info.most;
  if (error != std::errc() || last != end || !inside)
    refuse(info, text, fmt::format("a number from {:g} to {:g}", info.least, info.most));
  return number;
}

bool switch_from(const SettingInfo& info, const std::string& text) {
  if (text != "on" && text != "off") refuse(info, text, "on or off");
  return text == "on";
}

struct ToText {
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(bool value) const { return value ? "on" : "off"; }
  std::string operator()(RotationSource value) const { return to_string(value); }
  template <Choice E>
  std::string operator()(E value) const {
    return to_string(value);
  }
  template <class T>
  std::string operator()(const std::optional<T>& value) const {
    return value ? (*this)(*value) : kDefault;
  }
  std::string operator()(const std::vector<std::int64_t>& ids) const {
    return ids.empty() ? "none" : fmt::format("{}", fmt::join(ids, ","));
  }
  template <class Number>
  requires std::is_arithmetic_v<Number> std::string operator()(Number value) const {
    return fmt::format("{}", value);
  }
};

struct FromText {
  const SettingInfo& info;
  const std::string& text;

  void operator()(std::string& value) const { value = find_method(text).key; }
  void operator()(bool& value) const { value = switch_from(info, text); }
  void operator()(RotationSource& value) const { value = rotation_source(text); }
  template <Choice E>
  void operator()(E& value) const {
    value = choice<E>(text);
  }
  template <class T>
  void operator()(std::optional<T>& value) const {
    value.reset();
    if (text != kDefault) (*this)(value.emplace());
  }
  void operator()(std::vector<std::int64_t>& ids) const {
    ids.clear();
    for (std::size_t at = 0; text != "none" && at <= text.size();) {
      const std::size_t end = std::min(text.find(',', at), text.size());
      ids.push_back(static_cast<std::int64_t>(
          number_from<std::uint64_t>({info.key, "", "", "", 0, 9e15}, text.substr(at, end - at))));
      at = end + 1;
    }
  }
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(Number& value) const { value = number_from<Number>(info, text); }
};

/// Calls `use(info, value)` for the setting with this key.
template <class S, class Use>
void with_value(S& settings, const std::string& key, Use&& use) {
  bool found = false;
  visit_settings(settings, [&](const SettingInfo& info, auto& value) {
    if (key != info.key) return;
    found = true;
    use(info, value);
  });
  if (!found)
    throw InputError(fmt::format(
        "no setting is called '{}', expected one of {}", key, fmt::join(setting_keys(), ", ")));
}

}  // namespace

std::vector<std::string> setting_keys() {
  std::vector<std::string> keys;
  const Settings settings;
  visit_settings(settings, [&](const SettingInfo& info, const auto&) { keys.push_back(info.key); });
  return keys;
}

std::string setting_text(const Settings& settings, const std::string& key) {
  std::string text;
  with_value(settings, key, [&](const SettingInfo&, const auto& value) { text = ToText{}(value); });
  return text;
}

Settings with_setting(Settings settings, const std::string& key, const std::string& text) {
  with_value(settings, key, [&](const SettingInfo& info, auto& value) {
    FromText{info, text}(value);
  });
  return settings;
}

Settings with_default(const Settings& settings, const std::string& key) {
  return with_setting(settings, key, setting_text(Settings{}, key));
}

Settings with_defaults(const Settings& settings) {
  Settings defaults;
  defaults.start = settings.start;
  defaults.frames = settings.frames;
  defaults.method = settings.method;
  return defaults;
}

}  // namespace gpo
