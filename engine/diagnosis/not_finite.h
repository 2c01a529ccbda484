// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/methods/common/initialization.h"

#include <string>

namespace gpo {

/// Return the name of the first number that is not finite, "uncertainty.normal_sigma_deg"; empty if
/// all are finite. Times of the computation and `log_scale_sigma` of an unknown scale, which is
/// infinite, do not count.
std::string first_not_finite(const Initialization& result);
std::string first_not_finite(const InertialAlignment& inertial);
std::string first_not_finite(const Evaluation& evaluation);
std::string first_not_finite(const Verdict& verdict);

}  // namespace gpo
