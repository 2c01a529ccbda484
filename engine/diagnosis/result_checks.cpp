// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/checks.h"
#include "engine/diagnosis/not_finite.h"

#include <string>

#include <fmt/format.h>

namespace gpo::check {

Findings not_finite(const Evidence& e) {
  std::string name;
  const auto look = [&](const auto* value) {
    if (value != nullptr && name.empty()) name = first_not_finite(*value);
  };
  look(e.numbers);
  if (e.result != nullptr && e.result->ok) look(e.result);
  look(e.inertial);
  look(e.evaluation);
  if (name.empty()) return {};
  return {{.level = Level::degenerate,
           .sentence = fmt::format("{} is not a finite number", name),
           .advice = "check camera, tracks and time stamps"}};
}

Findings no_plane(const Evidence& e) {
  if (e.window == nullptr || e.window->inliers != Inliers::planes || !e.window->planes.empty())
    return {};
  const bool says_why = e.result != nullptr && !e.result->reason.empty();
  return {
      {.level = Level::no_plane,
       .sentence = says_why ? e.result->reason : "no tracks agree with one homography a frame"}};
}

Findings two_orientations(const Evidence& e) {
  if (e.result == nullptr || !e.result->ambiguity) return {};
  const auto& [apart_deg, undecided, rejected, failure] = *e.result->ambiguity;
  if (!undecided.empty())
    return {{.level = Level::degenerate,
             .sentence = fmt::format(
                 "Ambiguous: two plane orientations {:.0f} deg apart fit equally well", apart_deg),
             .advice = "a gyroscope or more sideways motion resolves it, and the settings "
                       "`rotations averaging-first` and `averaging-second` take one of them",
             .view = "image"}};
  const std::string both = fmt::format(
      "two plane orientations {:.0f} deg apart fitted the homographies equally well", apart_deg);
  if (!failure.empty())
    return {{.level = Level::weak,
             .sentence = fmt::format("{}; the method fails from one: {}", both, failure)}};
  if (!rejected)
    return {{.sentence = both + "; both end in the same normal after the optimization"}};
  return {{.level = Level::weak,
           .sentence = fmt::format("{}; after the optimization the residuals of all tracks prefer "
                                   "one to the other, {:.0f} deg apart, by {:.1f} sigma",
                                   both,
                                   rejected->apart_deg,
                                   rejected->sigmas)}};
}

Findings method_failed(const Evidence& e) {
  if (e.result == nullptr || e.result->ok) return {};
  const bool judged = e.numbers != nullptr && e.numbers->noise_px;
  return {{.level = judged ? Level::weak : Level::degenerate,
           .sentence = judged ? "the method failed: " + e.result->reason : e.result->reason}};
}

Findings unstable_method(const Evidence& e) {
  if (e.result == nullptr || !e.result->ok || !e.result->own_noise ||
      !e.result->own_noise->unstable)
    return {};
  return {{.level = Level::weak,
           .sentence = "without one region of the image the method mostly fails or finds another "
                       "plane normal"}};
}

}  // namespace gpo::check
