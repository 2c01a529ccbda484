// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/worker.h"
#include "ui/workbench/workbench.h"

#include <filesystem>
#include <memory>

namespace gpo {

/// Between the workbench and the worker: what was asked for, and what came back.
struct WorkerLink {
  Settings requested;                            ///< last ones
  std::shared_ptr<const Inspection> inspection;  ///< of the state's recording; null: none yet
  WorkerStatus status;
};

/// Hands the state's new settings and wishes (open, open_example, compute, cancel) to the worker,
/// and takes over what it has published. Returns at once. `example`: the recording that comes with
/// the program.
void synchronize(WorkbenchState& state,
                 WorkerLink& link,
                 Worker& worker,
                 const std::filesystem::path& example);

}  // namespace gpo
