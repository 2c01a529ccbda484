// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/writers.h"

#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/layouts/open_recording.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

WrittenExport write(const PendingExport& pending) {
  WrittenExport written{pending.request.path};
  try {
    written.notes = write_export(*pending.inspection, pending.choices, pending.request);
  } catch (const InputError& error) {
    written.error = error.what();
  }
  return written;
}

WrittenRecording write(const Recording& recording,
                       const fs::path& output,
                       const Progress& progress) {
  WrittenRecording written{output};
  try {
    write_recording(
        recording, recording.truth, recording_format_of(output), output, [&](int done, int of) {
          check_stop();
          progress("saving " + output.filename().string(), done, of);
        });
  } catch (const InputError& error) {
    written.error = error.what();
  }
  return written;
}

}  // namespace

void synchronize(WorkbenchState& state, ExportWriter& writer) {
  const bool writes = writer.busy() || !state.requests.exports.empty();
  if (writes && std::exchange(state.requests.cancel, false)) {
    state.requests.exports.clear();
    writer.cancel();
    say(state, "Export canceled. The incomplete file was deleted");
  }
  for (PendingExport& pending : std::exchange(state.requests.exports, {})) {
    say(state, fmt::format("writing {}", pending.request.path.string()));
    writer.add([pending = std::move(pending)](const Progress&) { return write(pending); });
  }
  for (const WrittenExport& written : writer.take()) {
    const std::string path = written.path.string();
    if (written.error.empty())
      say(state, fmt::format("saved {}: {}", path, fmt::join(written.notes, ". ")));
    else
      say(state, written.error, Severity::error);
  }
}

void check_output(const WorkbenchState& state, const fs::path& file) {
  if (state.document.recording) check_not_overwritten(*state.document.recording, file);
}

void request_export(WorkbenchState& state, const ExportFormat& format, const fs::path& path) {
  if (!state.results.inspection) throw InputError("no result to export yet");
  const ExportRequest request{&format, path};
  check_export(request);
  check_output(state, path);
  state.requests.exports.push_back(
      {state.results.inspection,
       {.metric = state.document.metric, .cube_side = state.document.cube_side},
       request});
}

RecordingFormat recording_format_of(const fs::path& output) {
  static const std::vector<std::string> kOtherFiles = split(
      ".db3 .zip .tar .gz .tgz .7z .mp4 .m4v .3gp .ts .mov .mkv .webm .avi .png .jpg .csv .txt "
      ".json .yaml",
      ' ');
  const bool folder = !output.has_filename();  // a slash at the end
  const fs::path named = folder ? output.parent_path() : output;
  const std::string ending = lower_case(named.extension().string());
  const bool bag = ending == ".bag" || ending == ".mcap";
  if ((folder && bag) || std::ranges::count(kOtherFiles, ending) > 0)
    refuse(output,
           "found the ending {}, expected a folder, or a file name that ends in .bag or .mcap",
           ending);
  return ending == ".bag"    ? RecordingFormat::rosbag
         : ending == ".mcap" ? RecordingFormat::mcap
                             : RecordingFormat::euroc;
}

void synchronize(WorkbenchState& state, RecordingWriter& writer) {
  const auto wanted = std::exchange(state.requests.save_recording, {});
  if (writer.busy() && std::exchange(state.requests.cancel, false)) {
    writer.cancel();
    say(state, "Saving canceled. The incomplete recording was deleted");
  }
  if (wanted) {
    writer.cancel();
    writer.add([recording = state.document.recording, output = *wanted](const Progress& progress) {
      return write(*recording, output, progress);
    });
  }
  for (const WrittenRecording& written : writer.take()) {
    if (written.error.empty())
      say(state, "saved " + written.output.string());
    else
      say(state, written.error, Severity::error);
  }
}

}  // namespace gpo
