// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/recording_writer.h"

#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <utility>

namespace gpo {

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

RecordingWriter::RecordingWriter(std::function<void()> changed)
    : job_([this] { return next(); }, std::move(changed)) {}

void RecordingWriter::write(std::shared_ptr<const Recording> recording, const fs::path& output) {
  const auto lock = job_.lock();
  job_.cancel();
  wanted_ = std::move(recording);
  output_ = output;
  job_.wake();
}

void RecordingWriter::cancel() {
  const auto lock = job_.lock();
  job_.cancel();
  wanted_.reset();
}

JobStatus RecordingWriter::status() const {
  const auto lock = job_.lock();
  JobStatus status = job_.status();
  status.busy = status.busy || written_;
  return status;
}

std::optional<WrittenRecording> RecordingWriter::take() {
  const auto lock = job_.lock();
  return std::exchange(written_, {});
}

BackgroundJob::Job RecordingWriter::next() {
  if (!wanted_) return nullptr;
  return [this, recording = std::exchange(wanted_, {}), output = output_](
             const std::stop_token& stop) {
    WrittenRecording written{output};
    try {
      write_recording(
          *recording, recording->truth, recording_format_of(output), output, [&](int done, int of) {
            check_stop();
            job_.report(stop, "saving " + output.filename().string(), done, of);
          });
    } catch (const InputError& error) {
      written.error = error.what();
    }
    job_.publish(stop, [&] { written_ = std::move(written); });
  };
}

void synchronize(WorkbenchState& state, RecordingWriter& writer) {
  const auto wanted = std::exchange(state.requests.save_recording, {});
  if (writer.status().busy && std::exchange(state.requests.cancel, false)) {
    writer.cancel();
    say(state, "Saving canceled. The incomplete recording was deleted");
  }
  if (wanted) writer.write(state.document.recording, *wanted);
  if (const auto written = writer.take()) {
    if (written->error.empty())
      say(state, "saved " + written->output.string());
    else
      say(state, written->error, Severity::error);
  }
}

}  // namespace gpo
