// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "engine/exports/exports.h"

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace gpo {

struct WorkbenchState;

/// A result to write, as the window shows it.
struct PendingExport {
  std::shared_ptr<const Inspection> inspection;
  ExportChoices choices;
  ExportRequest request;
};

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

}  // namespace gpo
