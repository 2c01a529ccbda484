// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/studies/normal_study.h"
#include "ui/workbench/state.h"

#include <span>
#include <string>
#include <vector>

namespace gpo {

/// What is seen in the readings of a frame's homography, one sentence; there is at least one.
std::string candidates_sentence(std::span<const HomographyCandidate> candidates);

/// Why a frame (counts in the window, may be outside of it) has no readings; empty where it has.
std::string why_no_candidates(const NormalStudy& study, int frame_in_window);

/// Normal, tilt, rotation, |tau|, score, points behind.
std::vector<std::string> candidate_cells(const HomographyCandidate& candidate);

/// Why there is no study of the shown window's normals to look at, one sentence: `doing` while it
/// is computed. Empty where there is one.
std::string why_no_study(const WorkbenchState& state, const std::string& doing);

}  // namespace gpo
