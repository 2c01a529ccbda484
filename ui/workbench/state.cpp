// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/state.h"

namespace gpo {

void say(WorkbenchState& state, const std::string& text, Severity severity) {
  constexpr std::size_t kMostLines = 1000;
  state.messages.text = text;
  state.messages.severity = severity;
  state.messages.seconds = 0;
  if (text.empty()) return;
  state.messages.lines.push_back({severity, text});
  if (state.messages.lines.size() > kMostLines)
    state.messages.lines.erase(state.messages.lines.begin());
}

}  // namespace gpo
