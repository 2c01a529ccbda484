// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The table of all commands, and the pages that are generated from them.
#include "app/commands/commands.h"

#include <algorithm>
#include <iterator>
#include <regex>
#include <sstream>
#include <utility>

namespace gpo {

/// Pages that a package installs beside the program, generated from the options of --help.
enum class Page { man, bash, zsh };

template <>
struct ChoiceKeys<Page> : NamedKeys<"page", "man", "bash", "zsh"> {};

namespace {

constexpr const char* kShellName = "_gpo_inspector";

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  std::vector<const CLI::Option*> named;
  for (const CLI::Option* option : command.get_options({}))
    if (option->nonpositional()) named.push_back(option);
  return named;
}

/// Returns e.g. "--help" and "-h".
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

std::vector<std::string> split(std::string list) {
  std::ranges::replace(list, ',', ' ');
  std::istringstream words(list);
  return {std::istream_iterator<std::string>(words), {}};
}

/// Returns an option's keys, from braces in its type or from the end of its help (": best, paper").
std::vector<std::string> keys_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t brace = type.find('{');
  if (brace != std::string::npos) return split(type.substr(brace + 1, type.find('}') - brace - 1));
  const std::string& help = option.get_description();
  const std::size_t colon = help.rfind(": ");
  if (colon == std::string::npos) return {};
  const std::string list = help.substr(colon + 2);
  auto words = split(list);
  const bool listed = words.size() > 1 && std::ranges::count(list, ',') + 1 == std::ssize(words) &&
                      list.find('=') == std::string::npos;
  return listed ? words : std::vector<std::string>{};
}

std::string roff(const std::string& text) {
  using std::regex;
  std::string escaped = regex_replace(text, regex(R"(\\)"), R"(\e)");
  escaped = regex_replace(escaped, regex("-"), R"(\-)");
  return regex_replace(escaped, regex("^[.']"), R"(\&$&)");
}

std::string man_options(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options({})) {
    const bool named = option->nonpositional();
    const std::string name =
        named ? fmt::format("{}", fmt::join(names_of(*option), ", ")) : option->get_name();
    const std::string normal = option->get_default_str();
    text += fmt::format(".TP\n\\fB{}\\fR{}\n{}{}\n",
                        roff(name),
                        named && option->get_expected_max() > 0
                            ? fmt::format(" \\fI{}\\fR", roff(option->get_type_name()))
                            : "",
                        roff(option->get_description()),
                        normal.empty() ? "" : roff(fmt::format(" (default: {})", normal)));
  }
  return text;
}

// groff 1.23 reads the adjustment of each paragraph from the string AD, older versions from .ad.
std::string man_page(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH GPO\\-INSPECTOR 1 \"\" \"gpo\\-inspector {}\" \"User Commands\"\n.ds AD l\n.ad l\n"
      ".SH NAME\ngpo\\-inspector \\- inspects monocular initialization on planar scenes\n"
      ".SH SYNOPSIS\n.B gpo\\-inspector\n[\\fICOMMAND\\fR] [\\fIOPTIONS\\fR] [\\fIRECORDING\\fR]\n"
      ".SH DESCRIPTION\nOpens a recorded sequence, tracks points through a window of frames, "
      "initializes, and draws the estimated cameras, the plane and a virtual cube over the image "
      "and in 3\\-D, next to the ground truth if there is one. It can draw everything without a "
      "display, too. Without a command it opens the window.\n",
      GPO_VERSION);
  text += ".SH OPTIONS\n" + man_options(app) + ".SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app))
    text += ".SS " + roff(command->get_name()) + "\n" + roff(command->get_description()) + "\n" +
            man_options(*command);
  return text +
         ".SH EXIT STATUS\n0: done; 1: no initialization, no calibration, or an image differs; "
         "2: bad input or usage.\n";
}

std::string shell_words(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : options_of(command))
    for (std::string& name : names_of(*option)) words.push_back(std::move(name));
  return fmt::format("{}", fmt::join(words, " "));
}

