// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "engine/recording/layouts/write_recording.h"
#include "ui/workbench/state.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace gpo {

/// Returns the format of an output by its extension in any case: .bag, .mcap, else an EuRoC folder.
/// Throws InputError for extensions of other files.
RecordingFormat recording_format_of(const fs::path& output);

struct WrittenRecording {
  fs::path output;
  std::string error = {};  ///< why it was not written, one line; empty if it was
};

/// Writes one recording at a time in the background. Thread-safe.
class RecordingWriter {
 public:
  /// `changed` is called on the writer's thread as it advances and when it has finished.
  explicit RecordingWriter(std::function<void()> changed = {});

  /// Requests to write an EuRoC folder, or a bag by the extension. The running one is canceled.
  void write(std::shared_ptr<const Recording> recording, const fs::path& output);
  /// Drops the recording that is not finished. Incomplete output is removed.
  void cancel();
  JobStatus status() const;
  /// Returns the recording that was finished since the last call; nullopt if none.
  std::optional<WrittenRecording> take();

 private:
  BackgroundJob::Job next();

  std::shared_ptr<const Recording> wanted_;  ///< null: none
  fs::path output_;
  std::optional<WrittenRecording> written_;
  BackgroundJob job_;
};

/// Starts the requested recording or cancels it, and reports the finished one.
void synchronize(WorkbenchState& state, RecordingWriter& writer);

}  // namespace gpo
