// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

#include <array>
#include <string>

namespace CLI {
class App;
}

namespace gpo {

/// Pages that a package installs beside the program, generated from the options of --help.
enum class Page { man, bash, zsh };

template <>
struct ChoiceKeys<Page> {
  static constexpr const char* name = "page";
  static constexpr std::array keys{"man", "bash", "zsh"};
};

/// Adds the command that prints a page. It is for packagers and not listed in --help.
void add_pages(CLI::App& app, Page& page);

/// Returns the names of all commands that --help lists.
std::string names_of_commands(const CLI::App& app, const char* separator);

/// Returns the manual page (roff, section 1) or the completion script of a shell.
std::string page_of(const CLI::App& app, Page page, const std::string& version);

}  // namespace gpo
