// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/terminal/output.h"
#include "app/terminal/progress_bar.h"
#include "engine/base/error.h"
#include "engine/inspection/studies/scan.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <thread>

#include <fmt/format.h>

namespace gpo {
namespace {

std::vector<ScannedStart> scan(const std::shared_ptr<const Recording>& recording,
                               const Settings& settings,
                               std::span<const int> starts) {
  std::vector<ScannedStart> scanned;
  ProgressBar bar("scanning");
  const int of = static_cast<int>(starts.size());
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  scan_starts(recording, settings, {starts, cores}, [&](ScannedStart start) {
    scanned.push_back(std::move(start));
    bar.show(static_cast<int>(scanned.size()), of);
  });
  std::ranges::sort(scanned, {}, &ScannedStart::start);
  return scanned;
}

std::string summary(std::span<const ScannedStart> starts, int frames, int step) {
  const auto count = [&](Readiness readiness) {
    return std::ranges::count_if(
        starts, [&](const auto& start) { return start.ok && start.readiness == readiness; });
  };
  std::string text = fmt::format(
      "{} starts, {} frames apart, of windows of {} frames: {} ready, {} weak, {} degenerate, {} "
      "failed\n",
      starts.size(),
      step,
      frames,
      count(Readiness::ready),
      count(Readiness::weak),
      count(Readiness::degenerate),
      std::ranges::count(starts, false, &ScannedStart::ok));
  const ScannedStart* best = best_start(starts);
  if (best == nullptr)
    return text + "none succeeds; from the first: " + starts.front().reason + "\n";
  return text + "best start: " + to_text(*best) + "\n";
}

void tell_what_is_unused(const std::vector<std::string>& given) {
  if (std::ranges::find(given, "start") != given.end())
    fmt::print(stderr, "--start is not used. A scan starts all over the recording\n");
}

}  // namespace

int scan_command(const InspectArguments& arguments,
                 const std::filesystem::path& file,
                 std::optional<int> wanted_step) {
  check_outputs(std::array{NamedFile{"--scan", file}},
                std::array{NamedFile{"--tracks", arguments.tracks},
                           NamedFile{"recording", arguments.recording}});
  tell_what_is_unused(arguments.given);
  const auto recording = open(arguments);
  const int frames = arguments.settings.frames;
  const int step = wanted_step.value_or(scan_step(recording->frame_count(), frames));
  const auto starts = starts_to_scan(recording->frame_count(), frames, step);
  if (starts.empty())
    throw InputError(fmt::format(
        "--frames: {}, but {} has {} frames", frames, recording->name, recording->frame_count()));
  const auto scanned = scan(recording, arguments.settings, starts);
  fmt::print(is_standard_output(file) ? stderr : stdout, "{}", summary(scanned, frames, step));
  write_output(file, to_csv(scanned, *recording));
  return best_start(scanned) != nullptr ? kDone : kFailed;
}

}  // namespace gpo
