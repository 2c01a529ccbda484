// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/candidate_facts.h"

#include "engine/geometry/pose.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace gpo {

std::string candidates_sentence(std::span<const HomographyCandidate> candidates) {
  std::vector<const HomographyCandidate*> accepted;
  for (const HomographyCandidate& candidate : candidates)
    if (candidate.taken()) accepted.push_back(&candidate);
  const std::size_t count = candidates.size();
  const std::string all = fmt::format("{} decomposition{}", count, count == 1 ? "" : "s");
  if (accepted.empty()) return fmt::format("none of {} is feasible.", all);
  const double tilt = angle_deg(accepted[0]->motion.normal, {0, 0, -1});
  if (accepted.size() == 1)
    return fmt::format("1 of {} is feasible: a plane tilted by {:.1f}\u00b0.", all, tilt);
  double apart = 0;
  for (const HomographyCandidate* one : accepted)
    for (const HomographyCandidate* other : accepted)
      apart = std::max(apart, angle_deg(one->motion.normal, other->motion.normal));
  return fmt::format(
      "{} of {} are feasible; their normals are {:.1f}\u00b0 apart. This frame alone is ambiguous.",
      accepted.size(),
      all,
      apart);
}

std::string why_no_candidates(const NormalStudy& study, int frame_in_window) {
  const int frames = static_cast<int>(study.candidates.size());
  if (frame_in_window < 0 || frame_in_window >= frames)
    return "This frame is outside of the window. Go to one of the bars of the time line";
  if (frame_in_window == 0)
    return "This is the reference frame. Homographies map it to the other frames";
  if (study.candidates[frame_in_window].empty())
    return "This frame has no homography that can be decomposed: it has too few inliers, or the "
           "camera only rotated";
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
  const auto& [inspection, study] = std::tie(state.results.inspection, state.results.study);
  if (!study || !inspection || study->window != inspection->window) return doing;
  return study->error.empty() ? "" : "Cannot analyze the normals of the window: " + study->error;
}

}  // namespace gpo
