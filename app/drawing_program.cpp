// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The program with all commands, which gpo_inspector.cpp starts for those that draw.
#include "app/commands/commands.h"

int main(int argc, char** argv) {
  try {
    gpo::hold_signals();
    return gpo::main_with_errors(argc, argv, gpo::all_commands());
  } catch (...) {
    return gpo::kBadInput;  // not even the error could be printed
  }
}