std::string bash_completion(const CLI::App& app) {
  std::string keys, words;
  for (const CLI::App* command : commands_of(app)) {
    words += fmt::format("    {}) words='{}' ;;\n", command->get_name(), shell_words(*command));
    for (const CLI::Option* option : options_of(*command))
      if (const auto all = keys_of(*option); !all.empty())
        keys += fmt::format("    {}:{}) words='{}' ;;\n",
                            command->get_name(),
                            names_of(*option).front(),
                            fmt::join(all, " "));
  }
  return fmt::format(
      "{0}() {{\n"
      "  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}} command= word "
      "words=\n"
      "  for word in \"${{COMP_WORDS[@]:1:COMP_CWORD-1}}\"; do\n"
      "    case $word in {1}) command=$word; break ;; esac\n"
      "  done\n"
      "  case $command:$prev in\n{2}  esac\n"
      "  if [[ -z $words && $cur == -* ]]; then\n    case $command in\n    '') words='{3}' ;;\n{4}"
      "    esac\n  elif [[ -z $words && -z $command ]]; then\n    words='{5}'\n  fi\n"
      "  COMPREPLY=($(compgen -W \"$words\" -- \"$cur\"))\n"
      "  [[ ${{#COMPREPLY[@]}} -gt 0 || $cur == -* ]] && return\n"
      "  compopt -o filenames 2>/dev/null\n"
      "  COMPREPLY=($(compgen -f -- \"$cur\"))\n"
      "}}\ncomplete -F {0} gpo-inspector\n",
      kShellName,
      names_of_commands(app, "|"),
      keys,
      shell_words(app),
      words,
      names_of_commands(app, " "));
}

/// Escapes text of a zsh specification in single quotes.
std::string zsh_text(const std::string& text) {
  const std::string escaped = std::regex_replace(text, std::regex(R"([\\\[\]:])"), R"(\$&)");
  return std::regex_replace(escaped, std::regex("'"), R"('\'')");
}

std::string zsh_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : commands_of(app)) {
    commands +=
        fmt::format("    '{}:{}'\n", command->get_name(), zsh_text(command->get_description()));
    cases += fmt::format("    {}) _arguments", command->get_name());
    for (const CLI::Option* option : options_of(*command)) {
      const auto keys = keys_of(*option);
      const std::string values = option->get_expected_max() == 0 ? ""
                                 : keys.empty()                  ? ":value:_files"
                                                : fmt::format(":value:({})", fmt::join(keys, " "));
      cases += fmt::format(" \\\n      '*{}[{}]{}'",
                           names_of(*option).front(),
                           zsh_text(option->get_description()),
                           values);
    }
    cases += " \\\n      '*:file:_files' ;;\n";
  }
  return fmt::format(
      "#compdef gpo-inspector\n{0}() {{\n  local context state state_descr line\n  local -a "
      "commands=(\n{1}  )\n"
      "  _arguments -C '1: :->command' '*:: :->rest'\n"
      "  case $state in\n  command) _describe command commands; _files ;;\n"
      "  rest) case $words[1] in\n{2}    *) _files ;;\n  esac ;;\n  esac\n}}\n"
      "{0} \"$@\"\n",
      kShellName,
      commands,
      cases);
}

}  // namespace

std::span<const CommandRow> all_commands() {
  static constexpr CommandRow kRows[] = {{"view", add_view, true},
                                         {"info", add_info},
                                         {"convert", add_convert},
                                         {"record", add_record},
                                         {"run", add_run, true},
                                         {"snapshot", add_snapshot, true},
                                         {"report", add_report, true},
                                         {"evaluate", add_evaluate, true},
                                         {"calibrate", add_calibrate},
                                         {"synthesize", add_synthesize},
                                         {"findings", add_findings},
                                         {"pages", add_pages}};
  return kRows;
}

RunCommand add_pages(CLI::App& app) {
  const auto page = std::make_shared<Page>();
  CLI::App& command = *app.add_subcommand("pages", "Manual page and completion scripts");
  command.group("");
  add_choice<Page>(command, "page", "Page to print", *page)->required();
  return [page, &app](OwnMethods& /*own*/, Interrupt& /*interrupt*/) {
    const auto other = *page == Page::bash ? bash_completion : zsh_completion;
    fmt::print("{}", *page == Page::man ? man_page(app) : other(app));
    return kDone;
  };
}

}  // namespace gpo
