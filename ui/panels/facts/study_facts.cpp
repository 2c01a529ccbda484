// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/study_facts.h"

namespace gpo {

std::string why_no_study(const WorkbenchState& state, const std::string& doing) {
  if (!state.study || !state.inspection || state.study->window != state.inspection->window)
    return doing;
  if (state.study->error.empty()) return "";
  return "The window's normals could not be studied: " + state.study->error;
}

}  // namespace gpo
