// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/recordings/recordings.h"
#include "app/terminal/terminal.h"
#include "engine/base/error.h"
#include "engine/recording/layouts/write_recording.h"
#include "engine/recording/live/live_recording.h"

#include <cstdio>

namespace gpo {
namespace {

struct RecordArguments {
  std::string source;
  fs::path output;
  std::optional<RecordingFormat> format;  ///< default: as the output's extension tells
  std::optional<double> seconds;          ///< default: until it ends
};

struct Recorded {
  CaptureStatus status;
  std::string end;  ///< why it ended, one line; empty: as requested
};

/// Fills the spool until the source ends, `seconds` are recorded or the user stops it.
Recorded record_into(FrameSpool& spool, Capture& capture, std::optional<double> seconds) {
  std::optional<ProgressBar> bar;
  std::int64_t first_ns = 0;
  while (const auto image = capture.take(current_stop())) {
    if (spool.count() == 0) {
      first_ns = image->timestamp_ns;
      fmt::print(stderr, "recording; Ctrl-C ends it\n");
      if (seconds) bar.emplace("recording", "s");
    }
    if (image->segment > 0)
      return {capture.status(),
              fmt::format("the size changed to {}x{}", image->bgr.cols, image->bgr.rows)};
    const double time_s = 1e-9 * static_cast<double>(image->timestamp_ns - first_ns);
    if (seconds && time_s > *seconds) return {capture.status(), ""};
    spool.add(*image);
    if (bar) (*bar)(static_cast<int>(time_s), std::max(1, static_cast<int>(*seconds)));
  }
  const CaptureStatus status = capture.status();
  return {status, status.message};
}

void check_new_output(const fs::path& output, RecordingFormat format) {
  if (format == RecordingFormat::euroc) return check_output_folder(output);
  check_writable(output);
  if (fs::exists(output)) throw InputError(output.string() + ": already exists; choose a new file");
}

/// Writes the recording and returns where. If files of other recordings beside a bag forbid it, the
/// bag gets a folder of its own, because what was recorded must not be lost.
fs::path write_recorded(const Recording& recording,
                        RecordingFormat format,
                        const fs::path& output) {
  ProgressBar bar("writing " + output.string());
  try {
    write_recording(recording, std::nullopt, format, output, std::ref(bar));
    return output;
  } catch (const InputError& error) {
    if (format == RecordingFormat::euroc) throw;
    fs::path own = folder_of(output) / output.stem();
    for (int k = 2; fs::exists(own); ++k)
      own.replace_filename(fmt::format("{}-{}", output.stem().string(), k));
    write_recording(recording, std::nullopt, format, own / output.filename(), std::ref(bar));
    fmt::print(stderr, "{}\n", error.what());
    return own / output.filename();
  }
}

int record_source(const RecordArguments& arguments, Interrupt& interrupt) {
  constexpr int kQueue = 60;
  const fs::path& output = arguments.output;
  const RecordingFormat format = recording_format(output, arguments.format);
  check_new_output(output, format);
  const SourceAddress address = live_source(arguments.source);
  FrameSpool spool(output);
  interrupt.let_finish();
  Recorded recorded;
  {
    Capture capture(address, {.queue = kQueue});
    recorded = record_into(spool, capture, arguments.seconds);
  }
  if (spool.count() == 0) {
    if (recorded.status.is_over()) throw InputError(recorded.end);
    throw Stopped{"there was no image yet, nothing was written"};
  }
  const StopScope to_the_end(nullptr);  // Ctrl-C ended the capture, not the writing
  const LiveImages live = spool.images();
  const Recording recording =
      live_recording({.address = arguments.source,
                      .device = recorded.status.device,
                      .camera = camera_of_source(address, recorded.status.device, spool.size())},
                     live);
  const fs::path written = write_recorded(recording, format, output);
  if (!recorded.end.empty()) fmt::print(stderr, "{}\n", recorded.end);
  const auto& times_ns = live.timestamps_ns;
  fmt::print("{}: {} frames, {}x{}, {:.1f} s, {} dropped\n",
             written.string(),
             spool.count(),
             spool.size().width,
             spool.size().height,
             1e-9 * static_cast<double>(times_ns.back() - times_ns.front()),
             recorded.status.dropped);
  return kDone;
}

}  // namespace

RunCommand add_record(CLI::App& app) {
  const auto to = std::make_shared<RecordArguments>();
  CLI::App& command = *app.add_subcommand(
      "record", "Records a camera or a stream as an EuRoC folder or as a ROS bag");
  command.add_option("source", to->source, kSourceHelp)->required();
  command.add_option("--output", to->output, "Folder or bag (.bag or .mcap) to write")->required();
  add_choice<RecordingFormat>(
      command,
      "--format",
      "Format to write; default: as the extension of the output, else euroc",
      to->format);
  command
      .add_option(
          "--seconds", to->seconds, "Length to record [s]; default: until Ctrl-C or its end")
      ->check(number_within(0.001, 1e6));
  return [to](OwnMethods& /*own*/, Interrupt& interrupt) { return record_source(*to, interrupt); };
}

}  // namespace gpo
