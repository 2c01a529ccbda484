// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/session/session_reader.h"
#include "ui/workbench/state.h"

#include <functional>
#include <span>

namespace gpo {

/// A part of the state that sessions keep. What a session does not name stays at the state's own
/// default.
struct SessionField {
  const char* key;
  std::function<SessionJson(const WorkbenchState&)> write;
  /// From a session that has the key. Throws InputError that names it.
  std::function<void(const SessionReader&, WorkbenchState&)> read;
  std::function<void(const WorkbenchState& from, WorkbenchState& to)> copy;
};

/// All of them, in the order in which they are written.
std::span<const SessionField> session_fields();

}  // namespace gpo
