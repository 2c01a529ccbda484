// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/layouts/write_recording.h"
#include "ui/workbench/state.h"
#include "ui/workbench/work/task_queue.h"

#include <string>

namespace gpo {

struct WrittenExport {
  fs::path path;
  ExportNotes notes = {};
  std::string error = {};  ///< why it was not written, one line; empty if it was
};
using ExportWriter = TaskQueue<WrittenExport>;

/// Starts the requested exports or cancels them, and reports the finished ones. An incomplete file
/// is removed.
void synchronize(WorkbenchState& state, ExportWriter& writer);

/// Throws InputError if the open recording was read from this file.
void check_output(const WorkbenchState& state, const fs::path& file);

/// Requests an export of the result as the window shows it, cubes included. Throws InputError
/// without a result.
void request_export(WorkbenchState& state, const ExportFormat& format, const fs::path& path);

/// Returns the format of an output by its extension in any case: .bag, .mcap, else an EuRoC folder.
/// Throws InputError for extensions of other files.
RecordingFormat recording_format_of(const fs::path& output);

struct WrittenRecording {
  fs::path output;
  std::string error = {};  ///< why it was not written, one line; empty if it was
};
using RecordingWriter = TaskQueue<WrittenRecording>;

/// Starts the requested recording instead of the running one, or cancels it, and reports the
/// finished one. Incomplete output is removed.
void synchronize(WorkbenchState& state, RecordingWriter& writer);

}  // namespace gpo
