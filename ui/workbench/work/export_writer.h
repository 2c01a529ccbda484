// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "ui/workbench/state.h"

#include <deque>
#include <functional>
#include <string>
#include <vector>

namespace gpo {

struct WrittenExport {
  fs::path path;
  ExportNotes notes = {};
  std::string error = {};  ///< why it was not written, one line; empty if it was
};

/// Writes exports in the background, one after the other. Thread-safe.
class ExportWriter {
 public:
  /// `changed` is called on the writer's thread when an export is finished.
  explicit ExportWriter(std::function<void()> changed = {});

  void add(PendingExport pending);
  /// Returns the exports that were finished since the last call.
  std::vector<WrittenExport> take();
  bool busy() const;
  /// Drops all exports that are not finished. An incomplete file is removed.
  void cancel();

 private:
  BackgroundJob::Job next();

  std::deque<PendingExport> pending_;
  std::vector<WrittenExport> written_;
  BackgroundJob job_;
};

/// Starts the requested exports or cancels them, and reports the finished ones.
void synchronize(WorkbenchState& state, ExportWriter& writer);

/// Requests an export of the result as the window shows it, cubes included. Throws InputError
/// without a result.
void request_export(WorkbenchState& state, const ExportFormat& format, const fs::path& path);

}  // namespace gpo
