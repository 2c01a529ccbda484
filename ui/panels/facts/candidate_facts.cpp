// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/candidate_facts.h"

#include "engine/geometry/pose.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {

std::string candidates_sentence(std::span<const HomographyCandidate> candidates) {
  std::vector<const HomographyCandidate*> taken;
  for (const HomographyCandidate& candidate : candidates)
    if (candidate.taken()) taken.push_back(&candidate);
  const std::size_t of = candidates.size();
  if (taken.empty()) return fmt::format("none of {} readings is possible.", of);
  const double tilt = angle_deg(taken[0]->motion.normal, {0, 0, -1});
  if (taken.size() == 1)
    return fmt::format("1 of {} readings is possible: a plane tilted by {:.1f}\u00b0.", of, tilt);
  double apart = 0;
  for (const HomographyCandidate* one : taken)
    for (const HomographyCandidate* other : taken)
      apart = std::max(apart, angle_deg(one->motion.normal, other->motion.normal));
  return fmt::format(
      "{} of {} readings are possible; their normals differ by {:.1f}\u00b0: this frame alone "
      "cannot tell them apart.",
      taken.size(),
      of,
      apart);
}

std::string why_no_candidates(const NormalStudy& study, int frame_in_window) {
  const int frames = static_cast<int>(study.candidates.size());
  if (frame_in_window < 0 || frame_in_window >= frames)
    return "This frame is outside of the window: go to one of the bars of the time line";
  if (frame_in_window == 0)
    return "This is the reference frame: homographies lead from it to the other frames";
  if (study.candidates[frame_in_window].empty())
    return "This frame has no homography that can be read: too few inliers, or the camera only "
           "turned";
  return "";
}

std::vector<std::string> candidate_cells(const HomographyCandidate& candidate) {
  const Eigen::Vector3d& n = candidate.motion.normal;
  return {fmt::format("{:.3f}, {:.3f}, {:.3f}", n.x(), n.y(), n.z()),
          fmt::format("{:.1f}", angle_deg(n, {0, 0, -1})),
          fmt::format("{:.2f}", degrees(so3_log(candidate.motion.R_21).norm())),
          fmt::format("{:.3f}", candidate.motion.tau.norm()),
          fmt::format("{:.2f}", candidate.score),
          fmt::format("{} of {}", candidate.behind, candidate.of)};
}

std::string why_no_study(const WorkbenchState& state, const std::string& doing) {
  if (!state.results.study || !state.results.inspection ||
      state.results.study->window != state.results.inspection->window)
    return doing;
  if (state.results.study->error.empty()) return "";
  return "The window's normals could not be studied: " + state.results.study->error;
}

}  // namespace gpo
