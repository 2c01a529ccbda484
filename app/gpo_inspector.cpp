// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The program that users start. Commands that draw nothing run here; the others run in a second
// program, because its libraries for windows take long to load.
#include "app/commands/commands.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <string_view>
#include <system_error>

#include <unistd.h>

namespace {

constexpr gpo::CommandRow kCommands[] = {{"info", gpo::add_info},
                                         {"convert", gpo::add_convert},
                                         {"record", gpo::add_record},
                                         {"run", gpo::add_run, true},
                                         {"synthesize", gpo::add_synthesize},
                                         {"findings", gpo::add_findings}};

bool runs_here(std::string_view word) {
  return word == "--version" ||
         std::ranges::find(kCommands, word, &gpo::CommandRow::name) != std::end(kCommands);
}

int run_drawing_program(char** argv) {
  const std::string program = gpo::drawing_program();
  execv(program.c_str(), argv);
  fmt::print(stderr,
             "gpo-inspector: {}: cannot be started: {}\n",
             program,
             std::generic_category().message(errno));
  return gpo::kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    gpo::hold_signals();
    const bool here = argc > 1 && runs_here(argv[1]);
    return here ? gpo::main_with_errors(argc, argv, kCommands) : run_drawing_program(argv);
  } catch (...) {
    return gpo::kBadInput;  // not even the error could be printed
  }
}
