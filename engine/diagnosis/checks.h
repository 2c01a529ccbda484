// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/diagnosis/evidence.h"
#include "engine/diagnosis/finding.h"

#include <vector>

/// One function a check, in the order of the table `checks()`. Each returns findings without a key;
/// empty if the evidence lacks its inputs or speaks for the answer.
namespace gpo::check {

using Findings = std::vector<Finding>;

// normal_checks.cpp: the uncertainty of the plane's normal, and its causes.
Findings rotation_only(const Evidence& evidence);
Findings late_clock(const Evidence& evidence);
Findings neglected_rolling_shutter(const Evidence& evidence);
Findings little_parallax(const Evidence& evidence);
Findings uncertain_lens(const Evidence& evidence);
Findings uneven_surface(const Evidence& evidence);
Findings regions_disagree(const Evidence& evidence);
Findings uncertain_normal(const Evidence& evidence);

// result_checks.cpp: the method and its numbers.
Findings not_finite(const Evidence& evidence);
Findings no_plane(const Evidence& evidence);
Findings two_orientations(const Evidence& evidence);
Findings method_failed(const Evidence& evidence);
Findings unstable_method(const Evidence& evidence);

// truth_checks.cpp: the ground truth against images and result.
Findings truth_conventions(const Evidence& evidence);
Findings truth_of_another_plane(const Evidence& evidence);
Findings truth_contradicts(const Evidence& evidence);

// track_checks.cpp: what the tracks do in the image.
Findings static_tracks(const Evidence& evidence);
Findings changing_focal_length(const Evidence& evidence);
Findings moving_objects(const Evidence& evidence);

// input_checks.cpp: camera, gyroscope and what readers and stages remarked.
Findings guessed_camera(const Evidence& evidence);
Findings implausible_intrinsics(const Evidence& evidence);
Findings interlaced(const Evidence& evidence);

// texture_checks.cpp
Findings repeated_texture(const Evidence& evidence);

// gyroscope_checks.cpp: the result against gyroscope and accelerometer.
Findings camera_at_rest(const Evidence& evidence);
Findings contradicted_bias(const Evidence& evidence);

}  // namespace gpo::check
