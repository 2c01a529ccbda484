// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/state.h"

namespace gpo {

void say(WorkbenchState& state, const std::string& text, Severity severity) {
  constexpr std::size_t kMostLines = 1000;
  state.message = text;
  state.message_severity = severity;
  state.message_seconds = 0;
  if (text.empty()) return;
  state.log.push_back({severity, text});
  if (state.log.size() > kMostLines) state.log.erase(state.log.begin());
}

}  // namespace gpo
