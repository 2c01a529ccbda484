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

/// What a package installs beside the program, made from the very options that --help prints.
enum class Page { man, bash, zsh };

template <>
struct ChoiceKeys<Page> {
  static constexpr const char* name = "page";
  static constexpr std::array keys{"man", "bash", "zsh"};
};

/// Declares the command that prints one; for those who make packages, not in --help.
void add_pages(CLI::App& app, Page& page);

/// Of all that --help lists.
std::string names_of_commands(const CLI::App& app, const char* separator);

/// The manual page (roff, section 1), or a shell's completion script.
std::string page_of(const CLI::App& app, Page page, const std::string& version);

}  // namespace gpo
