// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/checks.h"
#include "engine/geometry/statistics.h"

#include <fmt/format.h>

namespace gpo::check {

/// Ambiguous frames: 5 to 19 of 19 over exact lattices that were tracked wrong by periods; at most
/// one over tiles, bricks, dots and chessboards that were tracked right, 0 on real recordings.
Findings repeated_texture(const Evidence& e) {
  if (e.tracks == nullptr || !e.tracks->repetition) return {};
  const Repetition& repetition = *e.tracks->repetition;
  std::vector<int> frames = ambiguous_frames(repetition);
  if (frames.empty()) return {};
  const Eigen::VectorXd periods_px = repetition.period_px.colwise().norm();
  std::string sentence = fmt::format(
      "the texture repeats every {:.0f} px, and in {} of {} frames a motion that is "
      "off by a period fits as well",
      median({periods_px.begin(), periods_px.end()}),
      frames.size(),
      e.tracks->frame_count() - 1);
  for (int& frame : frames) frame += e.tracks->start;
  frames.insert(frames.begin(), e.tracks->start);  // it shows the second matches
  return {{.level = Level::weak,
           .sentence = std::move(sentence),
           .advice = "move more slowly, and show something that does not repeat",
           .tracks = e.tracks->ids,
           .frames = std::move(frames),
           .view = "image"}};
}

}  // namespace gpo::check
