// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"

int main(int argc, char** argv) {
  try {
    return gpo::main_with_errors(argc, argv);
  } catch (...) {
    return gpo::kBadInput;  // not even the error could be printed
  }
}
