// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"

namespace gpo {

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
                                         {"pages", add_pages}};
  return kRows;
}

}  // namespace gpo
