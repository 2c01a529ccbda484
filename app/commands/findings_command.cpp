// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "engine/diagnosis/diagnosis.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <memory>

#include <nlohmann/json.hpp>

namespace gpo {
namespace {

std::string text_of_checks() {
  std::size_t key = 0, title = 0;
  for (const Check& check : checks()) {
    key = std::max(key, std::string_view(check.key).size());
    title = std::max(title, std::string_view(check.title).size());
  }
  std::string text;
  for (const Check& check : checks())
    text += fmt::format("{:<{}}  {:<{}}  {}{}\n",
                        check.key,
                        key,
                        check.title,
                        title,
                        to_string(check.of),
                        check.may_be_ignored ? ", may be ignored" : "");
  return text;
}

nlohmann::ordered_json json_of_checks() {
  auto list = nlohmann::ordered_json::array();
  for (const Check& check : checks())
    list.push_back({{"key", check.key},
                    {"title", check.title},
                    {"looks_at", to_string(check.of)},
                    {"may_be_ignored", check.may_be_ignored}});
  return {{"findings", std::move(list)}};
}

}  // namespace

RunCommand add_findings(CLI::App& app) {
  CLI::App& command = *app.add_subcommand(
      "findings", "List the findings: key, title, what they look at, which may be ignored");
  const auto json = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "Print JSON");
  return [json](OwnMethods& /*own*/, Interrupt& /*interrupt*/) {
    fmt::print("{}", *json ? json_text(json_of_checks(), 2) : text_of_checks());
    return kDone;
  };
}

}  // namespace gpo
