// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.h"
#include "app/recordings.h"
#include "engine/recording/board_truth.h"
#include "engine/recording/euroc_writer.h"

#include <fmt/format.h>

namespace gpo {

int convert_command(const std::filesystem::path& recording, const std::filesystem::path& output) {
  const auto opened = open_given(recording);
  std::optional<GroundTruth> truth = opened->truth;
  if (!truth && opened->board && opened->pictures)
    truth = board_truth(*opened, 0, opened->frame_count());
  write_euroc(*opened, truth, output);
  fmt::print("{}: {} frames\n", output.string(), opened->frame_count());
  return kDone;
}

}  // namespace gpo
