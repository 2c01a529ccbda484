// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/checks.h"

#include <fmt/format.h>

namespace gpo::check {

Findings truth_conventions(const Evidence& e) {
  if (e.truth_convention == nullptr) return {};
  return {{.level = e.truth_convention->is_used ? Level::degenerate : Level::note,
           .sentence = sentence_of(*e.truth_convention),
           .advice = e.truth_convention->advice}};
}

Findings truth_of_another_plane(const Evidence& e) {
  if (e.evaluation == nullptr || e.window == nullptr) return {};
  if (e.evaluation->plane == e.window->leader) return {};
  if (!e.evaluation->plane)
    return {{.sentence = "the ground truth has no plane where the tracks are: no PNE and PDE"}};
  const int plane = *e.evaluation->plane + 1;
  return {{.sentence = fmt::format("the ground truth describes plane {} of the window, and plane "
                                   "{} leads: no PNE and PDE",
                                   plane,
                                   e.window->leader + 1),
           .advice = fmt::format("use `--plane {}`", plane),
           .command = fmt::format("main-plane {}", plane)}};
}

Findings truth_contradicts(const Evidence& e) {
  if (e.evaluation == nullptr || e.window == nullptr || !is_contradiction(*e.evaluation)) return {};
  const Evaluation& errors = *e.evaluation;
  std::string sentence =
      fmt::format("the normal is {:.2g} deg off the ground truth", *errors.pne_deg);
  if (errors.pne_sigmas) sentence += fmt::format(" ({:.2g} sigma)", *errors.pne_sigmas);
  if (errors.path_error_percent)
    sentence += fmt::format(", the path {:.2g} % of its length", *errors.path_error_percent);
  if (!errors.tracks_px) return {{.sentence = sentence}};
  const bool tracks_fit = *errors.tracks_px < 2 * e.window->threshold_px;
  sentence += fmt::format(", the tracks {:.2g} px", *errors.tracks_px);
  return {{.sentence = std::move(sentence),
           .advice = tracks_fit ? "compare other methods and rotations, the tracks fit the truth"
                                : "check tracks, camera and ground truth"}};
}

}  // namespace gpo::check
