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
           .sentence = "without a tenth of the tracks the method mostly fails or finds another "
                       "plane normal"}};
}

}  // namespace gpo::check
