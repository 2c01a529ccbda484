// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/recordings/recordings.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress_bar.h"
#include "engine/recording/board/board.h"
#include "engine/recording/layouts/write_recording.h"
#include "engine/truth/truth.h"

#include <fmt/format.h>

namespace gpo {

namespace {

namespace fs = std::filesystem;

/// Stored, or computed from a board in view.
std::optional<GroundTruth> truth_of(const Recording& recording, const std::stop_token& stop) {
  if (recording.truth || !recording.board || !recording.images) return recording.truth;
  ProgressBar bar("finding the board");
  return board_truth(
      recording, 0, recording.frame_count(), stop, [&](int done, int of) { bar.show(done, of); });
}

}  // namespace

int convert_command(const ConvertArguments& arguments) {
  const fs::path& output = arguments.output;
  const auto opened = open_given(arguments.recording, {.tracks = {}, .topics = arguments.topics});
  const Interrupt interrupt;
  const std::string nothing = "nothing is left of " + output.string();
  const auto truth = truth_of(*opened, interrupt.token());
  interrupt.check(nothing);
  {
    ProgressBar bar("writing " + output.string());
    write_recording(*opened, truth, arguments.format, output, [&](int done, int of) {
      bar.show(done, of);
      interrupt.check(nothing);
    });
  }
  fmt::print("{}: {} frames\n", output.string(), opened->frame_count());
  return kDone;
}

}  // namespace gpo
